"""Paths of the feet: standing flat, and in the air lifted, carried ahead and pitched about the ball.

A swing foot that stays level needs some 34 degrees of dorsiflexion in mid-swing at a step of 0.3 m. With the
toes down by 12 to 20 degrees, turned about the ball so that it clears the ground as before, the ankle stays
within 30.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.walking.footsteps import Footstep, Footsteps
from exo_pin.walking.schedule import PhaseSamples
from exo_pin.walking.sole_shape import Soles


class FootPaths(NamedTuple):
    """Where both feet are.

    Attributes:
        feet: `(n, 2, 4, 4)` poses of `FEET` in the world.
        heading: `(n, 2)` directions of the toes, continuous over whole turns [rad].
    """

    feet: Array
    heading: Array


def foot_paths(walk: Footsteps, parts: list[PhaseSamples], soles: Soles, pitch: float) -> FootPaths:
    """The poses of both feet at every sample of a walk.

    Args:
        walk: The footsteps.
        parts: The samples of each phase.
        soles: Of the robot.
        pitch: Largest angle of the swinging foot, toes down [rad].
    """
    n = parts[-1].samples.stop
    ground = np.empty((n, 2, 3))  # x, y, heading
    lift, tilt = np.zeros((n, 2)), np.zeros((n, 2))  # 0 .. 1
    place = [_numbers(foot) for foot in walk.start]
    for part in parts:
        ground[part.samples] = place
        if part.phase.step is not None:
            step = walk.steps[part.phase.step]
            k = SIDES.index(step.side)
            goal = _numbers(step)
            goal[2] = place[k][2] + math.remainder(goal[2] - place[k][2], 2.0 * math.pi)
            ground[part.samples, k] = place[k] + minimum_jerk(part.passed)[:, None] * (goal - place[k])
            lift[part.samples, k] = _plateau(part.passed)
            tilt[part.samples, k] = _bump(part.passed)
            place[k] = goal
    return FootPaths(_poses(ground, walk.clearance * lift, pitch * tilt, soles), ground[..., 2])


def minimum_jerk(s: Array) -> Array:
    """From 0 to 1 without speed and acceleration at both ends (Flash & Hogan 1985)."""
    return np.asarray(s**3 * (10.0 - 15.0 * s + 6.0 * s * s))


def _bump(s: Array) -> Array:
    """From 0 to 1 and back, without speed at both ends."""
    return np.asarray(16.0 * (s * (1.0 - s)) ** 2)


def _plateau(s: Array) -> Array:
    """From 0 to 1 and back, half again as quick: a body that sinks by 1 mm scuffs in 2 % of a swing."""
    return np.asarray((1.0 - np.abs(2.0 * s - 1.0) ** 2.5) ** 2)


def _numbers(foot: Footstep) -> Array:
    return np.array([foot.x, foot.y, foot.heading])


def _poses(ground: Array, height: Array, pitch: Array, soles: Soles) -> Array:
    """Feet over their places, the ball at a height, turned about it: toes down positive."""
    T = np.zeros((*ground.shape[:2], 4, 4))
    cos, sin = np.cos(ground[..., 2]), np.sin(ground[..., 2])
    cp, sp = np.cos(pitch), np.sin(pitch)
    T[..., 0, :3] = np.stack([cos * cp, -sin, cos * sp], axis=-1)
    T[..., 1, :3] = np.stack([sin * cp, cos, sin * sp], axis=-1)
    T[..., 2, 0], T[..., 2, 2], T[..., 3, 3] = -sp, cp, 1.0
    ball = soles.ball
    level = np.stack(
        [
            ground[..., 0] + cos * ball[:, 0] - sin * ball[:, 1],
            ground[..., 1] + sin * ball[:, 0] + cos * ball[:, 1],
            height + ball[:, 2],
        ],
        axis=-1,
    )
    T[..., :3, 3] = level - np.einsum("nfij,fj->nfi", T[..., :3, :3], ball)
    return T

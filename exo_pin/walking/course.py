"""The course of a walk over time, before a body is put to it: feet, shares of the weight, ZMP asked for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait import Event
from exo_pin.walking import schedule
from exo_pin.walking.footsteps import Footsteps
from exo_pin.walking.pendulum import resting_zmp
from exo_pin.walking.schedule import Phase, PhaseSamples
from exo_pin.walking.sole_shape import Soles, on_soles
from exo_pin.walking.swing_foot import FootPaths, foot_paths


class Course(NamedTuple):
    """What a walk is to do at each of its n samples.

    Attributes:
        time: `(n,)` even [s].
        phases: Of the walk.
        parts: The samples of each phase.
        paths: Of the feet.
        anchors: `(n, 2, 3)` middle of each sole [m].
        share: `(n, 2)` of the weight on each foot, by the ZMP's place between the anchors.
        zmp: `(n, 2)` zero-moment point that is asked for: on the anchors, and from one to the other [m].
        events: Toe-offs and heel strikes.
    """

    time: Array
    phases: tuple[Phase, ...]
    parts: list[PhaseSamples]
    paths: FootPaths
    anchors: Array
    share: Array
    zmp: Array
    events: tuple[Event, ...]


def course(walk: Footsteps, soles: Soles, *, height: float, rate: float, rest: float, pitch: float) -> Course:
    """Feet, shares and ZMP of footsteps.

    Args:
        walk: The footsteps.
        soles: Of the robot.
        height: Of the centre of mass above the ground [m].
        rate: Samples a second [Hz].
        rest: Time of standing still before and after [s].
        pitch: Largest angle of the swinging foot, toes down [rad].
    """
    plan = schedule.phases(walk, rest)
    time = schedule.sample_times(plan, rate)
    parts = schedule.sampled(plan, time)
    paths = foot_paths(walk, parts, soles, pitch)
    share = schedule.shares(parts, len(time))
    anchors = on_soles(paths.feet, soles.middle[:, None])[:, :, 0]
    zmp = resting_zmp(np.einsum("nf,nfk->nk", share, anchors[..., :2]), float(time[1]), height, rest)
    share += _moved_share(anchors[..., :2], share, zmp)
    return Course(time, plan, parts, paths, anchors, share, zmp, schedule.events(walk, plan))


def _moved_share(anchors: Array, share: Array, zmp: Array) -> Array:
    """`(n, 2)` more weight on each foot, by what the ZMP is moved along the line between the anchors."""
    across = anchors[:, 1] - anchors[:, 0]
    moved = zmp - np.einsum("nf,nfk->nk", share, anchors)
    right = np.einsum("nk,nk->n", moved, across) / np.einsum("nk,nk->n", across, across)
    return np.stack([-right, right], axis=1)

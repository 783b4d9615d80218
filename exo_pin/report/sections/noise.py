"""Joint angles recovered from the feet: of exact feet, of a recording's, and of feet with noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin import crosscheck, ik
from exo_pin.anatomy import FEET, JOINTS, MOVEMENTS
from exo_pin.anatomy.names import Movement
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

NOISES = (1e-3, 3e-3, 5e-3)
"""Standard deviation of the noise of each coordinate of a foot [m]."""

CALM = 0.05
"""Damping of the second answer to noisy feet [m/rad], as `ik.Dls` recommends for 3 mm."""


@dataclass(frozen=True, eq=False)
class Answer:
    """Angles recovered from feet.

    Attributes:
        title: What was recovered, and how.
        given: `(n, 12)` angles that made the feet [rad].
        q: `(n, 12)` recovered angles [rad].
        track: The solver's own account.
        within: `(n,)` samples whose given angles are within the limits.
    """

    title: str
    given: Array
    q: Array
    track: ik.Track
    within: Mask

    @property
    def error(self) -> Array:
        """`(n, 12)` recovered minus given [rad]."""
        return self.q - self.given

    def rms(self) -> dict[str, float]:
        """By movement, over both legs and all samples: root of the mean squared error [rad]."""
        return {m: float(np.sqrt((self.error[:, _both(m)] ** 2).mean())) for m in MOVEMENTS}

    def largest(self) -> dict[str, float]:
        """By movement, over both legs and all samples: largest error [rad]."""
        return {m: float(np.abs(self.error[:, _both(m)]).max()) for m in MOVEMENTS}


def exact(robot: Robot, gait: Gait, title: str, settings: ik.Auto | ik.Dls | None = None) -> Answer:
    """Angles from the feet that the walk's own angles make on this robot."""
    found = crosscheck.recover(robot, gait, settings=settings)
    return Answer(title, gait.q, found.gait.q, found.track, found.within)


def noisy(robot: Robot, gait: Gait, sd: float, *, damping: float = 0.0, seed: int = 0) -> Answer:
    """Angles from feet whose positions carry white noise; their rotations are exact.

    Args:
        robot: The robot.
        gait: The walk.
        sd: Standard deviation of each coordinate [m].
        damping: Of `ik.Dls`; 0 answers every sample by itself.
        seed: Of the noise: the same in every run.
    """
    q = robot.from_gait(gait)
    base = robot.base_of(gait)
    feet = poses(robot, q, FEET, base=base)
    feet[..., :3, 3] += np.random.default_rng(seed).normal(scale=sd, size=(*feet.shape[:2], 3))
    settings: ik.Auto | ik.Dls = ik.Dls(damping=damping) if damping else ik.Auto()
    targets = {foot: feet[:, k] for k, foot in enumerate(FEET)}
    track = ik.track(robot, targets, base=base, settings=settings)
    within = np.all(~robot.outside(q), axis=1)
    how = f", damping {damping:g} m/rad" if damping else ""
    title = f"feet with {1e3 * sd:g} mm noise{how}"
    return Answer(title, gait.q, robot.to_gait(track.q, gait).q, track, within)


def _both(movement: Movement) -> list[int]:
    return [k for k, joint in enumerate(JOINTS) if joint.endswith(movement)]

"""Round trip of a gait: forward kinematics to its feet, inverse kinematics back to its joint angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS, MOVEMENTS, SIDES
from exo_pin.anatomy.names import Movement
from exo_pin.arguments import LARGEST_SEED, count, number
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.ik.settings import Settings
from exo_pin.kinematics import poses
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

IK_TOLERANCE = 1e-9
"""Largest distance of a recovered foot from the given one [m and rad]."""

ANGLE_TOLERANCE = 1e-6
"""Largest difference of comparable angles [rad]: 1e-9 m at the foot are this much at a knee of 5 degrees."""

BENT_KNEE = np.radians(5.0)
"""Angles are compared where the knee is bent more than this [rad]: towards a straight knee a foot's pose
hardly determines the knee's angle."""

_LARGEST_DAMPING = 1e6
"""[m/rad]: more holds every joint still."""

_LARGEST_NOISE = 1.0
"""Standard deviation [m]: more is a slip of units."""


@dataclass(frozen=True, eq=False)
class Recovery:
    """The walk that inverse kinematics recovers from a gait's feet; row `k` belongs to the gait's sample `k`.

    Attributes:
        given: The walk whose feet were given.
        gait: The recovered walk.
        track: The solution of the inverse kinematics.
        within: (n,) True where the given angles are within the robot's limits.
    """

    given: Gait
    gait: Gait
    track: ik.Track
    within: Mask

    __repr__ = short_repr

    @property
    def angle_error(self) -> Array:
        """(n, 12) recovered minus given angles [rad]."""
        return self.gait.q - self.given.q

    @property
    def comparable(self) -> Mask:
        """(n, 12) True for angles within limits, of a leg whose knee is bent more than `BENT_KNEE`."""
        knees = [JOINTS.index(f"{side}_knee_flexion") for side in SIDES]
        bent = np.repeat(self.gait.q[:, knees] > BENT_KNEE, len(JOINTS) // 2, axis=1)
        return np.asarray(bent & self.within[:, None])

    @property
    def largest_position_error(self) -> float:
        """Of any foot, over the samples within limits [m]; 0 without such samples."""
        return float(self.track.position_error[self.within].max(initial=0.0))

    @property
    def largest_rotation_error(self) -> float:
        """Of any foot, over the samples within limits [rad]; 0 without such samples."""
        return float(self.track.rotation_error[self.within].max(initial=0.0))

    @property
    def largest_angle_error(self) -> float:
        """Where angles are `comparable` [rad]; 0 where none are."""
        return float(np.abs(self.angle_error[self.comparable]).max(initial=0.0))

    def rms_by_movement(self) -> dict[Movement, float]:
        """Root mean square of `angle_error` over both legs and all samples [rad]."""
        return {m: float(np.sqrt((self.angle_error[:, _both(m)] ** 2).mean())) for m in MOVEMENTS}

    def largest_by_movement(self) -> dict[Movement, float]:
        """Largest `angle_error` over both legs and all samples [rad]."""
        return {m: float(np.abs(self.angle_error[:, _both(m)]).max()) for m in MOVEMENTS}


def recover(robot: Robot, gait: Gait, *, settings: Settings | None = None) -> Recovery:
    """Forward kinematics of the gait's feet, then inverse kinematics of those feet.

    Args:
        robot: The robot.
        gait: The walk.
        settings: Settings of `ik.track`; its default if left out.
    """
    feet = poses(robot, robot.from_gait(gait), FEET, base=robot.base_of(gait))
    return _recovered(robot, gait, feet, settings)


def recover_noisy(robot: Robot, gait: Gait, sd: float, *, damping: float = 0.0, seed: int = 0) -> Recovery:
    """Angles from feet whose positions carry white noise; their rotations are exact.

    Args:
        robot: The robot.
        gait: The walk.
        sd: Standard deviation of each coordinate of a foot [m].
        damping: Of `ik.Dls` [m/rad], which holds each sample to the one before; 0 solves every sample by
            itself.
        seed: Of the noise: the same in every run.

    Raises:
        DescriptionError: A number is negative or not finite.
    """
    sd, damping = (
        number("sd", sd, least=0.0, most=_LARGEST_NOISE),
        number("damping", damping, least=0.0, most=_LARGEST_DAMPING),
    )
    seed = count("seed", seed, 0, LARGEST_SEED)
    feet = poses(robot, robot.from_gait(gait), FEET, base=robot.base_of(gait))
    feet[..., :3, 3] += np.random.default_rng(seed).normal(scale=sd, size=(*feet.shape[:2], 3))
    return _recovered(robot, gait, feet, ik.Dls(damping=damping) if damping else ik.Auto())


def _recovered(robot: Robot, gait: Gait, feet: Array, settings: Settings | None) -> Recovery:
    """Inverse kinematics of feet `(n, 2, 4, 4)` that belong to the samples of a gait."""
    chosen: dict[str, Any] = {} if settings is None else {"settings": settings}
    targets = {foot: feet[:, k] for k, foot in enumerate(FEET)}
    track = ik.track(robot, targets, base=robot.base_of(gait), **chosen)
    within = np.all(~robot.outside(robot.from_gait(gait)), axis=1)
    return Recovery(gait, robot.to_gait(track.q, gait), track, within)


def _both(movement: Movement) -> list[int]:
    return [k for k, joint in enumerate(JOINTS) if joint.endswith(movement)]

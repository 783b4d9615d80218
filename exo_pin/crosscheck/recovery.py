"""Round trip of a gait: forward kinematics to its feet, inverse kinematics back to its joint angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS, SIDES
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.ik.settings import Settings
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

IK_TOLERANCE = 1e-9
"""Largest distance of a recovered foot from the given one [m and rad]."""

ANGLE_TOLERANCE = 1e-6
"""Largest difference of comparable angles [rad]: 1e-9 m at the foot are this much at a knee of 5 degrees."""

BENT_KNEE = np.radians(5.0)
"""Angles are comparable where the knee is bent by more than this [rad]: near a straight knee the pose of the
foot hardly determines the knee's angle."""


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
        """Largest distance of a foot from the given one, over samples within the limits [m]."""
        return float(self.track.position_error[self.within].max(initial=0.0))

    @property
    def largest_rotation_error(self) -> float:
        """Largest angle between a foot and the given one, over samples within the limits [rad]."""
        return float(self.track.rotation_error[self.within].max(initial=0.0))

    @property
    def largest_angle_error(self) -> float:
        """Largest difference of a recovered from a given angle, over comparable angles [rad]."""
        return float(np.abs(self.angle_error[self.comparable]).max(initial=0.0))


def recover(robot: Robot, gait: Gait, *, settings: Settings | None = None) -> Recovery:
    """Forward kinematics of the gait's feet, then inverse kinematics of those feet.

    Args:
        robot: The robot.
        gait: The walk.
        settings: Settings of `ik.track`; its default if left out.
    """
    q = robot.from_gait(gait)
    base = robot.base_of(gait)
    feet = poses(robot, q, FEET, base=base)
    chosen: dict[str, Any] = {} if settings is None else {"settings": settings}
    track = ik.track(robot, {foot: feet[:, k] for k, foot in enumerate(FEET)}, base=base, **chosen)
    within = np.all(~robot.outside(q), axis=1)
    return Recovery(gait, robot.to_gait(track.q, gait), track, within)

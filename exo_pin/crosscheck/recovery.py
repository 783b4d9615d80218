"""The round trip: forward kinematics of a gait's feet, inverse kinematics back to its angles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

IK_TOLERANCE = 1e-9
"""Largest distance of the recovered from the given foot [m and rad]."""

ANGLE_TOLERANCE = 1e-6
"""Largest difference of an angle that is compared [rad]: a foot within 1e-9 m leaves so much at 5 degrees."""

BENT_KNEE = np.radians(5.0)
"""Angles are compared where the knee is bent more than this [rad]: towards a straight knee a foot's pose
hardly tells the knee's angle."""


@dataclass(frozen=True, eq=False)
class Recovery:
    """What inverse kinematics made of a gait's feet; the row `k` belongs to the gait's sample `k`.

    Attributes:
        given: The walk whose feet were given.
        gait: The recovered walk.
        track: The solver's own account.
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
        knees = [JOINTS.index(f"{side}_knee_flexion") for side in ("left", "right")]
        bent = np.repeat(self.gait.q[:, knees] > BENT_KNEE, len(JOINTS) // 2, axis=1)
        return np.asarray(bent & self.within[:, None])


def recover(robot: Robot, gait: Gait, *, settings: Any = None) -> Recovery:
    """Forward kinematics of the gait's feet, then inverse kinematics of those feet.

    Args:
        robot: The robot.
        gait: The walk.
        settings: Settings of `ik.track`; its default if left out.
    """
    q = robot.from_gait(gait)
    base = robot.base_of(gait)
    feet = poses(robot, q, FEET, base=base)
    chosen = {} if settings is None else {"settings": settings}
    track = ik.track(robot, {foot: feet[:, k] for k, foot in enumerate(FEET)}, base=base, **chosen)
    within = np.all(~robot.outside(q), axis=1)
    return Recovery(gait, robot.to_gait(track.q, gait), track, within)

"""Origins and axes of the joints' local frames at q = 0."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.kinematics.frame_motion import jacobian
from exo_pin.kinematics.motion import poses
from exo_pin.robot import Robot


def joint_frames(robot: Robot) -> list[tuple[str, Array, Array]]:
    """Name, origin (3,) [m] and axis (3,) in the world at q = 0: the body, then each of `JOINTS`.

    The body, and a joint that the robot locks, has no axis: NaN.
    """
    q = robot.neutral
    T = poses(robot, q, ("pelvis", *JOINTS))
    found = [("body", T[0, :3, 3], np.full(3, np.nan))]
    for k, joint in enumerate(JOINTS):
        axis = np.full(3, np.nan)
        if joint in robot.joints:
            column = robot.model.nv - len(robot.joints) + robot.joints.index(joint)
            axis = jacobian(robot, q, joint)[3:, column]
        found.append((joint, T[k + 1, :3, 3], axis))
    return found


def deviation_from_parallel(robot: Robot) -> float:
    """Largest difference of any local frame's rotation matrix from the world's, at q = 0."""
    T = poses(robot, robot.neutral, ("pelvis", *JOINTS))
    return float(np.abs(T[:, :3, :3] - np.eye(3)).max())

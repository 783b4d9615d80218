"""Feet and ground: heights of the sole corners, and gait events from the motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy import CORNERS, FEET
from exo_pin.gait import Event, Gait
from exo_pin.gait.events import zeni
from exo_pin.kinematics.motion import poses
from exo_pin.robot import Robot

Array = npt.NDArray[np.float64]

TOUCH = 0.01
"""A corner this close to the ground touches [m]: soft soles and averaged gaits leave a centimetre."""


class Contacts(NamedTuple):
    """Sole corners over the ground.

    Attributes:
        corners: Names of the corners, left foot first.
        position: (..., 8, 3) in the world [m].
        height: (..., 8) above the ground [m].
        touching: (..., 8) True where a corner is within the tolerance of the ground.
        feet: (..., 2) True where any corner of the left, right foot touches.
    """

    corners: tuple[str, ...]
    position: Array
    height: Array
    touching: npt.NDArray[np.bool_]
    feet: npt.NDArray[np.bool_]


def contacts(
    robot: Robot,
    q: npt.ArrayLike,
    *,
    base: npt.ArrayLike | None = None,
    ground: float = 0.0,
    tolerance: float = TOUCH,
) -> Contacts:
    """Which corner of which foot touches the ground, by geometry alone.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad].
        base: T_world_pelvis as in `exo_pin.kinematics.poses`.
        ground: Height of the ground [m].
        tolerance: Corners up to this height touch [m].
    """
    position = poses(robot, q, CORNERS, base=base)[..., :3, 3]
    height = position[..., 2] - ground
    touching = height <= tolerance
    feet = np.asarray(touching.reshape(*touching.shape[:-1], len(FEET), -1).any(axis=-1))
    return Contacts(CORNERS, position, height, touching, feet)


def events(robot: Robot, gait: Gait) -> tuple[Event, ...]:
    """Heel strikes and toe-offs of a gait from its kinematics (Zeni 2008).

    Heel and ball of the foot are followed forward of the pelvis, along its own horizontal heading: that
    serves on the treadmill and over ground, whatever the direction of the walk.

    Raises:
        GaitError: There are no gait cycles in the motion.
    """
    base = robot.base_of(gait)
    T = poses(robot, robot.from_gait(gait), ("pelvis", *CORNERS), base=base)
    heading = T[:, 0, :2, 0] / np.linalg.norm(T[:, 0, :2, 0], axis=1, keepdims=True)
    relative = T[:, 1:, :2, 3] - T[:, :1, :2, 3]
    forward = np.einsum("nck,nk->nc", relative, heading).reshape(-1, len(FEET), 2, 2)  # foot, part, edge
    heel, ball = forward.mean(axis=3).transpose(2, 0, 1)
    return zeni(gait.time, heel, ball, periodic=gait.periodic)

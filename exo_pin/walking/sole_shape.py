"""The soles of a robot: corners, ball and middle of each foot, in the foot's own axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import CORNERS, FEET
from exo_pin.arrays import Array
from exo_pin.kinematics import poses
from exo_pin.robot import Robot


@dataclass(frozen=True, eq=False)
class Soles:
    """Points of both soles as their foot sees them, left then right.

    Attributes:
        corners: `(2, 4, 3)` heel medial and lateral, ball medial and lateral [m].
        ball: `(2, 3)` midway between the corners of the ball [m].
        middle: `(2, 3)` midway between all corners: where a standing foot bears the weight [m].
    """

    corners: Array
    ball: Array
    middle: Array


def soles(robot: Robot) -> Soles:
    """The soles of a robot, read from its description.

    Raises:
        UnknownNameError: The robot lacks a foot or the corners of its sole.
    """
    T = poses(robot, robot.neutral, (*FEET, *CORNERS))
    points = T[2:, :3, 3].reshape(2, 4, 3)
    feet = T[:2]
    corners = (points - feet[:, None, :3, 3]) @ feet[:, :3, :3]  # R^T (p - o), as rows
    return Soles(corners, corners[:, 2:].mean(axis=1), corners.mean(axis=1))


def on_soles(feet: Array, points: Array) -> Array:
    """Points of the soles in the world.

    Args:
        feet: `(n, 2, 4, 4)` poses of the feet.
        points: `(2, k, 3)` in the feet's own axes [m].

    Returns:
        `(n, 2, k, 3)` [m].
    """
    return np.asarray(np.einsum("nfij,fkj->nfki", feet[..., :3, :3], points) + feet[..., None, :3, 3])

"""Heel and ball of each foot: points of the sole, midway between its corners, along a walk."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import CORNERS
from exo_pin.arrays import Array
from exo_pin.chunks import for_chunks
from exo_pin.gait import Gait
from exo_pin.kinematics.motion import positions
from exo_pin.robot import Robot


def sole_points(robot: Robot, gait: Gait) -> Array:
    """`(n, 2, 2, 3)` left and right foot: heel and ball, midway between their corners [m]."""
    base = robot.base_of(gait)
    q, soles = robot.from_gait(gait), np.empty((len(gait), 2, 2, 3))

    def of_chunk(part: slice) -> None:
        soles[part] = heels_and_balls(
            positions(robot, q[part], CORNERS, base=None if base is None else base[part])
        )

    for_chunks(len(q), q, of_chunk)
    return soles


def heels_and_balls(corners: Array) -> Array:
    """The same `(n, 2, 2, 3)` from the positions `(n, 8, 3)` of `CORNERS` [m]."""
    return np.asarray(corners.reshape(len(corners), 2, 2, 2, 3).mean(axis=3))

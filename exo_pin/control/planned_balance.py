"""The balance of a planned walk: divergent component, forces and soles at every millisecond."""

from __future__ import annotations

import math

import numpy as np

from exo_pin.anatomy import CORNERS, FEET
from exo_pin.arrays import Array
from exo_pin.dynamics import FREE_CUTOFF, Dynamics, torques
from exo_pin.gait import Gait
from exo_pin.ground import belt_speed
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.physics import GRAVITY
from exo_pin.robot import Robot

RATE = 1000.0
"""Rows a second [Hz]."""

INSET = 0.005
"""The centre of pressure stays this far inside the sole [m]: an edge that carries all begins to turn."""

Foot = tuple[float, float, float, float, float, float, float, float]
"""Part of the weight, vertical force [N], forward axis x and y, and how far the centre of pressure may go
back, ahead, to the right and to the left from where it is planned [m]."""


class PlannedBalance:
    """What keeps a walk upright, by time.

    Args:
        robot: The model that the controller believes in.
        gait: A walk over ground with the motion of its pelvis.

    Attributes:
        rate: Of the pendulum, sqrt(g / h), h the mean height of the centre of mass [1/s].
        robot: The floating robot.
    """

    def __init__(self, robot: Robot, gait: Gait) -> None:
        found = torques(robot, gait, cutoff=FREE_CUTOFF, free=True)
        self.robot = found.robot
        com = center_of_mass(found.robot, found.motion.q, found.motion.v)
        self.rate = math.sqrt(GRAVITY / float(com.position[:, 2].mean()))
        divergent = com.position[:, :2] + com.velocity[:, :2] / self.rate
        time = gait.time - gait.time[0]
        grid = np.arange(0.0, float(time[-1]), 1.0 / RATE)
        columns = np.hstack([divergent, *(_foot(found, k) for k in range(len(FEET)))])
        self._rows = np.stack([np.interp(grid, time, column) for column in columns.T], axis=1).tolist()

    def at(self, time: float) -> tuple[float, float, Foot, Foot]:
        """Divergent component x and y [m], and both feet, at a time since the start of the walk [s]."""
        row = self._rows[min(round(time * RATE), len(self._rows) - 1)]
        return row[0], row[1], tuple(row[2:10]), tuple(row[10:18])


def over_ground(robot: Robot, gait: Gait) -> bool:
    """Whether a walk carries its pelvis over ground that stands still."""
    if gait.base is None or gait.periodic:
        return False
    corners = poses(robot, robot.from_gait(gait), CORNERS)[..., :3, 3]
    return belt_speed(gait, gait.base, corners) == 0.0


def _foot(found: Dynamics, foot: int) -> Array:
    """`(n, 8)` the numbers of `Foot`; a foot in the air bears nothing and has no room."""
    soles = poses(found.robot, found.motion.q, CORNERS)[..., :2, 3].reshape(-1, len(FEET), 4, 2)[:, foot]
    ahead = soles[:, 2:].mean(axis=1) - soles[:, :2].mean(axis=1)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
    force = found.ground.force[:, foot, 2]
    off = soles - np.nan_to_num(found.ground.point[:, foot, None, :2])
    along, across = (np.einsum("nck,nk->nc", off, axis) for axis in (ahead, left))
    room = [along.min(axis=1), along.max(axis=1), across.min(axis=1), across.max(axis=1)]
    signs = (1.0, -1.0, 1.0, -1.0)  # inwards
    limits = [np.where(force > 0.0, x + sign * INSET, 0.0) for x, sign in zip(room, signs, strict=True)]
    share = force / np.maximum(found.ground.force[:, :, 2].sum(axis=1), 1.0)
    return np.column_stack([share, force, ahead, *limits])

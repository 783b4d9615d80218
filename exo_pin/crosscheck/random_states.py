"""Random states of a floating robot: pelvis, joints and foot wrenches, for checks of dynamics."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.robot import Robot

_SPEED, _ACCELERATION = 5.0, 50.0  # of joints and pelvis, standard deviation: faster than any walk
_FORCE, _MOMENT = 1000.0, 100.0  # of a foot on the ground, standard deviation [N, N m]


class States(NamedTuple):
    """n states. World axes, linear before angular.

    Attributes:
        base: `(n, 4, 4)` pose of the pelvis.
        velocity: `(n, 6)` of the pelvis [m/s, rad/s].
        acceleration: `(n, 6)` of the pelvis, that of its origin (classical) [m/s^2, rad/s^2].
        q: `(n, J)` angles of the robot's joints [rad].
        dq: `(n, J)` [rad/s].
        ddq: `(n, J)` [rad/s^2].
        wrench: `(n, 2, 6)` of the ground on the feet, about the world's origin [N, N m].
    """

    base: Array
    velocity: Array
    acceleration: Array
    q: Array
    dq: Array
    ddq: Array
    wrench: Array


def random_states(robot: Robot, n: int, *, seed: int = 0) -> States:
    """States within the joint limits, the pelvis turned and moving in any direction.

    Args:
        robot: The robot.
        n: How many.
        seed: Of the random numbers: the same in every run.
    """
    rng = np.random.default_rng(seed)
    base = np.tile(np.eye(4), (n, 1, 1))
    for T in base:
        T[:3, :3] = pin.exp3(rng.uniform(-2.0, 2.0, 3))
    base[:, :3, 3] = rng.normal(size=(n, 3))
    joints = (n, len(robot.joints))
    scale = np.repeat([_FORCE, _MOMENT], 3)
    return States(
        base,
        rng.normal(scale=_SPEED, size=(n, 6)),
        rng.normal(scale=_ACCELERATION, size=(n, 6)),
        rng.uniform(robot.lower, robot.upper, joints),
        rng.normal(scale=_SPEED, size=joints),
        rng.normal(scale=_ACCELERATION, size=joints),
        rng.normal(size=(n, len(FEET), 6)) * scale,
    )

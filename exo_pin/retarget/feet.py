"""Foot by foot: a robot's joint values from the paths of its ankles and the attitudes of its feet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.retarget.biped import Biped, followed
from exo_pin.retarget.leg_model import leg_model
from exo_pin.retarget.leg_motion import LegTask, solve
from exo_pin.retarget.movements import LATERAL
from exo_pin.retarget.robot_legs import RobotLeg
from exo_pin.robot import Robot

_FASTER = 1.1
"""A robot's joint may turn so many times as fast as the fastest joint of the person, before it counts as a
jump: legs of other proportions differ by less, a change of branch by more."""


@dataclass(frozen=True, eq=False)
class FeetTask:
    """What the feet of a robot are to do.

    Attributes:
        biped: The robot.
        gait: The person's walk.
        ankles: Goals of the ankles (n, 2, 3), in the walker's axes at the robot's root [m].
        attitudes: Goals of the feet's rotation (n, 2, 3, 3) from where they stand, in the same axes.
    """

    biped: Biped
    gait: Gait
    ankles: Array
    attitudes: Array


def fastest_turn(gait: Gait) -> float:
    """What the person's fastest joint turns between two samples of a walk [rad]."""
    return float(np.abs(gait.dq).max()) * float(np.diff(gait.time).max())


def largest_step(gait: Gait) -> float:
    """What a joint of a robot may turn between two samples of a walk [rad]."""
    return _FASTER * fastest_turn(gait)


def foot_by_foot(task: FeetTask, copied: Array, weights: tuple[float, ...]) -> Array:
    """Joint values (n, nq): the ankles' places, then no jump of a joint, then the feet's attitudes [rad].

    Args:
        task: What the feet are to do.
        copied: Where to start: the person's angles on the robot's joints (n, nq) [rad].
        weights: Of a radian of a foot's attitude against metres of its ankle, one after the other.
    """
    biped, q = task.biped, np.tile(task.biped.stand, (len(copied), 1))
    robot = leg_model(biped.legs)
    for k, leg in enumerate(biped.legs):
        columns = [biped.robot.column(name) for name in leg.joints]
        start = _start(leg, copied[:, columns] - biped.stand[columns])
        q[:, columns] += solve(_leg_task(task, robot, k), start, weights)
    return followed(biped.robot, q, biped.follow)


def _start(leg: RobotLeg, copied: Array) -> Array:
    """Values (n, k) to start from: the knee bent from the straight leg as the person's, on its own branch.

    A knee behind the line from hip to ankle is the mirror image of one in front of it: thigh and foot turn
    back by the knee's angle.
    """
    found = copied.copy()
    signs = np.sign(leg.axes[:, LATERAL])
    if leg.branch == "behind":
        bent = copied[:, leg.knee] * signs[leg.knee]
        for k, movement in enumerate(leg.movements):
            if movement in ("hip_flexion", "ankle_dorsiflexion"):
                found[:, k] += signs[k] * bent
        found[:, leg.knee] *= -1.0
    found[:, leg.knee] += leg.straight
    return found


def _leg_task(task: FeetTask, robot: Robot, k: int) -> LegTask:
    leg = task.biped.legs[k]
    arrays = robot.subtree([SIDES[k]]).arrays
    assert arrays is not None  # the model has no base that floats
    return LegTask(
        arrays=arrays,
        drive=leg.drive,
        lower=leg.allowed[:, 0],
        upper=leg.allowed[:, 1],
        ankle=leg.ankle,
        places=task.ankles[:, k],
        attitudes=task.attitudes[:, k],
        largest_step=largest_step(task.gait),
        periodic=task.gait.periodic,
    )

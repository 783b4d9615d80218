"""Reference of a comparison: the recorded walk, the corners of its soles, and the conditions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import get_args

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, SIDES, Body
from exo_pin.anatomy.names import PassiveJoints, PelvisMotion
from exo_pin.arrays import Array
from exo_pin.errors import UnknownNameError
from exo_pin.gait import Gait
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.robot import Robot, load_robot
from exo_pin.short_repr import short_repr


@dataclass(frozen=True)
class Conditions:
    """The conditions under which devices are compared.

    Attributes:
        pelvis: `"recorded"`: the pelvis moves as recorded under every device; `"device"`: the device holds it
            upright at its mean place (at constant velocity over ground), and it moves along the device's
            prismatic joints only. A pelvis that moves freely with the person always moves as recorded.
        passive: `"held"`: passive joints stay at zero; `"released"`: they move freely.

    Raises:
        UnknownNameError: A word is unknown.
    """

    pelvis: PelvisMotion = "recorded"
    passive: PassiveJoints = "held"

    def __post_init__(self) -> None:
        if self.pelvis not in get_args(PelvisMotion):
            raise UnknownNameError("condition for pelvis", self.pelvis, get_args(PelvisMotion))
        if self.passive not in get_args(PassiveJoints):
            raise UnknownNameError("condition for passive", self.passive, get_args(PassiveJoints))


DEFAULT_CONDITIONS = Conditions()
"""The recorded motion of the pelvis, and passive joints at zero."""


@dataclass(frozen=True, eq=False)
class Walk:
    """The recorded walk on the full exoskeleton: the reference for every device.

    Attributes:
        gait: The walk.
        robot: The 12-joint exoskeleton for the body.
        base: T_world_pelvis (n, 4, 4).
        feet: T_world_foot (n, 2, 4, 4), left and right.
        corners: Sole corners (n, 2, 4, 3) in the world [m]: heel medial, lateral, ball medial, lateral.
        com: Centre of mass (n, 3) [m].
    """

    gait: Gait
    robot: Robot
    base: Array
    feet: Array
    corners: Array
    com: Array

    __repr__ = short_repr


def walk(gait: Gait, body: Body | None = None) -> Walk:
    """The gait on the full exoskeleton for a body; `Body.from_stature()` if left out."""
    robot = load_robot(body)
    q = robot.from_gait(gait)
    base = robot.pelvis_poses(gait)
    feet = poses(robot, q, FEET, base=base)
    com = center_of_mass(robot, q, base=base).position
    return Walk(gait, robot, base, feet, corners(robot, feet), com)


def corners(robot: Robot, feet: Array) -> Array:
    """Sole corners (..., 2, 4, 3) in the world of feet (..., 2, 4, 4) [m]."""
    local = _soles(robot)
    return np.asarray(local @ feet[..., :3, :3].swapaxes(-1, -2) + feet[..., None, :3, 3])


def sole_targets(robot: Robot, wanted: Array) -> dict[str, ik.Points]:
    """Targets of inverse kinematics that bring the feet's sole corners to wanted places (n, 2, 4, 3) [m]."""
    return {foot: ik.Points(_soles(robot)[k], wanted[:, k]) for k, foot in enumerate(FEET)}


def _soles(robot: Robot) -> Array:
    """Sole corners (2, 4, 3) in the axes of the foot frames, in the order of `exo_pin.anatomy.CORNERS`."""
    assert robot.body is not None  # load_robot made it
    rows = []
    for side, s in zip(SIDES, (1.0, -1.0), strict=True):
        leg = robot.body.leg(side)
        medial, lateral = -s * leg.foot_width / 2, s * leg.foot_width / 2
        rows.append([[x, y, 0.0] for x in (-leg.heel, leg.ball) for y in (medial, lateral)])
    return np.array(rows)

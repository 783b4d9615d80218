"""Both legs of a robot: found, told apart, read, and the way in which their knees bend."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.retarget import leg_search
from exo_pin.retarget.axes import unit_vector
from exo_pin.retarget.leg_joints import LimbJoints, check_pair, own_joints, without_toes
from exo_pin.retarget.leg_search import NoPairError, Standing
from exo_pin.retarget.robot_legs import RobotLeg, robot_leg
from exo_pin.robot.urdf_joints import Follower

_LEAST_BEND = math.radians(20)
"""A knee that bends by less cannot walk: a person's bends by 15 degrees in stance, 60 in swing."""

_LEAST_DROP = 0.5
"""A robot stands where its ankles are this share of the legs' reach below its hips."""

_POINT_FOOT = 3
"""Legs of so few joints may end in a point: the link furthest from the knee is their foot."""

Pair = tuple[str, str]


def read_legs(
    known: Standing, follow: Mapping[str, Follower], feet: tuple[str, ...], front: str, up: str
) -> tuple[Array, tuple[RobotLeg, RobotLeg]]:
    """The rotation (3, 3) from the walker's axes to the root link's, and the legs.

    Args:
        known: The robot as it stands.
        follow: The joints that follow others, by name.
        feet: Links of the left and right foot; empty: they are found.
        front: The root link's axis that points forward; empty: it is found.
        up: The root link's axis that points up.

    Raises:
        UnknownNameError: There is no such link.
        NoPairError: No legs reach down along that axis; another one may point up.
        DescriptionError: It is no robot with two legs.
    """
    if feet:
        ends = (feet[0], feet[1])
        limbs = own_joints(known, (known.joints_to(ends[0]), known.joints_to(ends[1])), follow)
        check_pair(ends, limbs)
    else:
        ends, limbs = _found(known, follow, front, up)
    rotation = _rotation(front or leg_search.forward(known, ends, up), up)
    if not feet:
        limbs = _legs(known, limbs, rotation)
        ends = (_foot(known, limbs[0]), _foot(known, limbs[1]))
        check_pair(ends, limbs)
    left, right = (
        robot_leg(known, side, foot, limb, rotation)
        for side, foot, limb in zip(SIDES, ends, limbs, strict=True)
    )
    for leg in (left, right):
        if leg.hip[2] - leg.ankle[2] < _LEAST_DROP * leg.reach:
            raise NoPairError(
                f"{leg.foot} is not below its hip as the robot stands; name feet, forward and up, or the "
                "angles at which it stands, in a record of the robot (docs/robots.md)"
            )
    return rotation, (left, right)


def on_their_branch(legs: tuple[RobotLeg, RobotLeg]) -> tuple[RobotLeg, RobotLeg]:
    """The legs with their knees in front, or behind where both bend that way alone.

    Raises:
        DescriptionError: The limits of a knee do not let it bend as the other one does.
    """
    front = [leg.knee_range[0] >= _LEAST_BEND for leg in legs]
    if all(front):
        return legs
    if not any(front) and all(leg.knee_range[1] >= _LEAST_BEND for leg in legs):
        return replace(legs[0], branch="behind"), replace(legs[1], branch="behind")
    leg = legs[front.index(False)]
    name = leg.joints[leg.knee]
    lower, upper = np.degrees(leg.limits[leg.knee])
    raise DescriptionError(
        f"{name}, the {leg.side} knee, bends by {math.degrees(leg.knee_range[0]):.1f} deg backward only "
        f"(limits {lower:.1f} .. {upper:.1f} deg, straight at {math.degrees(leg.straight):.1f}); walks take "
        f"some 60 deg: set limits_deg in a record of the robot (docs/robots.md)"
    )


def _found(
    known: Standing, follow: Mapping[str, Follower], front: str, up: str
) -> tuple[Pair, tuple[LimbJoints, LimbJoints]]:
    """The feet and the joints of two limbs that reach down, the left one first."""
    paths = leg_search.limbs(known, up)
    limbs = own_joints(known, (paths[0], paths[1]), follow)
    ends = (_foot(known, limbs[0]), _foot(known, limbs[1]))
    check_pair(ends, limbs)
    if leg_search.sided(known, ends, [list(limb.free) for limb in limbs], up, front):
        return ends, limbs
    return (ends[1], ends[0]), (limbs[1], limbs[0])


def _legs(
    known: Standing, limbs: tuple[LimbJoints, LimbJoints], rotation: Array
) -> tuple[LimbJoints, LimbJoints]:
    """The limbs up to their ankles.

    Raises:
        DescriptionError: They are no legs; the message says where they are arms by their names.
    """
    try:
        return without_toes(known, limbs[0], rotation), without_toes(known, limbs[1], rotation)
    except DescriptionError as error:
        arms = leg_search.arm_joints(limbs[0].chain)
        if not arms:
            raise
        raise DescriptionError(
            f"{known.robot.name} has no two legs: the lowest limbs are arms ({', '.join(arms[:3])} ...)"
        ) from error


def _foot(known: Standing, limb: LimbJoints) -> str:
    """The link of a leg's last joint; without an ankle, the link that is furthest from the knee."""
    model = known.robot.model
    names = limb.chain or tuple(limb.held)
    last = model.getJointId(names[-1])
    links = [
        str(frame.name)
        for frame in model.frames
        if frame.type == pin.FrameType.BODY and frame.parentJoint == last
    ]
    if not links:
        raise DescriptionError(f"joint {names[-1]!r} carries no link")
    if len(limb.free) > _POINT_FOOT:
        return links[0]
    knee = known.place(links[0])
    return max(links, key=lambda link: float(np.linalg.norm(known.place(link) - knee)))


def _rotation(front: str, up: str) -> Array:
    x, z = unit_vector(front), unit_vector(up)
    if abs(x @ z) > 0:
        raise DescriptionError(f"forward is {front} and up is {up}; they must be square to each other")
    return np.stack([x, np.cross(z, x), z], axis=1)

"""Search for the two legs of any robot: limbs that reach down, their sides by name or by place."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.retarget.axes import nearest_axis, unit_vector
from exo_pin.robot import Robot

_FEWEST_JOINTS = 3
"""Of a leg: two of the hip and a knee."""

_MOST_JOINTS = 6
"""Of a leg; further joints are toes, which do not move."""

_SAME_LEVEL = 0.2
"""Limbs that end above the lowest one by less than this share of the robot's height also reach down."""

_REMEDY = "name the feet in a record of the robot (a TOML file, see docs/robots.md)"


def feet_and_up(robot: Robot, stand: Array, up: str = "") -> tuple[tuple[str, str], str]:
    """The links of the two feet, the left one first, and the root link's axis that points up.

    Args:
        robot: Any robot, its root at the origin.
        stand: Configuration (nq,) at which it stands.
        up: The axis, if known; else z, y and x are tried.

    Raises:
        DescriptionError: The robot has fewer or more than two limbs that reach down.
    """
    if not robot.joints:
        raise DescriptionError(f"{robot.name} has no joints, so no legs")
    for axis in (up,) if up else ("z", "y", "x"):
        ends = _lowest(robot, stand, unit_vector(axis))
        if len(ends) == 2:
            left, right = _sided(robot, stand, ends, unit_vector(axis))
            return (left, right), axis
        if len(ends) > 2:
            raise DescriptionError(
                f"{robot.name} has no two legs: {len(ends)} limbs or wheels reach down along {axis}; "
                f"{_REMEDY}"
            )
    raise DescriptionError(f"{robot.name} has no two legs: no pair of limbs reaches down; {_REMEDY}")


def forward(robot: Robot, stand: Array, feet: tuple[str, str], up: str) -> str:
    """The root link's axis that points forward: from the right foot to the left one, crossed with up.

    Args:
        robot: Any robot, its root at the origin.
        stand: Configuration (nq,) at which it stands.
        feet: Links of the left and right foot.
        up: The root link's axis that points up.

    Raises:
        DescriptionError: The feet do not stand side by side.
    """
    left, right = (_place(robot, stand, foot) for foot in feet)
    top = unit_vector(up)
    across = (left - right) - ((left - right) @ top) * top
    size = float(np.linalg.norm(across))
    front = np.cross(across, top) / max(size, 1e-9)
    axis = nearest_axis(front)
    if size < 1e-3 or unit_vector(axis) @ front < 0.95:
        raise DescriptionError(f"{feet[0]} and {feet[1]} do not stand side by side; {_REMEDY}, and `forward`")
    return axis


def leg_joints(robot: Robot, feet: tuple[str, str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The joints of both legs from the hip outwards: those that move one foot but not the other.

    Raises:
        UnknownNameError: There is no such link.
        DescriptionError: A leg has too few joints, or not as many as the other.
    """
    left, right = (_joints(robot.model, robot.frame(foot)) for foot in feet)
    own = tuple(
        tuple(str(robot.model.names[j]) for j in one if j not in other)
        for one, other in ((left, right), (right, left))
    )
    if len(own[0]) != len(own[1]) or len(own[0]) < _FEWEST_JOINTS:
        raise DescriptionError(
            f"{feet[0]} and {feet[1]} hang on {len(own[0])} and {len(own[1])} joints of their own; "
            f"two legs of {_FEWEST_JOINTS} joints or more, as many on both sides, are accepted"
        )
    return own[0], own[1]


def _lowest(robot: Robot, stand: Array, up: Array) -> list[str]:
    """The ends of all limbs that reach down, one for each limb."""
    model = robot.model
    data = model.createData()
    pin.forwardKinematics(model, data, stand)
    heights = np.array([data.oMi[j].translation @ up for j in range(1, model.njoints)])
    low = float(heights.min()) + _SAME_LEVEL * float(np.ptp(heights))
    ends: list[int] = []
    for j in sorted(set(range(1, model.njoints)) - set(model.parents), key=lambda j: heights[j - 1]):
        path = set(_support(model, j))
        shared = min(len(path), _FEWEST_JOINTS)  # two toes of one foot belong to one leg
        fresh = all(len(path & set(_support(model, other))) < shared for other in ends)
        if heights[j - 1] <= low and fresh:
            ends.append(j)
    return [_foot(robot, stand, _support(model, j)[:_MOST_JOINTS]) for j in ends]


def _foot(robot: Robot, stand: Array, path: list[int]) -> str:
    """The link of a leg's last joint; without an ankle, the link that is furthest from the knee."""
    links = [
        str(frame.name)
        for frame in robot.model.frames
        if frame.type == pin.FrameType.BODY and frame.parentJoint == path[-1]
    ]
    if not links:
        raise DescriptionError(f"joint {robot.model.names[path[-1]]!r} carries no link")
    if len(path) > _FEWEST_JOINTS:
        return links[0]
    knee = _place(robot, stand, links[0])
    return max(links, key=lambda link: float(np.linalg.norm(_place(robot, stand, link) - knee)))


def _sided(robot: Robot, stand: Array, ends: list[str], up: Array) -> tuple[str, str]:
    """Left and right foot: by the letter in which their names differ, else by place, left being +y."""
    for one, other in combinations(ends, 2):
        sides = _difference(one, other)
        if sides == ("l", "r"):
            return one, other
        if sides == ("r", "l"):
            return other, one
    y = np.cross(up, unit_vector("x")) if abs(up[0]) < 0.5 else unit_vector("y")
    right, left = sorted(ends, key=lambda foot: float(_place(robot, stand, foot) @ y))
    return left, right


def _difference(one: str, other: str) -> tuple[str, str]:
    """The first letters in which two names differ, in lower case: (`l`, `r`) for `LLEG_6` and `RLEG_6`."""
    for a, b in zip(one.lower(), other.lower(), strict=False):
        if a != b:
            return a, b
    return "", ""


def _place(robot: Robot, stand: Array, frame: str) -> Array:
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, stand)
    return np.array(data.oMf[robot.frame(frame)].translation)


def _joints(model: Any, frame: int) -> list[int]:
    return _support(model, int(model.frames[frame].parentJoint))


def _support(model: Any, joint: int) -> list[int]:
    return [int(j) for j in model.supports[joint] if j > 0]

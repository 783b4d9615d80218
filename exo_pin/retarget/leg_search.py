"""Search for the two legs of any robot: limbs that reach down, from where they part to their feet."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.retarget.axes import nearest_axis, unit_vector
from exo_pin.robot import Robot

FEWEST_JOINTS = 3
"""Of a leg: two of the hip and a knee."""

_SAME_LEVEL = 0.2
"""Limbs that end above the lowest one by less than this share of the robot's height also reach down."""

_LEAST_DROP = 0.5
"""A limb reaches down where its end is lower than its start by this share of their distance."""

_LEG_WORDS = ("leg", "hip", "knee", "thigh", "ankle", "foot")
"""Where more than two limbs reach down, those with such words in the names of their joints are the legs."""

REMEDY = "name the feet in a record of the robot (a TOML file, see docs/robots.md)"

_ARM_WORDS = re.compile("shoulder|elbow|wrist|hand|finger|gripper|arm(?![a-z])")
"""Limbs with such words in the names of their joints, and no word of a leg, are arms."""


class NoPairError(DescriptionError):
    """No pair of limbs reaches down along an axis; another one may point up."""


@dataclass(frozen=True, eq=False)
class Standing:
    """A robot as it stands, and which of its joints move.

    Attributes:
        robot: Any robot, its root at the origin.
        stand: Configuration (nq,) at which it stands.
        movable: Pinocchio's indices of the joints that can move.
    """

    robot: Robot
    stand: Array
    movable: frozenset[int]

    def place(self, frame: str) -> Array:
        """Where a link is (3,) [m]."""
        data = self.robot.model.createData()
        pin.framesForwardKinematics(self.robot.model, data, self.stand)
        return np.array(data.oMf[self.robot.frame(frame)].translation)

    def joints_to(self, frame: str) -> list[int]:
        """Pinocchio's indices of the joints that carry a link, from the root outwards."""
        return support(self.robot.model, int(self.robot.model.frames[self.robot.frame(frame)].parentJoint))


def support(model: Any, joint: int) -> list[int]:
    """Pinocchio's indices of a joint and those that carry it, from the root outwards."""
    return [int(j) for j in model.supports[joint] if j > 0]


def standing(robot: Robot, stand: Array, locked: Iterable[str]) -> Standing:
    """A robot as it stands: joints whose limits coincide, and locked ones, do not move.

    Args:
        robot: Any robot, its root at the origin.
        stand: Configuration (nq,) at which it stands.
        locked: Names of further joints that are held.

    Raises:
        UnknownNameError: A locked joint is unknown.
    """
    held = {robot.column(name) for name in locked}
    still = robot.upper <= robot.lower
    model = robot.model
    movable = frozenset(
        j
        for k, j in enumerate(model.getJointId(name) for name in robot.joints)
        if not still[k] and model.idx_qs[j] not in held
    )
    return Standing(robot, stand, movable)


def limbs(known: Standing, up: str) -> list[list[int]]:
    """The joints, from the root to the end, of the two limbs that reach down along an axis of the root link.

    Raises:
        NoPairError: The robot has fewer than two.
        DescriptionError: It has more than two, or no joints.
    """
    robot = known.robot
    if not robot.joints:
        raise DescriptionError(f"{robot.name} has no joints, so no legs")
    paths = _lowest(known, unit_vector(up))
    if len(paths) > 2:
        paths = _named_legs(robot, paths)
    if len(paths) > 2:
        raise DescriptionError(
            f"{robot.name} has no two legs: {len(paths)} limbs or wheels reach down along {up}; {REMEDY}"
        )
    if len(paths) < 2 or not _reach_down(known, paths, unit_vector(up)):
        raise NoPairError(
            f"{robot.name} has no two legs: no pair of limbs with {FEWEST_JOINTS} moving joints or more of "
            f"their own reaches down; {REMEDY}"
        )
    return paths


def forward(known: Standing, feet: tuple[str, str], up: str) -> str:
    """The root link's axis that points forward: from the right foot to the left one, crossed with up.

    Args:
        known: The robot as it stands.
        feet: Links of the left and right foot.
        up: The root link's axis that points up.

    Raises:
        DescriptionError: The feet do not stand side by side.
    """
    left, right = (known.place(foot) for foot in feet)
    top = unit_vector(up)
    across = (left - right) - ((left - right) @ top) * top
    size = float(np.linalg.norm(across))
    front = np.cross(across, top) / max(size, 1e-9)
    axis = nearest_axis(front)
    if size < 1e-3 or unit_vector(axis) @ front < 0.95:
        raise DescriptionError(f"{feet[0]} and {feet[1]} do not stand side by side; {REMEDY}, and `forward`")
    return axis


def sided(known: Standing, ends: tuple[str, str], joints: list[list[str]], up: str, front: str = "") -> bool:
    """Whether the first of two limbs is the left one: by the letter in which names differ, else by place.

    Args:
        known: The robot as it stands.
        ends: The links of the feet.
        joints: The joints of both limbs, from where they part.
        up: The root link's axis that points up.
        front: The axis that points forward; x, or -z where x points up, if left out.
    """
    for one, other in ((ends[0], ends[1]), *zip(*joints, strict=False)):
        sides = _difference(one, other)
        if set(sides) == {"l", "r"}:
            return sides == ("l", "r")
    top = unit_vector(up)
    y = np.cross(top, unit_vector(front or ("-z" if abs(top[0]) > 0.5 else "x")))
    return bool((known.place(ends[0]) - known.place(ends[1])) @ y > 0)


def _lowest(known: Standing, up: Array) -> list[list[int]]:
    """All limbs that reach down, their joints from the root to the end, the lowest first."""
    model = known.robot.model
    data = model.createData()
    pin.forwardKinematics(model, data, known.stand)
    heights = np.array([data.oMi[j].translation @ up for j in range(1, model.njoints)])
    ends = sorted(set(range(1, model.njoints)) - set(model.parents), key=lambda j: heights[j - 1])
    every = [support(model, j) for j in ends]
    no_arms = [path for path in every if not arm_joints(model.names[j] for j in path)]
    paths = no_arms if len(no_arms) > 1 else every  # long arms may hang lower than the feet
    low = heights[paths[0][-1] - 1] + _SAME_LEVEL * float(np.ptp(heights))
    found: list[list[int]] = []
    for path in paths:
        if heights[path[-1] - 1] <= low and all(_apart(known, path, other) for other in found):
            found.append(path)
    return found


def _reach_down(known: Standing, paths: list[list[int]], up: Array) -> bool:
    """Whether two limbs lead down from where they part, rather than to the side."""
    data = known.robot.model.createData()
    pin.forwardKinematics(known.robot.model, data, known.stand)
    for path, other in (paths, paths[::-1]):
        own = [np.array(data.oMi[j].translation) for j in path if j not in other]
        line = own[0] - own[-1]
        if line @ up < _LEAST_DROP * float(np.linalg.norm(line)) or line @ up <= 0:
            return False
    return True


def _apart(known: Standing, one: list[int], other: list[int]) -> bool:
    """Whether two paths are two limbs: each has the joints of a leg of its own. Toes of one foot have not."""
    shared = set(one) & set(other)
    return all(len(known.movable & (set(path) - shared)) >= FEWEST_JOINTS for path in (one, other))


def _named_legs(robot: Robot, paths: list[list[int]]) -> list[list[int]]:
    """The limbs that are legs by the names of the joints that they do not share; all where none is."""
    common = set.intersection(*map(set, paths))
    names = [" ".join(robot.model.names[j].lower() for j in path if j not in common) for path in paths]
    legs = [path for path, name in zip(paths, names, strict=True) if any(word in name for word in _LEG_WORDS)]
    return legs if len(legs) == 2 else paths


def arm_joints(joints: Iterable[str]) -> tuple[str, ...]:
    """Joints of a limb that are an arm's by their names; none where others of the limb are a leg's."""
    names = tuple(joints)
    if any(word in name.lower() for name in names for word in _LEG_WORDS):
        return ()
    return tuple(name for name in names if _ARM_WORDS.search(name.lower()))


def _difference(one: str, other: str) -> tuple[str, str]:
    """The first letters in which two names differ, in lower case: (`l`, `r`) for `LLEG_6` and `RLEG_6`."""
    for a, b in zip(one.lower(), other.lower(), strict=False):
        if a != b:
            return a, b
    return "", ""

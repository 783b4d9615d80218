"""A target made ready: its URDF found and loaded, its legs read, its axes known."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.examples import located
from exo_pin.files import read_text
from exo_pin.retarget import leg_search, target_file
from exo_pin.retarget.axes import direction
from exo_pin.retarget.robot_legs import RobotLeg, robot_leg
from exo_pin.retarget.target_robots import TARGETS, UNFIT, Target
from exo_pin.robot import Robot, load_urdf

PI = repr(math.pi)


@dataclass(frozen=True, eq=False)
class Machine:
    """A robot with two legs, ready to walk.

    Attributes:
        target: Its record, what was left out filled in.
        robot: The robot, its root at the origin.
        stand: Configuration (nq,) at which it stands.
        turn: Rotation (3, 3) from the walker's axes (x forward, y left, z up) to the root link's.
        legs: Left and right.
    """

    target: Target
    robot: Robot
    stand: Array
    turn: Array
    legs: tuple[RobotLeg, RobotLeg]

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of both legs, left first."""
        return self.legs[0].joints + self.legs[1].joints


def find(target: str | Path | Target) -> Target:
    """The target of that name, or of that file (a URDF, or a TOML record of one); a record is handed back.

    Raises:
        UnknownNameError: There is none.
        DescriptionError: It cannot be retargeted to, and why.
        FormatError: The record is not accepted.
    """
    if isinstance(target, Target):
        return target
    path = Path(target)
    if str(target) in TARGETS:
        return TARGETS[str(target)]
    if str(target).lower() in UNFIT:
        raise DescriptionError(f"{target}: {UNFIT[str(target).lower()]}")
    if path.suffix.lower() == ".toml":
        return target_file.load(path)
    if path.suffix.lower() == ".xacro":
        raise DescriptionError(f"{target} is a xacro; write the URDF first: xacro {path.name} > robot.urdf")
    if path.suffix.lower() == ".urdf" or path.exists():
        return Target(path.stem, path)
    raise UnknownNameError("robot (a name, a .urdf or a .toml record)", str(target), TARGETS)


def load(target: str | Path | Target) -> Machine:
    """The target's robot, its base held at the origin.

    Raises:
        UnknownNameError: The target, a joint or a link of the record is unknown.
        DescriptionError: The URDF is missing or no robot with two legs.
        FormatError: The record is not accepted.
    """
    found = find(target)
    path = _packaged(found) if isinstance(found.file, str) else found.file
    return ready(found, load_urdf(_prepared(found, path), path=path))


def ready(target: Target, robot: Robot) -> Machine:
    """A robot that is loaded already as a machine; what the record leaves out is found.

    Raises:
        UnknownNameError: A joint or link of the record is unknown.
        DescriptionError: It is no robot with two legs.
    """
    stand = robot.q(target.stand)
    feet, up = target.feet, target.up or "z"
    if len(feet) != 2:
        feet, up = leg_search.feet_and_up(robot, stand, target.up)
    left, right = feet
    front = target.forward or leg_search.forward(robot, stand, (left, right), up)
    turn = _turn(front, up)
    legs = [
        robot_leg(robot, side, foot, joints, stand, turn)
        for side, foot, joints in zip(
            SIDES, (left, right), leg_search.chains(robot, (left, right)), strict=True
        )
    ]
    return Machine(target, robot, stand, turn, (legs[0], legs[1]))


def _turn(front: str, up: str) -> Array:
    x, z = direction(front), direction(up)
    if abs(x @ z) > 0:
        raise DescriptionError(f"forward is {front} and up is {up}; they must be square to each other")
    return np.stack([x, np.cross(z, x), z], axis=1)


def _packaged(target: Target) -> Path:
    """Where example-robot-data has the target's URDF."""
    path = located(str(target.file))
    if path is None:
        raise DescriptionError(f"{target.name} needs example-robot-data, which has no {target.file} here")
    return path


def _prepared(target: Target, path: Path) -> str:
    """The URDF's text with the record's limits in it, and only joints of one number with limits."""
    text = read_text(path)
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise DescriptionError(f"{path} is no URDF: {error}") from None
    if root.tag != "robot":
        raise DescriptionError(f"{path} is no URDF: its root element is <{root.tag}>, not <robot>")
    joints = {str(joint.get("name")): joint for joint in root.findall("joint")}
    for joint in joints.values():
        _bounded(joint)
    for name, (low, high) in target.limits.items():
        limit = joints[name].find("limit") if name in joints else None
        if limit is None:
            raise UnknownNameError("joint with limits", name, joints)
        limit.set("lower", repr(low))
        limit.set("upper", repr(high))
    return ET.tostring(root, encoding="unicode")


def _bounded(joint: ET.Element) -> None:
    """An endless joint gets half a turn each way, one that floats or glides in a plane is held."""
    if joint.get("type") in ("floating", "planar"):
        joint.set("type", "fixed")
    elif joint.get("type") == "continuous":
        joint.set("type", "revolute")
        limit = joint.find("limit")
        if limit is None:
            limit = ET.SubElement(joint, "limit", effort="0", velocity="0")
        limit.set("lower", f"-{PI}")
        limit.set("upper", PI)

"""Two-legged robots: the URDF of a target found and loaded, its legs and axes read."""

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
from exo_pin.retarget.axes import unit_vector
from exo_pin.retarget.robot_legs import RobotLeg, robot_leg
from exo_pin.retarget.target_robots import TARGETS, UNFIT, Target
from exo_pin.robot import Robot, load_urdf

_PI = repr(math.pi)


@dataclass(frozen=True, eq=False)
class Biped:
    """A robot with two legs to which a walk can be retargeted.

    Attributes:
        target: Its record.
        robot: The robot; its root stands at the origin.
        stand: Configuration (nq,) at which it stands.
        rotation: Rotation matrix (3, 3) from the walker's axes (x forward, y left, z up) to the root link's.
        legs: Left and right.
    """

    target: Target
    robot: Robot
    stand: Array
    rotation: Array
    legs: tuple[RobotLeg, RobotLeg]

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of both legs, left first."""
        return self.legs[0].joints + self.legs[1].joints

    @property
    def joints_per_leg(self) -> int:
        """Number of joints of each leg."""
        return len(self.legs[0].joints)

    @property
    def hip_order(self) -> str:
        """The hip's axes from the pelvis outwards, in words."""
        return self.legs[0].hip_order


def find(target: str | Path | Target) -> Target:
    """The target of a name, or of a file (a URDF, or a TOML record of one); a record is returned as it is.

    Raises:
        UnknownNameError: There is no such target.
        DescriptionError: Walks cannot be retargeted to it; the message has the reason.
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


def load(target: str | Path | Target) -> Biped:
    """The target's robot, its base held at the origin.

    Raises:
        UnknownNameError: The target, a joint or a link of the record is unknown.
        DescriptionError: The URDF is missing or no robot with two legs.
        FormatError: The record is not accepted.
    """
    found = find(target)
    path = _packaged(found) if isinstance(found.file, str) else found.file
    return as_biped(found, load_urdf(_prepared(found, path), path=path))


def as_biped(target: Target, robot: Robot) -> Biped:
    """A loaded robot as a biped; feet and directions that its record lacks are found in its structure.

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
    rotation = _rotation(front, up)
    legs = [
        robot_leg(robot, side, foot, joints, stand, rotation)
        for side, foot, joints in zip(
            SIDES, (left, right), leg_search.leg_joints(robot, (left, right)), strict=True
        )
    ]
    return Biped(target, robot, stand, rotation, (legs[0], legs[1]))


def _rotation(front: str, up: str) -> Array:
    x, z = unit_vector(front), unit_vector(up)
    if abs(x @ z) > 0:
        raise DescriptionError(f"forward is {front} and up is {up}; they must be square to each other")
    return np.stack([x, np.cross(z, x), z], axis=1)


def _packaged(target: Target) -> Path:
    """Path of the target's URDF in example-robot-data."""
    path = located(str(target.file))
    if path is None:
        raise DescriptionError(f"{target.name} needs example-robot-data, which has no {target.file} here")
    return path


def _prepared(target: Target, path: Path) -> str:
    """The URDF's text with the record's limits, all moving joints revolute or prismatic and limited."""
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
    """Limit a continuous joint to half a revolution each way; fix a floating or planar one."""
    if joint.get("type") in ("floating", "planar"):
        joint.set("type", "fixed")
    elif joint.get("type") == "continuous":
        joint.set("type", "revolute")
        limit = joint.find("limit")
        if limit is None:
            limit = ET.SubElement(joint, "limit", effort="0", velocity="0")
        limit.set("lower", f"-{_PI}")
        limit.set("upper", _PI)

"""Joints of a URDF as they are accepted: limits judged, endless joints bounded, floating joints held.

Everything that is wrong in a description is refused here, before Pinocchio builds the model: its XML and tree
(`urdf_tree`), its numbers (`urdf_numbers`), the limits of its joints.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.robot import urdf_numbers, urdf_tree
from exo_pin.robot.urdf_tree import shown

_PI = repr(math.pi)
_HELD = ("floating", "planar")


class Accepted(NamedTuple):
    """A URDF whose joints are accepted.

    Attributes:
        text: Its text, all moving joints revolute or prismatic and limited.
        remarks: What was changed in it, a plain sentence each.
    """

    text: str
    remarks: tuple[str, ...]


class Follower(NamedTuple):
    """A joint that follows another (`<mimic>`): its position is `ratio` times the leader's plus `offset`.

    Attributes:
        leader: Name of the joint that it follows.
        ratio: Its motion over the leader's.
        offset: Its position where the leader's is zero [rad]; of prismatic joints [m].
    """

    leader: str
    ratio: float
    offset: float


def accepted(text: str) -> Accepted:
    """A URDF's text with joints that can be used: half a turn each way without end stops, none that float.

    Args:
        text: The URDF.

    Raises:
        DescriptionError: It is no URDF, no tree of links, too large, or a number in it is not accepted, as is
            a lower limit above the upper one; the message names the link or joint.
    """
    root = urdf_tree.parsed(text)
    urdf_tree.judge(root)
    urdf_numbers.judge(root)
    joints = root.findall("joint")
    for joint in joints:
        _judge_limits(joint)
    endless = [joint for joint in joints if joint.get("type") == "continuous"]
    held = [joint for joint in joints if joint.get("type") in _HELD]
    if not endless and not held:
        return Accepted(text, ())
    remarks = []
    if endless:
        remarks.append(f"half a turn each way for joints without end stops: {_names(endless)}")
    if held:
        remarks.append(f"floating or planar joints are held: {_names(held)}")
    for joint in endless:
        _bound(joint)
    for joint in held:
        joint.set("type", "fixed")
    return Accepted(ET.tostring(root, encoding="unicode"), tuple(remarks))


def with_limits(text: str, limits: Mapping[str, tuple[float, float]]) -> str:
    """A URDF's text with other limits of some joints.

    Args:
        text: The URDF.
        limits: Lower and upper limit by joint [rad]; of prismatic joints [m].

    Raises:
        DescriptionError: It is no XML.
        UnknownNameError: It has no such joint that moves.
    """
    root = urdf_tree.parsed(text)
    joints = {
        str(joint.get("name")): joint for joint in root.findall("joint") if joint.get("type") != "fixed"
    }
    for name, (lower, upper) in limits.items():
        if name not in joints:
            raise UnknownNameError("joint with limits", name, joints)
        _bound(joints[name], repr(lower), repr(upper))
    return ET.tostring(root, encoding="unicode")


def followers(text: str) -> dict[str, Follower]:
    """The joints of a URDF that follow others, by name.

    Raises:
        DescriptionError: A ratio or offset is no number, or joints follow each other in a circle.
    """
    root = urdf_tree.parsed(text)
    found: dict[str, Follower] = {}
    for joint in root.findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None and joint.get("type") != "fixed":
            name = str(joint.get("name"))
            ratio = urdf_numbers.of_joint(joint, mimic, "multiplier", default=1.0)
            offset = urdf_numbers.of_joint(joint, mimic, "offset", default=0.0)
            found[name] = Follower(str(mimic.get("joint")), ratio, offset)
    return {name: _followed(name, found) for name in found}


def _followed(name: str, known: Mapping[str, Follower]) -> Follower:
    """The joint at the end of the line that a joint follows: a leader that follows nobody."""
    leader, ratio, offset = known[name]
    seen = {name}
    while leader in known:
        if leader in seen:
            raise DescriptionError(f"joint {name!r} follows itself: <mimic> joints in a circle")
        seen.add(leader)
        further = known[leader]
        ratio, offset = ratio * further.ratio, offset + ratio * further.offset
        leader = further.leader
    return Follower(leader, ratio, offset)


def _judge_limits(joint: ET.Element) -> None:
    limit, name = joint.find("limit"), shown(joint.get("name"))
    if limit is None or joint.get("type") not in ("revolute", "prismatic"):
        return
    lower, upper = (urdf_numbers.of_joint(joint, limit, end, default=0.0) for end in ("lower", "upper"))
    if lower > upper:
        raise DescriptionError(
            f"joint {name!r}: its lower limit {_said(joint, lower)} is above its upper limit "
            f"{_said(joint, upper)}; swap them, or set limits_deg in a record of the robot (docs/robots.md)"
        )


def _said(joint: ET.Element, value: float) -> str:
    """A limit in its unit."""
    return f"{value:g} m" if joint.get("type") == "prismatic" else f"{math.degrees(value):.4g} deg"


def _bound(joint: ET.Element, lower: str = f"-{_PI}", upper: str = _PI) -> None:
    """Limit a joint; one without end stops becomes revolute."""
    if joint.get("type") == "continuous":
        joint.set("type", "revolute")
    limit = joint.find("limit")
    if limit is None:
        limit = ET.SubElement(joint, "limit")
    for attribute in ("effort", "velocity"):
        limit.set(attribute, limit.get(attribute, "0"))
    limit.set("lower", lower)
    limit.set("upper", upper)


def _names(joints: Iterable[ET.Element]) -> str:
    return ", ".join(str(joint.get("name")) for joint in joints)

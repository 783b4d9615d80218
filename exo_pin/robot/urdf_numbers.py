"""Numbers of a URDF: finite, as many as expected, within what a robot can have."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import NamedTuple

from exo_pin.errors import DescriptionError
from exo_pin.robot.urdf_tree import shown
from exo_pin.safe import plain_numbers


class _Kind(NamedTuple):
    """What an attribute may hold.

    Attributes:
        length: How many numbers.
        low: The least.
        high: The most.
        unit: Of the numbers.
        needed: Whether it must be there.
    """

    length: int
    low: float
    high: float
    unit: str = ""
    needed: bool = False


_PLACE = _Kind(3, -1e3, 1e3, "m")
_ANGLES = _Kind(3, -1e3, 1e3, "rad")
_INERTIA = _Kind(1, -1e6, 1e6, "kg m^2")
_SIZE = _Kind(1, 0.0, 1e3, "m", needed=True)
_ANY = _Kind(1, -1e20, 1e20)  # limits of 1e16 stand for none in files of several exporters
_POSITIVE = _Kind(1, 0.0, 1e20)

_ORIGIN = {"origin": {"xyz": _PLACE, "rpy": _ANGLES}}
_GEOMETRY = {
    **_ORIGIN,
    "geometry/box": {"size": _SIZE._replace(length=3)},
    "geometry/cylinder": {"radius": _SIZE, "length": _SIZE},
    "geometry/sphere": {"radius": _SIZE},
    "geometry/capsule": {"radius": _SIZE, "length": _SIZE},
    "geometry/mesh": {"scale": _Kind(3, -1e6, 1e6)},
    "material/color": {"rgba": _Kind(4, 0.0, 255.0)},
}
_INERTIAL = {
    **_ORIGIN,
    "mass": {"value": _Kind(1, 0.0, 1e6, "kg", needed=True)},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), _INERTIA),
}
_JOINT = {
    **_ORIGIN,
    "axis": {"xyz": _Kind(3, -1e6, 1e6)},
    "limit": {"lower": _ANY, "upper": _ANY, "effort": _POSITIVE, "velocity": _POSITIVE},
    "dynamics": {"damping": _ANY, "friction": _ANY},
    "mimic": {"multiplier": _ANY, "offset": _ANY},
}
_OWNERS: tuple[tuple[str, str, Mapping[str, Mapping[str, _Kind]]], ...] = (
    ("joint", ".", _JOINT),
    ("link", "inertial", _INERTIAL),
    ("link", "visual", _GEOMETRY),
    ("link", "collision", _GEOMETRY),
    ("material", ".", {"color": {"rgba": _Kind(4, 0.0, 255.0)}}),
)
"""Where numbers stand: the element that has a name, the element inside, and in it element -> attribute."""

_MOVING = ("revolute", "continuous", "prismatic")
_THINNEST = 1e-6
"""Of an axis: its length; of a mesh: its scale along each axis."""


def judge(root: ET.Element) -> None:
    """Refuse numbers that are none, not finite, too few or many, or beyond what a robot has.

    Raises:
        DescriptionError: The message names the link or joint, the element and what is accepted.
    """
    for tag, inner, elements in _OWNERS:
        for owner in root.findall(tag):
            place = f"{tag} {shown(owner.get('name'))!r}"
            for part in owner.findall(inner):
                _judge_part(place, part, elements)
    for joint in root.findall("joint"):
        axis = joint.find("axis")
        if axis is not None and joint.get("type") in _MOVING:
            _judge_axis(f"joint {shown(joint.get('name'))!r}", axis)


def of_joint(joint: ET.Element, part: ET.Element, attribute: str, *, default: float) -> float:
    """A number of a joint's limit or `<mimic>`.

    Args:
        joint: The joint.
        part: The element inside.
        attribute: Which number.
        default: What it is where the element leaves it out.

    Raises:
        DescriptionError: It is no finite number.
    """
    values = _numbers(f"joint {shown(joint.get('name'))!r}", part, attribute, _ANY)
    return values[0] if values else default


def _judge_part(place: str, part: ET.Element, elements: Mapping[str, Mapping[str, _Kind]]) -> None:
    for path, attributes in elements.items():
        for element in part.findall(path):
            for name, kind in attributes.items():
                values = _numbers(place, element, name, kind)
                if (element.tag, name) == ("mesh", "scale") and any(abs(x) < _THINNEST for x in values):
                    accepted = f"three numbers of at least {_THINNEST:g} (or negative, which mirrors)"
                    raise _refusal(place, element, name, accepted)


def _judge_axis(place: str, axis: ET.Element) -> None:
    values = plain_numbers.finite(axis.get("xyz", "1 0 0"))
    if sum(x * x for x in values) < _THINNEST**2:
        raise _refusal(place, axis, "xyz", "a direction, e.g. 0 1 0,")


def _numbers(place: str, element: ET.Element, name: str, kind: _Kind) -> list[float]:
    text = element.get(name)
    if text is None and not kind.needed:
        return []
    words = {1: "a finite number", 3: "three finite numbers"}.get(
        kind.length, f"{kind.length} finite numbers"
    )
    try:
        values = plain_numbers.finite(text or "", kind.length)
    except ValueError:
        raise _refusal(place, element, name, words) from None
    if not all(kind.low <= value <= kind.high for value in values):
        within = f"from {kind.low:g} to {kind.high:g} {kind.unit}".rstrip()
        raise _refusal(place, element, name, f"{words} {within}")
    return values


def _refusal(place: str, element: ET.Element, name: str, accepted: str) -> DescriptionError:
    text = element.get(name)
    what = "is missing" if text is None else f"is {shown(text)!r}"
    verb = "is" if accepted.startswith("a ") else "are"
    return DescriptionError(f"{place}: {name} of <{element.tag}> {what}; {accepted} {verb} accepted")

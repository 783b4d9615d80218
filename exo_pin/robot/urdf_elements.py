"""Elements of a URDF as values: poses, colours, limits, the ends of joints."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from typing import Literal

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError


def pose(origin: ET.Element | None) -> Array:
    """`(4, 4)` pose of a URDF `<origin>`: xyz [m] and fixed-axis roll, pitch, yaw [rad]."""
    T = np.eye(4)
    if origin is not None:
        T[:3, :3] = rotation(*numbers(origin.get("rpy", "0 0 0")))
        T[:3, 3] = numbers(origin.get("xyz", "0 0 0"))
    return T


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """`(3, 3)` rotation by fixed-axis angles.

    Args:
        roll: About x, first [rad].
        pitch: About y [rad].
        yaw: About z, last [rad].
    """
    (a, b, c), (s, t, u) = (map(f, (roll, pitch, yaw)) for f in (math.cos, math.sin))
    Rx = np.array([[1, 0, 0], [0, a, -s], [0, s, a]])
    Ry = np.array([[b, 0, t], [0, 1, 0], [-t, 0, b]])
    Rz = np.array([[c, -u, 0], [u, c, 0], [0, 0, 1]])
    R: Array = Rz @ Ry @ Rx
    return R


def limits(joint: ET.Element) -> tuple[float, float] | None:
    """Lower and upper limit of a joint [rad, m]; None: it has none."""
    limit = joint.find("limit")
    if joint.get("type") == "continuous" or limit is None:
        return None
    return float(limit.get("lower", 0)), float(limit.get("upper", 0))


def end(joint: ET.Element, which: Literal["parent", "child"]) -> str:
    """The `parent` or `child` link of a joint."""
    element = joint.find(which)
    if element is None or not element.get("link"):
        raise DescriptionError(f"joint {joint.get('name')!r} of the URDF names no {which} link")
    return str(element.get("link"))


def rgba(material: ET.Element) -> tuple[float, float, float, float] | None:
    """The colour of a `<material>`, if it has one."""
    color = material.find("color")
    if color is None:
        return None
    red, green, blue, opacity = numbers(color.get("rgba", "0.7 0.7 0.7 1"))
    return red, green, blue, opacity


def numbers(text: str) -> list[float]:
    """The numbers of an attribute."""
    return [float(part) for part in text.split()]

"""Shapes of a URDF as solids, and names of links as names of nodes."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

from exo_pin.robot.urdf_elements import numbers
from exo_pin.viewer.meshes import solids
from exo_pin.viewer.meshes.solids import Solid


def solid(geometry: ET.Element | None) -> Solid | None:
    """The primitive of a `<geometry>`; None: it is a mesh, or nothing."""
    if geometry is None:
        return None
    if (found := geometry.find("box")) is not None:
        return solids.box(numbers(found.get("size", "")))
    if (found := geometry.find("cylinder")) is not None:
        return solids.cylinder(float(found.get("radius", 0)), float(found.get("length", 0)))
    if (found := geometry.find("sphere")) is not None:
        return solids.sphere(float(found.get("radius", 0)))
    return None


def node(link: str) -> str:
    """A link's name as the name of a node: `/` separates nodes, and `<object>` is meshcat's own."""
    return re.sub(r"[^\w.-]", "_", link)

"""Errors of the model: the simulated machine is heavier or longer than the controller believes."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from xml.etree import ElementTree

from exo_pin.robot import Robot, load_urdf
from exo_pin.safe.xml_reader import parse_xml

_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def with_errors(robot: Robot, *, mass: float = 0.0, length: float = 0.0) -> Robot:
    """The same floating robot, heavier by the part `mass`, longer in all directions by the part `length`.

    Args:
        robot: A floating robot.
        mass: Of every link; 0.1 is 10 % more.
        length: Of every link.
    """
    if mass == 0.0 and length == 0.0:
        return robot
    heavier, longer = 1.0 + mass, 1.0 + length
    root = parse_xml(robot.urdf, robot.path or Path("URDF"))
    for origin in root.iter("origin"):
        _scale(origin, "xyz", longer)
    for element in root.iter("mass"):
        _scale(element, "value", heavier)
    for element in root.iter("inertia"):
        for name in _INERTIA:
            _scale(element, name, heavier * longer**2)
    text = ElementTree.tostring(root, encoding="unicode")
    made = load_urdf(
        text, base="floating", placement=robot.placement, hip_order=robot.hip_order, path=robot.path
    )
    return dataclasses.replace(made, body=robot.body, device=robot.device)


def _scale(element: ElementTree.Element, name: str, factor: float) -> None:
    """Multiply the numbers of an attribute."""
    text = element.get(name)
    if text is not None:
        element.set(name, " ".join(repr(float(float(x) * factor)) for x in text.split()))

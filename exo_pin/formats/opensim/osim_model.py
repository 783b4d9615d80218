"""OpenSim models (.osim, versions 2 to 4): the joints, as far as they tell how coordinates are meant."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.osim_joint import Axis, Joint, Vector, X, Y, Z, offset
from exo_pin.safe.xml_reader import load_xml

GROUND = "ground"
FIXED = {
    "FreeJoint": ("rx", "ry", "rz", "tx", "ty", "tz"),
    "BallJoint": ("rx", "ry", "rz"),
    "GimbalJoint": ("rx", "ry", "rz"),
    "UniversalJoint": ("rx", "ry"),
    "PlanarJoint": ("rz", "tx", "ty"),
    "PinJoint": ("rz",),
    "SliderJoint": ("tx",),
    "WeldJoint": (),
}
"""Kind of joint -> what its coordinates do, in their order; turns are about axes of the turned frame."""

AXES = {"x": X, "y": Y, "z": Z}
LONGEST_CHAIN = 20
"""Joints between a body and the ground; also ends a chain that bites its tail."""


class Coordinate(NamedTuple):
    """What moves a joint, and its value where nobody says one [rad, m]."""

    name: str
    default: float


class OsimModel(NamedTuple):
    """The joints of a model.

    Attributes:
        path: The file.
        name: Of the model.
        joints: By the body that each carries.
        defaults: Coordinate -> value where a motion does not name it [rad, m].
    """

    path: Path
    name: str
    joints: dict[str, Joint]
    defaults: dict[str, float]

    def moved_by(self, coordinate: str) -> Joint | None:
        """The first joint that a coordinate turns, or None."""
        return next((j for j in self.joints.values() if coordinate in [a.coordinate for a in j.turns]), None)

    def chain(self, body: str) -> list[Joint]:
        """The joints from the ground to a body.

        Raises:
            FormatError: The body hangs on nothing, or on a joint of a kind that is not read.
        """
        found: list[Joint] = []
        while body != GROUND:
            if body not in self.joints or len(found) > LONGEST_CHAIN:
                known = ", ".join([*FIXED, "CustomJoint"])
                why = f"no joints of a known kind ({known}) lead from the ground to body {body[:60]!r}"
                raise FormatError(self.path, why)
            found.insert(0, self.joints[body])
            body = found[0].parent
        return found


def load_model(path: str | Path) -> OsimModel:
    """Read the joints of an OpenSim model.

    Raises:
        FormatError: With file and reason: no XML, no OpenSim model, numbers that are none.
    """
    path = Path(path)
    root = load_xml(path)
    model = root.find("Model")
    if root.tag != "OpenSimDocument" or model is None:
        raise FormatError(path, "not an OpenSim model: no <Model> in an <OpenSimDocument>")
    joints: dict[str, Joint] = {}
    defaults: dict[str, float] = {}
    for element, child in _joint_elements(model):
        own = [
            Coordinate(c.get("name", ""), _number(path, c.findtext("default_value", "0")))
            for c in element.iter("Coordinate")
        ]
        joint = _joint(path, element, child, [c.name for c in own])
        joints.setdefault(joint.child, joint)
        defaults |= dict(own)
    if not joints:
        raise FormatError(path, "an OpenSim model without joints of a known kind")
    return OsimModel(path, model.get("name", ""), joints, defaults)


def _joint_elements(model: Element) -> Iterator[tuple[Element, str]]:
    """Joints with the body that carries them in its own element (version 3), or "" (version 4)."""
    for body in model.iter("Body"):
        for element in body.findall("Joint/*"):
            if _known(element):
                yield element, body.get("name", "")
    for element in model.iter():
        if _known(element) and element.find("socket_parent_frame") is not None:
            yield element, ""


def _known(element: Element) -> bool:
    # version 3 may swap child and parent
    turned_round = (element.findtext("reverse") or "").strip() == "true"
    return (element.tag in FIXED or element.tag == "CustomJoint") and not turned_round


def _joint(path: Path, element: Element, child: str, coordinates: list[str]) -> Joint:
    name = element.get("name", element.tag)
    if child:
        parent = (element.findtext("parent_body") or "").strip()
        frames = [
            offset(_vector(path, element, f"location{end}"), _vector(path, element, f"orientation{end}"))
            for end in ("_in_parent", "")
        ]
    else:
        (parent, first), (child, second) = (_frame(path, element, end) for end in ("parent", "child"))
        frames = [first, second]
    if element.tag == "CustomJoint":
        axes = [_axis(path, axis) for axis in element.findall("SpatialTransform/TransformAxis")]
        turns, slides = tuple(a for a, turn in axes if turn), tuple(a for a, turn in axes if not turn)
    else:
        turns, slides = _fixed(path, element, name, coordinates)
    return Joint(name, parent, child, frames[0], frames[1], turns, slides)


def _fixed(path: Path, element: Element, name: str, coordinates: list[str]) -> tuple[tuple[Axis, ...], ...]:
    """Turns and slides of a joint whose kind says what its coordinates do."""
    kinds = FIXED[element.tag]
    if len(coordinates) != len(kinds):
        why = f"joint {name[:60]!r} has {len(coordinates)} coordinates; a {element.tag} has {len(kinds)}"
        raise FormatError(path, why)
    both = list(zip(kinds, coordinates, strict=True))
    return tuple(tuple(Axis(AXES[kind[1]], c) for kind, c in both if kind[0] == what) for what in "rt")


def _frame(path: Path, element: Element, end: str) -> tuple[str, Array]:
    """The body that a joint's socket leads to, and the joint's frame in it."""
    said = (element.findtext(f"socket_{end}_frame") or "").strip().rpartition("/")[2]
    for frame in element.findall("frames/PhysicalOffsetFrame"):
        if frame.get("name") == said:
            body = (frame.findtext("socket_parent") or "").strip().rpartition("/")[2]
            return body, offset(_vector(path, frame, "translation"), _vector(path, frame, "orientation"))
    return said, np.eye(4)


def _axis(path: Path, element: Element) -> tuple[Axis, bool]:
    """An axis of a CustomJoint, and whether it turns."""
    vector = _vector(path, element, "axis")
    length = math.hypot(*vector)
    names = (element.findtext("coordinates") or "").split()
    slope, start, linear = (1.0 if names else 0.0), 0.0, len(names) < 2
    for inner in (*element, *element.findall("function/*")):
        if inner.tag in FUNCTIONS:
            slope, start, linear = _function(path, inner)
    x, y, z = (part / length for part in vector) if length else vector
    coordinate = names[0] if names and (slope or not linear) else ""
    turns = element.get("name", "").startswith("rotation")
    return Axis((x, y, z), coordinate, slope, start, linear and len(names) < 2), turns


FUNCTIONS = (
    *("LinearFunction", "Constant", "MultiplierFunction", "PolynomialFunction"),
    *("SimmSpline", "NaturalCubicSpline", "PiecewiseLinearFunction", "GCVSpline"),
)
"""Functions that are read; of a curve the mean slope, which tells its direction."""


def _function(path: Path, element: Element) -> tuple[float, float, bool]:
    """Slope, value at 0 and whether that is all."""
    if element.tag == "Constant":
        return 0.0, _number(path, element.findtext("value", "0")), True
    if element.tag == "MultiplierFunction":
        inner = next((e for e in element.findall("function/*") if e.tag in FUNCTIONS), None)
        scale = _number(path, element.findtext("scale", "1"))
        slope, start, linear = (0.0, 0.0, False) if inner is None else _function(path, inner)
        return scale * slope, scale * start, linear
    if element.tag in ("LinearFunction", "PolynomialFunction"):
        numbers = [0.0, 0.0, *_numbers(path, element.findtext("coefficients", "1 0"))]
        return numbers[-2], numbers[-1], not any(numbers[:-2])
    x, y = (_numbers(path, element.findtext(name, "")) for name in "xy")
    if len(x) < 2 or len(x) != len(y) or x[0] == x[-1]:
        return 0.0, 0.0, False
    slope = (y[-1] - y[0]) / (x[-1] - x[0])
    return slope, y[0] - slope * x[0], False


def _vector(path: Path, element: Element, name: str) -> Vector:
    """Three numbers; zeros where there is no such element."""
    numbers = _numbers(path, element.findtext(name) or "0 0 0")
    if len(numbers) != 3:
        raise FormatError(path, f"<{name}> holds {len(numbers)} numbers, expected 3")
    return numbers[0], numbers[1], numbers[2]


def _numbers(path: Path, text: str) -> list[float]:
    return [_number(path, word) for word in text.split()]


def _number(path: Path, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        raise FormatError(path, f"{text.strip()[:40]!r} is no number") from None
    if not abs(number) < 1e9:
        raise FormatError(path, f"{text.strip()[:40]} is no length or angle")
    return number

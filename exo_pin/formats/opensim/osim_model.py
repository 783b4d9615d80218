"""Joints of an OpenSim model (.osim, versions 2 to 4): axes and default coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.osim_joint import AXIS_X, AXIS_Y, AXIS_Z, Axis, Joint, offset
from exo_pin.formats.opensim.osim_xml import axis_of, number_of, vector_of
from exo_pin.safe.xml_reader import load_xml

_GROUND = "ground"
_MOTIONS_OF_KIND = {
    "FreeJoint": ("rx", "ry", "rz", "tx", "ty", "tz"),
    "BallJoint": ("rx", "ry", "rz"),
    "GimbalJoint": ("rx", "ry", "rz"),
    "UniversalJoint": ("rx", "ry"),
    "PlanarJoint": ("rz", "tx", "ty"),
    "PinJoint": ("rz",),
    "SliderJoint": ("tx",),
    "WeldJoint": (),
}
"""Kind of joint -> motions of its coordinates, in their order: r is a rotation about, t a translation along
an axis of the rotated frame."""

_AXES = {"x": AXIS_X, "y": AXIS_Y, "z": AXIS_Z}
_LONGEST_CHAIN = 20
"""Joints between a body and the ground; also ends a chain that bites its tail."""


class Coordinate(NamedTuple):
    """A coordinate of a joint, and its value where a motion does not have it [rad, m]."""

    name: str
    default: float


class OsimModel(NamedTuple):
    """The joints of a model.

    Attributes:
        path: The file.
        name: Of the model.
        joints: By the body that each carries.
        defaults: Coordinate -> value where a motion does not have it [rad, m].
        mass: Of all bodies together [kg].
    """

    path: Path
    name: str
    joints: dict[str, Joint]
    defaults: dict[str, float]
    mass: float = 0.0

    def moved_by(self, coordinate: str) -> Joint | None:
        """The first joint that a coordinate rotates, or None."""
        return next(
            (j for j in self.joints.values() if coordinate in [a.coordinate for a in j.rotations]), None
        )

    def chain(self, body: str) -> list[Joint]:
        """The joints from the ground to a body.

        Raises:
            FormatError: The body hangs on nothing, or on a joint of a kind that is not read.
        """
        found: list[Joint] = []
        while body != _GROUND:
            if body not in self.joints or len(found) > _LONGEST_CHAIN:
                known = ", ".join([*_MOTIONS_OF_KIND, "CustomJoint"])
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
            Coordinate(c.get("name", ""), number_of(path, c.findtext("default_value", "0")))
            for c in element.iter("Coordinate")
        ]
        joint = _joint(path, element, child, [c.name for c in own])
        joints.setdefault(joint.child, joint)
        defaults |= dict(own)
    if not joints:
        raise FormatError(path, "an OpenSim model without joints of a known kind")
    mass = sum(number_of(path, body.findtext("mass") or "0") for body in model.iter("Body"))
    return OsimModel(path, model.get("name", ""), joints, defaults, mass)


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
    swapped = (element.findtext("reverse") or "").strip() == "true"
    return (element.tag in _MOTIONS_OF_KIND or element.tag == "CustomJoint") and not swapped


def _joint(path: Path, element: Element, child: str, coordinates: list[str]) -> Joint:
    name = element.get("name", element.tag)
    if child:
        parent = (element.findtext("parent_body") or "").strip()
        frames = [
            offset(vector_of(path, element, f"location{end}"), vector_of(path, element, f"orientation{end}"))
            for end in ("_in_parent", "")
        ]
    else:
        (parent, first), (child, second) = (_frame(path, element, end) for end in ("parent", "child"))
        frames = [first, second]
    if element.tag == "CustomJoint":
        axes = [axis_of(path, axis) for axis in element.findall("SpatialTransform/TransformAxis")]
        rotations = tuple(axis for axis, rotates in axes if rotates)
        translations = tuple(axis for axis, rotates in axes if not rotates)
    else:
        rotations, translations = _fixed(path, element, name, coordinates)
    return Joint(name, parent, child, frames[0], frames[1], rotations, translations)


def _fixed(path: Path, element: Element, name: str, coordinates: list[str]) -> tuple[tuple[Axis, ...], ...]:
    """Rotations and translations of a joint whose kind decides the motions of its coordinates."""
    kinds = _MOTIONS_OF_KIND[element.tag]
    if len(coordinates) != len(kinds):
        why = f"joint {name[:60]!r} has {len(coordinates)} coordinates; a {element.tag} has {len(kinds)}"
        raise FormatError(path, why)
    both = list(zip(kinds, coordinates, strict=True))
    return tuple(tuple(Axis(_AXES[kind[1]], c) for kind, c in both if kind[0] == what) for what in "rt")


def _frame(path: Path, element: Element, end: str) -> tuple[str, Array]:
    """The body that a joint's socket leads to, and the joint's frame in it."""
    socket = (element.findtext(f"socket_{end}_frame") or "").strip().rpartition("/")[2]
    for frame in element.findall("frames/PhysicalOffsetFrame"):
        if frame.get("name") == socket:
            body = (frame.findtext("socket_parent") or "").strip().rpartition("/")[2]
            return body, offset(vector_of(path, frame, "translation"), vector_of(path, frame, "orientation"))
    return socket, np.eye(4)

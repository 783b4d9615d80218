"""Joints of an .osim file: the pelvis in the ground, hinges and slides, welds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from exo_pin.arrays import Array
from exo_pin.export.osim_elements import add_pose_frame, add_text, triple
from exo_pin.formats.opensim.pelvis_axes import (
    FROM_OPENSIM,
    PELVIS_ROTATIONS,
    PELVIS_TRANSLATIONS,
    body_fixed_xyz,
)
from exo_pin.robot import urdf_elements

_STILL = np.zeros(3)
_ROTATIONS = ("rotation1", "rotation2", "rotation3")
_TRANSLATIONS = ("translation1", "translation2", "translation3")
_ANGLE_RANGE = "-3.15 3.15"
_WAY_RANGE = "-1000 1000"


def add_pelvis(objects: Element, root: str) -> None:
    """The root link in the ground, by the six pelvis coordinates of OpenSim's models.

    Args:
        objects: The joints.
        root: The link that hangs on no joint.
    """
    joint, rows = _custom(objects, "ground_pelvis", ("/ground", _STILL, _STILL), f"/bodyset/{root}")
    coordinates = _coordinates(joint)
    for way, axis in zip(_ROTATIONS, PELVIS_ROTATIONS.values(), strict=True):
        _add_coordinate(coordinates, axis.coordinate, _ANGLE_RANGE)
        rows[way] = (axis.vector, axis.coordinate, 1)
    for way, name, axis_ in zip(_TRANSLATIONS, PELVIS_TRANSLATIONS, np.eye(3), strict=True):
        _add_coordinate(coordinates, name, _WAY_RANGE)
        rows[way] = (axis_, name, 1)
    _add_transform(joint, rows)


def add_fixed(objects: Element, joint: Element, moved: Array) -> None:
    """A URDF's fixed joint as a weld.

    Args:
        objects: The joints.
        joint: Of the URDF.
        moved: `(3,)` where the parent link's URDF origin lies in its body, OpenSim axes [m].
    """
    weld = SubElement(objects, "WeldJoint", name=str(joint.get("name")))
    _add_frames(weld, _place(joint, moved), _child(joint))


def add_moving(objects: Element, joint: Element, moved: Array, coordinate: str, sign: int) -> None:
    """A URDF's hinge or slide with one coordinate.

    Args:
        objects: The joints.
        joint: Of the URDF.
        moved: As in `add_fixed`.
        coordinate: Its name in OpenSim.
        sign: Of the coordinate against the joint's.
    """
    custom, rows = _custom(objects, str(joint.get("name")), _place(joint, moved), _child(joint))
    axis = FROM_OPENSIM.T @ _axis(joint)
    limits = sorted(sign * x for x in urdf_elements.limits(joint) or (-np.pi, np.pi))
    _add_coordinate(_coordinates(custom), coordinate, " ".join(map(repr, limits)), clamped=True)
    slides = joint.get("type") == "prismatic"
    ways = _TRANSLATIONS if slides else _ROTATIONS
    for way, direction in zip(ways, _three(axis), strict=True):
        rows[way] = (direction, coordinate if way == ways[0] else "", sign)
    _add_transform(custom, rows)


_Rows = dict[str, tuple[Sequence[float] | Array, str, int]]
_Place = tuple[str, Array, Array]


def _custom(objects: Element, name: str, parent: _Place, child: str) -> tuple[Element, _Rows]:
    """A joint without motion, and its six directions."""
    joint = SubElement(objects, "CustomJoint", name=name)
    _add_frames(joint, parent, child)
    rows: _Rows = {
        way: (axis, "", 1)
        for ways in (_ROTATIONS, _TRANSLATIONS)
        for way, axis in zip(ways, np.eye(3), strict=True)
    }
    return joint, rows


def _add_frames(joint: Element, parent: _Place, child: str) -> None:
    """The joint's two ends: the place in the parent's body, the child's own origin."""
    link, place, angles = parent
    ends = (f"{link.rpartition('/')[2]}_offset", f"{child.rpartition('/')[2]}_offset")
    for which, name in zip(("parent", "child"), ends, strict=True):
        add_text(joint, f"socket_{which}_frame", name)
    frames = SubElement(joint, "frames")
    add_pose_frame(frames, ends[0], link, place, angles)
    add_pose_frame(frames, ends[1], child, _STILL, _STILL)


def _coordinates(joint: Element) -> Element:
    return SubElement(joint, "coordinates")


def _add_coordinate(coordinates: Element, name: str, limits: str, *, clamped: bool = False) -> None:
    entry = SubElement(coordinates, "Coordinate", name=name)
    add_text(entry, "default_value", "0")
    add_text(entry, "range", limits)
    add_text(entry, "clamped", str(clamped).lower())


def _add_transform(joint: Element, rows: Mapping[str, tuple[Sequence[float] | Array, str, int]]) -> None:
    """OpenSim's six axes, each moved by a coordinate or by none."""
    transform = SubElement(joint, "SpatialTransform")
    for way, (axis, coordinate, sign) in rows.items():
        entry = SubElement(transform, "TransformAxis", name=way)
        add_text(entry, "coordinates", coordinate)
        add_text(entry, "axis", triple(axis))
        if coordinate:
            function = SubElement(entry, "LinearFunction", name="function")
            add_text(function, "coefficients", f"{sign} 0")
        else:
            add_text(SubElement(entry, "Constant", name="function"), "value", "0")


def _place(joint: Element, moved: Array) -> _Place:
    """Parent body, place and attitude of a URDF's joint in it, OpenSim axes."""
    T = urdf_elements.pose(joint.find("origin"))
    R = FROM_OPENSIM.T @ T[:3, :3] @ FROM_OPENSIM
    link = urdf_elements.end(joint, "parent")
    return f"/bodyset/{link}", FROM_OPENSIM.T @ T[:3, 3] + moved, body_fixed_xyz(R)


def _child(joint: Element) -> str:
    return f"/bodyset/{urdf_elements.end(joint, 'child')}"


def _axis(joint: Element) -> Array:
    """Unit vector (3,) of the URDF's axis."""
    found = joint.find("axis")
    axis = np.array(urdf_elements.numbers("1 0 0" if found is None else found.get("xyz", "1 0 0")))
    return np.asarray(axis / np.linalg.norm(axis))


def _three(axis: Array) -> Array:
    """The axis and two across it (3, 3): OpenSim accepts no three axes in one plane."""
    aside = np.eye(3)[np.argmin(np.abs(axis))]
    second = np.cross(axis, aside)
    second /= np.linalg.norm(second)
    return np.array([axis, second, np.cross(axis, second)])

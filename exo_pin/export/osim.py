"""The exoskeleton as an OpenSim model (.osim): bodies, joints, coordinates, motors, shapes."""

from __future__ import annotations

from typing import Literal, get_args
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from exo_pin import arguments
from exo_pin.arrays import Array
from exo_pin.dynamics import floating_robot
from exo_pin.export.osim_elements import add_text, triple
from exo_pin.export.osim_joints import add_fixed, add_moving, add_pelvis
from exo_pin.export.osim_shapes import add_shapes
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, KNEES
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM
from exo_pin.formats.sign_presets import PRESETS, Preset
from exo_pin.physics import GRAVITY
from exo_pin.robot import Robot, urdf_elements, urdf_tree

OsimPreset = Literal["opensim-gait2392", "opensim-rajagopal"]

_VERSION = "40000"
"""Of the file format: every OpenSim 4 reads it."""


def osim(robot: Robot, *, preset: OsimPreset = "opensim-rajagopal") -> str:
    """The exoskeleton as an OpenSim model: the URDF's links, joints, masses, limits and plain shapes.

    Coordinates of the walker's joints are named and signed as those of gait2392 and its descendants, so that
    a `.mot` of this package plays on the model; a joint that is no walker's keeps its own name. The pelvis
    moves freely, whatever holds it. Its origin lies where the preset's models have it, away from the mid-hip.

    Args:
        robot: Its links and joints are those of its URDF.
        preset: The model family whose knee sign and pelvis are used, as of the `.mot` files to be played.

    Raises:
        UnknownNameError: There is no such preset.
    """
    family = PRESETS[arguments.word("preset", preset, get_args(OsimPreset))]
    robot = floating_robot(robot, robot.masses)
    urdf = urdf_tree.parsed(robot.urdf)
    document = Element("OpenSimDocument", Version=_VERSION)
    model = SubElement(document, "Model", name=robot.name)
    SubElement(model, "Ground", name="ground")
    add_text(model, "gravity", f"0 {-GRAVITY!r} 0")
    add_text(model, "credits", f"exo_pin, signs of {family.name}")
    add_text(model, "length_units", "meters")
    add_text(model, "force_units", "N")
    origin = _root_origin(family)
    root = _root(urdf)
    _add_bodies(model, urdf, {root: origin})
    _add_joints(model, urdf, root, origin, family)
    _add_motors(model, robot)
    indent(document)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(document, encoding="unicode") + "\n"


def coordinate(joint: str) -> str:
    """The OpenSim coordinate of a joint: gait2392's name of a walker's joint, its own name of another."""
    return COORDINATE_OF.get(joint, joint)


def sign(joint: str, preset: Preset) -> int:
    """+1 where the coordinate is positive as the joint is, -1 for knees positive in extension."""
    return preset.knee if coordinate(joint) in KNEES else 1


def _root_origin(preset: Preset) -> Array:
    """Where our pelvis's origin, the mid-hip, lies in OpenSim's pelvis (3,), OpenSim axes [m]."""
    return np.array(preset.mid_hip or (0.0, 0.0, 0.0))


def _root(urdf: Element) -> str:
    """The link that hangs on no joint."""
    children = {urdf_elements.end(joint, "child") for joint in urdf.findall("joint")}
    return next(str(link.get("name")) for link in urdf.findall("link") if link.get("name") not in children)


def _add_bodies(model: Element, urdf: Element, origins: dict[str, Array]) -> None:
    """Mass, centre, inertia and plain shapes of every link; `origins`: of links whose origin is moved."""
    objects = SubElement(SubElement(model, "BodySet", name="bodyset"), "objects")
    for link in urdf.findall("link"):
        name = str(link.get("name"))
        body, moved = SubElement(objects, "Body", name=name), origins.get(name, np.zeros(3))
        add_shapes(body, link, moved)
        inertial = link.find("inertial")
        mass = 0.0 if inertial is None else float(_attribute(inertial, "mass", "value"))
        centre, inertia = (np.zeros(3), np.zeros((3, 3))) if inertial is None else _inertia(inertial)
        add_text(body, "mass", repr(mass))
        add_text(body, "mass_center", triple(FROM_OPENSIM.T @ centre + moved))
        six = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        add_text(body, "inertia", " ".join(repr(float(x)) for x in six))


def _inertia(inertial: Element) -> tuple[Array, Array]:
    """Centre in the link's frame, inertia about it in OpenSim's axes."""
    T = urdf_elements.pose(inertial.find("origin"))
    xx, xy, xz, yy, yz, zz = (
        float(_attribute(inertial, "inertia", name)) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    )
    turn = FROM_OPENSIM.T @ T[:3, :3]
    own = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return T[:3, 3], turn @ own @ turn.T


def _attribute(inertial: Element, tag: str, name: str) -> str:
    found = inertial.find(tag)
    return "0" if found is None else found.get(name, "0")


def _add_joints(model: Element, urdf: Element, root: str, origin: Array, preset: Preset) -> None:
    """The pelvis's six coordinates, then the URDF's joints."""
    objects = SubElement(SubElement(model, "JointSet", name="jointset"), "objects")
    add_pelvis(objects, root)
    for joint in urdf.findall("joint"):
        parent = urdf_elements.end(joint, "parent")
        moved = origin if parent == root else np.zeros(3)
        if joint.get("type") == "fixed":
            add_fixed(objects, joint, moved)
        else:
            name = str(joint.get("name"))
            add_moving(objects, joint, moved, coordinate(name), sign(name, preset))


def _add_motors(model: Element, robot: Robot) -> None:
    """A torque for each driven joint, whose control of 1 is the motor's largest."""
    objects = SubElement(SubElement(model, "ForceSet", name="forceset"), "objects")
    for name, effort in zip(robot.joints, robot.effort.tolist(), strict=True):
        if effort > 0.0:
            motor = SubElement(objects, "CoordinateActuator", name=f"{name}_motor")
            add_text(motor, "min_control", "-1")
            add_text(motor, "max_control", "1")
            add_text(motor, "coordinate", coordinate(name))
            add_text(motor, "optimal_force", repr(effort))

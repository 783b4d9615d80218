"""Loading a `Robot`: from a body and a device, or from any URDF."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, get_args

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin import description, devices, xacro_files
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import HIP_ORDERS, Base, HipOrder, Masses
from exo_pin.arguments import real, word
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError, FormatError
from exo_pin.files import read_text
from exo_pin.robot import urdf_joints, urdf_parser
from exo_pin.robot.model import Robot


def load_robot(
    body: Body | None = None,
    *,
    device: str | devices.Device = "exo12",
    hip_order: HipOrder = "clinical",
    base: Base = "fixed",
    masses: Masses = "both",
) -> Robot:
    """The exoskeleton for a body.

    Args:
        body: Sizes and masses; `Body.from_stature()` if left out.
        device: One of `exo_pin.devices.DEVICES` by name, a TOML file that holds a device, or a record. Its
            locked joints are fixed at zero; they are frames, not joints, of the robot.
        hip_order: `"clinical"` or `"yaw_roll_pitch"`.
        base: `"fixed"`: the pelvis is held as in the paper (or slides on a stand, if the device has slides);
            `"floating"`: it has six degrees of freedom, and the device's slides are left out.
        masses: Whose masses the links have: `"wearer"`, `"device"` or `"both"`.

    Raises:
        UnknownNameError: Device, hip order, base or masses are unknown.
        DescriptionError: The wearer's masses of a body that is a bare device's.
        FormatError: The device's file is not accepted.
    """
    word("base", base, get_args(Base))
    body = Body.from_stature() if body is None else body
    found = devices.find(device)
    if base == "floating":
        found = found.carried()
    text = description.urdf(body, device=found, hip_order=hip_order, masses=masses)
    placement = np.eye(4)
    placement[2, 3] = body.leg_length
    robot = _built(text, base, placement, hip_order)  # our own text: it needs no judgement as a stranger's
    return dataclasses.replace(robot, body=body, device=found, masses=masses)


def load_urdf(
    source: str | Path,
    *,
    base: Base = "fixed",
    placement: npt.ArrayLike | None = None,
    hip_order: HipOrder = "clinical",
    path: str | Path | None = None,
) -> Robot:
    """A robot from any URDF.

    Joints without end stops get half a turn each way, floating and planar joints are held: `Robot.remarks`
    says so.

    Args:
        source: Path of a URDF or xacro file, or a URDF's text.
        base: `"fixed"` or `"floating"`.
        placement: Pose of the root link in the world (4, 4); the identity if left out.
        hip_order: Order of its hip joints, should it have the joints of `JOINTS`.
        path: File that a text comes from, beside which the viewer finds its meshes.

    Raises:
        DescriptionError: The file cannot be read or is no URDF that Pinocchio accepts, or the limits of a
            joint or the placement are wrong.
        UnknownNameError: Base or hip order is unknown.
    """
    word("base", base, get_args(Base))
    word("hip order", hip_order, HIP_ORDERS)
    stand = np.eye(4) if placement is None else real("placement", placement, (4, 4)).copy()
    text = _text(source)
    if path is None and text is not source:
        path = source
    text, remarks = _accepted(text, path)
    return dataclasses.replace(_built(text, base, stand, hip_order, path), remarks=remarks)


def _built(text: str, base: Base, stand: Array, hip_order: HipOrder, path: str | Path | None = None) -> Robot:
    """The robot of a URDF's text that is accepted; errors name the file."""
    try:
        model = urdf_parser.built(text, *((pin.JointModelFreeFlyer(),) if base == "floating" else ()))
    except DescriptionError as error:
        raise DescriptionError(f"{path or 'URDF'}: {error}") from None
    names = tuple(model.names)[2 if base == "floating" else 1 :]
    for name in names:
        if model.joints[model.getJointId(name)].nq != 1:
            raise DescriptionError(f"joint {name!r} is not revolute or prismatic")
    if base == "fixed":
        _place(model, pin.SE3(stand))
    k = len(names)
    return Robot(
        model=model,
        urdf=text,
        joints=names,
        lower=_frozen(model.lowerPositionLimit[-k:]),
        upper=_frozen(model.upperPositionLimit[-k:]),
        velocity=_frozen(model.velocityLimit[-k:]),
        effort=_frozen(model.effortLimit[-k:]),
        placement=_frozen(stand),
        base=base,
        hip_order=hip_order,
        path=None if path is None else Path(path).absolute(),
    )


def _text(source: str | Path) -> str:
    if isinstance(source, str) and "<" in source:
        return source
    if Path(source).suffix.lower() == ".xacro":
        return xacro_files.expanded(Path(source))
    try:
        return read_text(source)
    except FormatError as error:
        raise DescriptionError(f"{error}") from None


def _accepted(text: str, path: str | Path | None) -> urdf_joints.Accepted:
    """A URDF's text as it is accepted; errors name the file."""
    try:
        return urdf_joints.accepted(text)
    except DescriptionError as error:
        raise DescriptionError(f"{path or 'URDF'}: {error}") from None


def _place(model: Any, placement: Any) -> None:
    """Place the root link in the world W: move every joint and frame that the world carries."""
    for j in range(1, model.njoints):
        if model.parents[j] == 0:
            model.jointPlacements[j] = placement * model.jointPlacements[j]
    for k in range(1, model.nframes):  # by index: slices of Pinocchio's vectors are copies
        if model.frames[k].parentJoint == 0:
            model.frames[k].placement = placement * model.frames[k].placement
    model.inertias[0] = placement.act(model.inertias[0])


def _frozen(values: npt.ArrayLike) -> Array:
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array

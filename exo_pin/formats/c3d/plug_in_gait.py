"""Plug-in Gait's model outputs: joint angles and pelvis frame as a walk, joint moments as torques."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES, joint
from exo_pin.anatomy.names import Movement, SignPreset
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.c3d.content import C3dContent
from exo_pin.formats.c3d.subject_parameters import stated_person
from exo_pin.formats.sign_presets import PRESETS
from exo_pin.formats.tables.metadata import Metadata, to_gait
from exo_pin.formats.tables.torque_table import to_torques
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import nearest_pose
from exo_pin.gait.torques import Torques
from exo_pin.gait.trial import Markers, to_z_up, vertical_along
from exo_pin.signals import longest_run

PLUG_IN_GAIT = PRESETS["vicon-pig"]

PELVIS_FRAME = ("PELO", "PELA", "PELL", "PELP")
"""Virtual points of the pelvis: its origin midway between the hip centres, and a point on each axis."""

_MOMENTS: dict[Movement, tuple[str, int]] = {
    "hip_flexion": ("HipMoment", 0),
    "hip_adduction": ("HipMoment", 1),
    "hip_rotation": ("HipMoment", 2),
    "knee_flexion": ("KneeMoment", 0),
    "ankle_dorsiflexion": ("AnkleMoment", 0),
}
"""Movement -> output and which of its three components, N mm per kg of the person, all against the signs of
this package: extensors, abductors, external rotators and plantarflexors are positive, as the powers of a
recording show."""

_PER_KILOGRAM = 1e-3
"""N mm/kg -> N m/kg."""


def has_model_angles(trial: Markers) -> bool:
    """Whether the trial has all of Plug-in Gait's leg angles."""
    return all(angle_of(column)[0] in trial.angles for column in PLUG_IN_GAIT.mapping)


def model_angles(path: Path, trial: Markers) -> Gait:
    """The walk by the trial's own model angles; the pelvis frame, if there, becomes the base.

    The longest run of frames with all angles is taken, and the source names it where it is not the file.

    Raises:
        FormatError: There are no such angles; the markers may still do.
    """
    if not has_model_angles(trial):
        absent = sorted({angle_of(column)[0] for column in PLUG_IN_GAIT.mapping} - set(trial.angles))
        raise FormatError(path, f"no model angles {', '.join(absent)}; its markers need inverse kinematics")
    columns = {ours: angle_of(column) for column, ours in PLUG_IN_GAIT.mapping.items()}
    q = np.column_stack([_channel(trial, *columns[ours]) for ours in JOINTS])
    start, stop = longest_run((np.isfinite(q) & (q != 0)).any(axis=1) & np.isfinite(q).all(axis=1))
    if stop - start < 2:
        raise FormatError(path, "the model angles are empty")
    time, source = trial.time[start:stop], f"{path.name}, Plug-in Gait model angles"
    if stop - start < len(trial):
        source += f", frames {start} to {stop - 1} of {len(trial)}"
    events = tuple(event for event in trial.events if time[0] <= event.time <= time[-1])
    base, remarks = _pelvis(trial, start, stop), trial.remarks
    if len(events) < len(trial.events):
        left = len(trial.events) - len(events)
        remarks += (f"{left} of {len(trial.events)} events lie in frames without angles and are left out",)
    return to_gait(path, time, q[start:stop], base, Metadata(events, source=source, remarks=remarks))


def joint_moments(path: Path, content: C3dContent, preset: SignPreset | None, mass: float | None) -> Torques:
    """Torques by the moments of hip, knee and ankle; Plug-in Gait has no moment of ankle inversion.

    Args:
        path: The file, for messages.
        content: Its content.
        preset: None or `vicon-pig`.
        mass: Of the person [kg]; None: as the file has it.

    Raises:
        FormatError: There are no moments, nothing states the mass, or another preset is given.
    """
    if preset not in (None, PLUG_IN_GAIT.name):
        why = f"preset {preset!r} is not for this kind of file: its moments are {PLUG_IN_GAIT.name}'s"
        raise FormatError(path, why)
    outputs = [f"{side[0].upper()}{output}" for side in SIDES for output, _ in _MOMENTS.values()]
    if not set(outputs) & set(content.columns):
        why = f"no joint moments; expected Plug-in Gait's outputs {', '.join(outputs[::4])} ..."
        raise FormatError(path, why)
    weight = stated_person(content.parameters).mass if mass is None else mass
    if weight is None:
        raise FormatError(path, "its moments are per kg, and neither the file nor an option states the mass")
    tau = np.full((len(content.time), len(JOINTS)), np.nan)
    for side in SIDES:
        for movement, (output, axis) in _MOMENTS.items():
            name = f"{side[0].upper()}{output}"
            if name in content.columns:
                values = content.output(name)[:, axis]
                tau[:, JOINTS.index(joint(side, movement))] = -_PER_KILOGRAM * weight * values
    return to_torques(path, content.time, tau, f"{path.name}, Plug-in Gait moments times {weight:g} kg")


def angle_of(column: str) -> tuple[str, int, int]:
    """`-LAnkleAngles_Y` -> name of the angle, which of its three components, and the sign."""
    name, _, axis = column.lstrip("-").rpartition("_")
    return name, "XYZ".index(axis), -1 if column.startswith("-") else 1


def _channel(trial: Markers, name: str, k: int, sign: int) -> Array:
    return np.asarray(sign * trial.angles[name][:, k])


def _pelvis(trial: Markers, start: int, stop: int) -> Array | None:
    """T_world_pelvis of these frames; None where the pelvis frame or the vertical is not known."""
    if not set(PELVIS_FRAME) <= set(trial.names):
        return None
    origin, *ends = (trial.of(name)[start:stop] for name in PELVIS_FRAME)
    axes = np.stack([end - origin for end in ends], axis=2)
    up = trial.up or vertical_along(axes[:, :, 2].mean(axis=0))
    if not up or not np.isfinite(axes).all():
        return None
    T = np.tile(np.eye(4), (len(axes), 1, 1))
    R = to_z_up(up)
    T[:, :3, 3] = origin @ R.T
    T[:, :3, :3] = R @ axes / np.maximum(np.linalg.norm(axes, axis=1, keepdims=True), 1e-12)
    return nearest_pose(T)

"""Joint torques of OpenSim's inverse dynamics: the generalised forces of its coordinates."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import SignPreset
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, KNEES
from exo_pin.formats.opensim.storage import Storage, write_storage
from exo_pin.formats.sign_presets import OPENSIM_PRESETS, Preset, find_preset
from exo_pin.formats.tables.metadata import Metadata, comment_lines, read_metadata
from exo_pin.formats.tables.torque_table import to_torques, torque_columns
from exo_pin.gait.torques import Torques

_ENDING = "_moment"
"""Of a column: `knee_angle_l_moment`, where the coordinate is an angle."""


def inverse_dynamics(storage: Storage, name: SignPreset | None) -> Torques:
    """The torques of columns `<coordinate>_moment` [N m].

    A generalised force is positive along its coordinate, so only the sign of the knee depends on the model.
    NaN is a torque that is not known.

    Args:
        storage: The file.
        name: The preset of the model; None: as our own header line says, OpenSim's do not.

    Raises:
        FormatError: There are no moments, or nothing tells the sign of the knee.
        UnknownNameError: There is no such preset.
    """
    table = storage.table
    path, line = table.path, table.lines[0] - 1
    columns = {joint: f"{coordinate}{_ENDING}" for joint, coordinate in COORDINATE_OF.items()}
    present = {joint: column for joint, column in columns.items() if column in table.names}
    if "time" not in table.names or not present:
        example = columns["left_knee_flexion"]
        raise FormatError(path, f"no joint moments; expected time and columns like {example}", line=line)
    name = name or _stated_preset(storage)
    knees = sorted(joint for joint, coordinate in COORDINATE_OF.items() if coordinate in KNEES)
    if name is None and set(knees) & set(present):
        why = "inverse dynamics do not tell the sign of the model's knee; name the model with a preset: "
        raise FormatError(path, why + ", ".join(OPENSIM_PRESETS))
    used = list(present.values())
    table.refuse_repeated(["time", *used])
    table, doubled = table.once_each_time("time", used)
    tau = torque_columns(table, present)
    tau[:, [JOINTS.index(joint) for joint in knees]] *= (
        1 if name is None else find_preset(name, OPENSIM_PRESETS).knee
    )
    model = "" if name is None else f" of {name}"
    stated = read_metadata(path, storage.comments).source
    source = stated or f"{path.name}, OpenSim inverse dynamics{model}"
    torques = to_torques(path, table.times("time"), tau, source)
    return replace(torques, remarks=(*storage.remarks, *doubled, *torques.remarks))


def _stated_preset(storage: Storage) -> SignPreset | None:
    """The preset in the header of a file that `write_torques` wrote."""
    stated = [comment.value for comment in storage.comments if comment.key == "preset"]
    return next((name for name in OPENSIM_PRESETS if name in stated), None)


def write_torques(torques: Torques, path: Path, *, preset: Preset) -> None:
    """Write the moments of a model's coordinates, as OpenSim's inverse dynamics does.

    Args:
        torques: The torques; NaN is written where one is not known.
        path: The file, .sto or .mot.
        preset: The model family it is for; decides the sign of the knee.

    Raises:
        FormatError: The file cannot be written.
    """
    known = [JOINTS.index(joint) for joint in torques.joints]
    coordinates = [COORDINATE_OF[joint] for joint in torques.joints]
    signs = [preset.knee if name in KNEES else 1 for name in coordinates]
    sign = "positive" if preset.knee > 0 else "negative"
    remarks = [
        f"Written by exo_pin: moments in N m; knee_angle is {sign} in flexion; NaN where not known.",
        f"# preset: {preset.name}",
        *comment_lines(Metadata(source=torques.source)),
    ]
    names = ["time", *(f"{name}{_ENDING}" for name in coordinates)]
    values = np.column_stack([torques.time, torques.tau[:, known] * signs])
    write_storage(path, "Inverse Dynamics Generalized Forces", remarks, names, values, degrees=False)

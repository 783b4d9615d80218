"""Joint torques of OpenSim's inverse dynamics: the generalised forces of its coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import SignPreset
from exo_pin.errors import FormatError
from exo_pin.formats.opensim.coordinate_names import COORDINATE_OF, KNEES
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.sign_presets import OPENSIM_PRESETS, find_preset
from exo_pin.formats.tables.torque_table import to_torques, torque_columns
from exo_pin.gait.torques import Torques

_ENDING = "_moment"
"""Of a column: `knee_angle_l_moment`, where the coordinate is an angle."""


def inverse_dynamics(storage: Storage, name: SignPreset | None) -> Torques:
    """The torques of columns `<coordinate>_moment` [N m].

    A generalised force is positive along its coordinate, so only the sign of the knee depends on the model.

    Args:
        storage: A file without gaps in these columns.
        name: The preset of the model; the file does not name it.

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
    knees = sorted(joint for joint, coordinate in COORDINATE_OF.items() if coordinate in KNEES)
    if name is None and set(knees) & set(present):
        why = "inverse dynamics do not tell the sign of the model's knee; name the model with a preset: "
        raise FormatError(path, why + ", ".join(OPENSIM_PRESETS))
    used = list(present.values())
    table.refuse_repeated(["time", *used])
    table.refuse(~np.isfinite(table.columns(used)), used, "expected a finite number")
    table, doubled = table.once_each_time("time", used)
    tau = torque_columns(table, present)
    tau[:, [JOINTS.index(joint) for joint in knees]] *= (
        1 if name is None else find_preset(name, OPENSIM_PRESETS).knee
    )
    model = "" if name is None else f" of {name}"
    torques = to_torques(path, table.times("time"), tau, f"{path.name}, OpenSim inverse dynamics{model}")
    return replace(torques, remarks=(*storage.remarks, *doubled))

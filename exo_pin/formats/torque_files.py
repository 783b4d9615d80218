"""Files of joint torques: OpenSim's inverse dynamics, Plug-in Gait's moments, tables of our own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError
from exo_pin.formats.c3d import reader
from exo_pin.formats.opensim.coordinates import KNEES, LEGS
from exo_pin.formats.opensim.storage import read_storage
from exo_pin.formats.presets import OPENSIM, preset
from exo_pin.formats.tables.csv_table import read_csv
from exo_pin.formats.tables.notes import read
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.gait.torques import Torques

UNIT = "_torque_nm"
"""Our columns: `left_knee_flexion_torque_nm`."""

ENDING = "_moment"
"""OpenSim's: a coordinate's generalised force, `knee_angle_l_moment`, where the coordinate is an angle."""


MOMENTS = {
    "hip_flexion": ("HipMoment", 0),
    "hip_adduction": ("HipMoment", 1),
    "hip_rotation": ("HipMoment", 2),
    "knee_flexion": ("KneeMoment", 0),
    "ankle_dorsiflexion": ("AnkleMoment", 0),
}
"""Movement -> Plug-in Gait's output and which of its three, N mm per kg of the person, all against our signs:
extensors, abductors, external rotators and plantarflexors are positive. So say the powers of a recording."""

PER_KILOGRAM = 1e-3
"""N mm/kg -> N m/kg."""


def load_torques(path: str | Path, *, preset: str | None = None, mass: float | None = None) -> Torques:
    """Read joint torques; the signs become ours: positive drives the joint the way its name says.

    - `.sto`, `.mot`: OpenSim's inverse dynamics, columns `<coordinate>_moment` [N m]. A generalised force is
      positive along its coordinate, so only a knee that is negative in flexion is turned; the file does not
      say which model it is of, so a preset must.
    - `.c3d`: Plug-in Gait's moments of hip, knee and ankle (no inversion) [N mm/kg], times the person's mass.
    - `.csv`: a column `time_s` and columns `<joint>_torque_nm` [N m], as many joints as are known.

    Args:
        path: The file.
        preset: The OpenSim model's sign convention, e.g. `"opensim-gait2392"`.
        mass: Of the person [kg], for moments per kg; None: what the file says.

    Raises:
        FormatError: The file cannot be read; with file, line, reason and what would be accepted.
        UnknownNameError: There is no such preset.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in READERS:
        raise FormatError(path, f"unknown kind of file {path.suffix!r}; torques end in {', '.join(READERS)}")
    return READERS[kind](path, preset, mass)


def _read_opensim(path: Path, name: str | None, _mass: float | None) -> Torques:
    table = read_storage(path).table
    line = table.lines[0] - 1
    columns = {joint: f"{coordinate}{ENDING}" for joint, coordinate in zip(JOINTS, LEGS, strict=True)}
    here = {joint: column for joint, column in columns.items() if column in table.names}
    if "time" not in table.names or not here:
        raise FormatError(
            path,
            f"no joint moments; expected time and columns like {columns['left_knee_flexion']}",
            line=line,
        )
    knees = {joint for joint, coordinate in zip(JOINTS, LEGS, strict=True) if coordinate in KNEES}
    if name is None and knees & set(here):
        raise FormatError(
            path,
            "inverse dynamics do not tell the sign of the model's knee; name the model with a preset: "
            + ", ".join(OPENSIM),
        )
    knee = 1 if name is None else preset(name, OPENSIM).knee
    tau = _filled(table, here)
    tau[:, [JOINTS.index(joint) for joint in sorted(knees)]] *= knee
    how = "" if name is None else f" of {name}"
    return _torques(path, table.times("time"), tau, f"{path.name}, OpenSim inverse dynamics{how}")


def _read_c3d(path: Path, name: str | None, mass: float | None) -> Torques:
    if name not in (None, "vicon-pig"):
        raise FormatError(path, f"preset {name!r} is not for this kind of file: its moments are vicon-pig's")
    outputs = [f"{side[0].upper()}{output}" for side in SIDES for output, _ in MOMENTS.values()]
    time, found, told = reader.read_outputs(path, tuple(dict.fromkeys(outputs)))
    if not found:
        raise FormatError(
            path, f"no joint moments; expected Plug-in Gait's outputs {', '.join(outputs[::4])} ..."
        )
    weight = told if mass is None else mass
    if weight is None:
        raise FormatError(path, "its moments are per kg, and neither the file nor anybody else says the mass")
    tau = np.full((len(time), len(JOINTS)), np.nan)
    for side in SIDES:
        for movement, (output, axis) in MOMENTS.items():
            rows = found.get(f"{side[0].upper()}{output}")
            if rows is not None:
                tau[:, JOINTS.index(f"{side}_{movement}")] = -PER_KILOGRAM * weight * rows[:, axis]
    return _torques(path, time, tau, f"{path.name}, Plug-in Gait moments times {weight:g} kg")


def _read_csv(path: Path, name: str | None, _mass: float | None) -> Torques:
    if name not in (None, "exo_pin"):
        raise FormatError(path, f"preset {name!r} is not for this kind of file: its columns tell the signs")
    columns = {joint: f"{joint}{UNIT}" for joint in JOINTS}
    table, groups, comments = read_csv(path, ("time_s",), {column: [column] for column in columns.values()})
    if not groups:
        raise FormatError(path, f"no torques; expected columns like {columns['left_knee_flexion']}")
    here = {joint: column for joint, column in columns.items() if column in groups}
    said = read(path, comments).source
    return _torques(path, table.times("time_s"), _filled(table, here), said or path.name)


def _filled(table: NumericTable, columns: dict[str, str]) -> Array:
    """The table's columns in the order of `JOINTS`, NaN where there is none."""
    tau = np.full((len(table.values), len(JOINTS)), np.nan)
    tau[:, [JOINTS.index(joint) for joint in columns]] = table.columns(columns.values())
    return tau


def _torques(path: Path, time: Array, tau: Array, source: str) -> Torques:
    try:
        return Torques(time, tau, source=source)
    except GaitError as error:
        raise FormatError(path, str(error)) from error


READERS: dict[str, Callable[[Path, str | None, float | None], Torques]] = {
    ".sto": _read_opensim,
    ".mot": _read_opensim,
    ".c3d": _read_c3d,
    ".csv": _read_csv,
}
"""File name ending -> reader."""

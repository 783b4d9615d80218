"""Reading and writing walks, marker trials, joint torques and force plates of any format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TypeVar

from exo_pin.anatomy.names import AngleUnit, PelvisRotation, SignPreset
from exo_pin.arguments import names, number, several, table, text
from exo_pin.errors import FormatError
from exo_pin.formats.opensim import StorageFile, write_gait, write_torques
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.registry import FORMATS, MARKER_FORMATS, Content, find_format, open_trial, written_format
from exo_pin.formats.sign_presets import OPENSIM_PRESETS, find_preset
from exo_pin.formats.tables import TABLE_SUFFIXES, write_csv_torques
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Gait
from exo_pin.gait.even_clock import even_clock, evened_remark, within
from exo_pin.gait.sampling import doubtful_unit, missing_samples
from exo_pin.gait.torques import Torques
from exo_pin.gait.trial import ForcePlate, Markers

TORQUE_SUFFIXES = (".csv", ".sto", ".mot")
"""Endings of files of joint torques that are written."""

_Record = TypeVar("_Record", Gait, Markers)


def load_gait(
    path: str | Path | TrialFile,
    *,
    preset: SignPreset | None = None,
    mapping: Mapping[str, str] = MappingProxyType({}),
    units: AngleUnit | None = None,
    model: str | Path | None = None,
    pelvis_order: Sequence[PelvisRotation] | None = None,
    columns: Sequence[str] = (),
    row_rate: float | None = None,
) -> Gait:
    """Read a walk from a file with joint angles.

    Time stamps that the file rounded are put back on their even grid; `remarks` states it.

    Args:
        path: A file in one of `FORMATS`, at most 128 MiB, or one that `open_trial` has read.
        preset: The sign convention, one of `PRESETS`; None: find out or refuse.
        mapping: The file's column -> joint (or `time`), for tables and trajectories with names of their own.
            `-column` changes the sign, a number instead of a column holds the joint there.
        units: `"deg"` or `"rad"`, where a table's column names do not state it.
        model: The OpenSim model (.osim) of a .mot or .sto file, with axes, order and signs of pelvis and
            legs and the hip centres.
        pelvis_order: Without a model: the order of the pelvis's rotations from the ground on, e.g.
            `("rotation", "list", "tilt")`; None: tilt, list, rotation.
        columns: Of a table (.csv, .tsv, .txt) without a header line: what each column is, a joint or `time`;
            `-joint` changes the sign, `_` is a column that is not used.
        row_rate: Of a table without a column of seconds: rows per second [Hz].

    Raises:
        FormatError: The file cannot be read; with file, line, reason and what would be accepted.
        UnknownNameError: There is no such preset, joint, unit or order.
        DescriptionError: A mapping, order, list of columns or row rate is none.
    """
    for column, joint in table("mapping", mapping).items():
        text(f"mapping of {column}", joint)
    columns = names("columns", columns)
    order = None if pelvis_order is None else several("pelvis_order", pelvis_order)
    if row_rate is not None:
        number("row_rate", row_rate, above=0.0)
    name = path.path if isinstance(path, TrialFile) else Path(path)
    if name.suffix.lower() not in TABLE_SUFFIXES and (columns or row_rate is not None):
        find_format(name, "angles", {**FORMATS, **MARKER_FORMATS})
        why = f"columns by position and row rate are for tables ({', '.join(TABLE_SUFFIXES)})"
        raise FormatError(name, why)
    file = _opened(path, None)
    if not isinstance(file, StorageFile) and (model or pelvis_order):
        why = "a model (.osim) or an order of the pelvis's rotations is for .mot and .sto files"
        raise FormatError(name, f"{why}, and for their columns in a .csv")
    osim = None if model is None else Path(model)
    options = ReadOptions(preset, mapping, units, osim, order, columns, row_rate)
    return _on_even_clock(name, file.gait(options))


def load_markers(path: str | Path | TrialFile) -> Markers:
    """Read a marker trial (.trc, .c3d), or take it from a file that `open_trial` has read.

    Raises:
        FormatError: The file cannot be read; with file, reason and, in texts, line.
    """
    file = _opened(path, "markers")
    return _on_even_clock(file.path, file.markers())


def load_torques(
    path: str | Path | TrialFile, *, preset: SignPreset | None = None, mass: float | None = None
) -> Torques:
    """Read joint torques; the signs become this package's: positive drives the joint the way its name says.

    - `.sto`, `.mot`: OpenSim's inverse dynamics, columns `<coordinate>_moment` [N m], NaN where unknown. A
      generalised force is positive along its coordinate, so only the sign of a knee that is negative in
      flexion changes; the file does not name its model, so a preset must (files of `save_torques` do).
    - `.c3d`: Plug-in Gait's moments of hip, knee and ankle (no inversion) [N mm/kg], times the person's mass.
    - `.csv`: a column `time_s` and columns `<joint>_torque_nm` [N m], as many joints as are known; a cell is
      empty where a torque is not known.

    Args:
        path: The file, or one that `open_trial` has read.
        preset: The OpenSim model's sign convention, e.g. `"opensim-gait2392"`.
        mass: Of the person [kg], for moments per kg; None: as the file has it.

    Raises:
        DescriptionError: The mass is not positive.
        FormatError: The file cannot be read; with file, line, reason and what would be accepted.
        UnknownNameError: There is no such preset.
    """
    if mass is not None:
        number("mass", mass, above=0.0)
    torques = _opened(path, "torques").torques(preset, mass)
    even = even_clock(torques.time)  # as the walk's, so that both keep the same clock
    return torques if even is None else replace(torques, time=even)


def load_forces(path: str | Path | TrialFile) -> tuple[ForcePlate, ...]:
    """Read the force plates of a .mot, .sto or .c3d file, or of one that `open_trial` has read.

    OpenSim's axes (y up) become this package's (z up); a C3D file keeps its own.

    Raises:
        FormatError: With file and reason: no such file, no forces, columns that are missing.
    """
    return _opened(path, "forces").force_plates()


def is_markers(path: str | Path | TrialFile) -> bool:
    """Whether a file holds markers and no joint angles: its walk is made by `exo_pin.markers.load_walk`.

    Raises:
        FormatError: A file that may hold both cannot be read.
    """
    if isinstance(path, TrialFile):
        return path.needs_inverse_kinematics
    suffix = Path(path).suffix.lower()
    if suffix in FORMATS and suffix in MARKER_FORMATS:
        return open_trial(path).needs_inverse_kinematics
    return suffix in MARKER_FORMATS


def knee_preset(path: str | Path | TrialFile, *, model: str | Path | None = None) -> SignPreset | None:
    """The preset whose signs a file of OpenSim coordinates has, as `load_gait` finds it; None: another file.

    Raises:
        FormatError: There are no coordinates in it, or the sign of the knee is not clear.
    """
    file = _opened(path, "angles")
    return file.preset(None if model is None else Path(model)) if isinstance(file, StorageFile) else None


def save_gait(gait: Gait, path: str | Path, *, preset: SignPreset | None = None) -> None:
    """Write a walk to a file; its ending tells the format. All or nothing: never a half-written file.

    Args:
        gait: The walk.
        path: The file.
        preset: Of a .mot or .sto file: the model family it is for; `"opensim-gait2392"` writes the knee
            negative in flexion, None is `"opensim-rajagopal"`.

    Raises:
        FormatError: The ending is unknown, has no choice of preset, or the file cannot be written.
        UnknownNameError: There is no such preset of OpenSim's models.
    """
    path = Path(path)
    if preset is not None:
        if path.suffix.lower() not in (".mot", ".sto"):
            raise FormatError(path, "only .mot and .sto files are written for a model's preset")
        write_gait(gait, path, preset=find_preset(preset, OPENSIM_PRESETS))
        return
    write = written_format(path).write
    assert write is not None  # the formats that cannot be written are left out
    write(gait, path)


def save_torques(torques: Torques, path: str | Path, *, preset: SignPreset | None = None) -> None:
    """Write joint torques to a .csv, .sto or .mot file that `load_torques` reads; all or nothing.

    Args:
        torques: The torques; what is not known is an empty cell (.csv) or NaN (.sto, .mot).
        path: The file.
        preset: Of a .sto or .mot file: the model family it is for, as in `save_gait`.

    Raises:
        FormatError: The ending is another, has no choice of preset, or the file cannot be written.
        UnknownNameError: There is no such preset of OpenSim's models.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in TORQUE_SUFFIXES:
        raise FormatError(path, f"torques are written to {', '.join(TORQUE_SUFFIXES)}")
    if suffix != ".csv":
        write_torques(torques, path, preset=find_preset(preset or "opensim-rajagopal", OPENSIM_PRESETS))
    elif preset is not None:
        raise FormatError(path, "only .mot and .sto files are written for a model's preset")
    else:
        write_csv_torques(torques, path)


def _on_even_clock(path: Path, record: _Record) -> _Record:
    """The record with rounded time stamps on their even grid, before anybody differentiates.

    Raises:
        FormatError: The times cannot be seconds.
    """
    if why := doubtful_unit(record.time):
        raise FormatError(path, f"{why}; milliseconds or frames? Expected a column of seconds")
    if missing := missing_samples(record.time):
        record = replace(record, remarks=(*record.remarks, missing))
    even = even_clock(record.time)
    if even is None:
        return record
    remark = evened_remark(record.time, even)
    events = tuple(replace(e, time=within(e.time, even)) for e in record.events)
    return replace(record, time=even, events=events, remarks=(*record.remarks, remark))


def _opened(path: str | Path | TrialFile, content: Content | None) -> TrialFile:
    if isinstance(path, TrialFile):
        return path
    return open_trial(path, content)

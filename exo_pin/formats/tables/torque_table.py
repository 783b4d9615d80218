"""Joint torques in the columns of a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import SignPreset
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, naming_file
from exo_pin.formats.tables.csv_table import parse_csv, write_csv
from exo_pin.formats.tables.metadata import Metadata, read_metadata
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.gait.torques import Torques

_TIME = "time_s"
_ENDING = "_torque_nm"
"""Of a column: `left_knee_flexion_torque_nm`."""
_TITLE = (
    "Joint torques [N m]: positive drives the joint the way its name says; empty where they are not known."
)


def table_torques(path: Path, lines: Sequence[str], preset: SignPreset | None) -> Torques:
    """Torques of a CSV with a column `time_s` and columns `<joint>_torque_nm` [N m]; empty cells are unknown.

    Args:
        path: The file, for messages.
        lines: Its lines.
        preset: None or `exo_pin`; the columns have this package's signs.

    Raises:
        FormatError: There are no such columns, or another preset is given.
    """
    if preset not in (None, "exo_pin"):
        raise FormatError(path, f"preset {preset!r} is not for this kind of file: its columns tell the signs")
    columns = {joint: f"{joint}{_ENDING}" for joint in JOINTS}
    groups = {column: [column] for column in columns.values()}
    found = parse_csv(path, lines, (_TIME,), groups, empty=True)
    if not found.groups:
        raise FormatError(path, f"no torques; expected columns like {columns['left_knee_flexion']}")
    present = {joint: column for joint, column in columns.items() if column in found.groups}
    source = read_metadata(path, found.comments).source or path.name
    return to_torques(path, found.table.times(_TIME), torque_columns(found.table, present), source)


def write_csv_torques(torques: Torques, path: Path) -> None:
    """Write the table that `table_torques` reads: as many joints as are known, cells may be empty.

    Raises:
        FormatError: The file cannot be written.
    """
    known = [JOINTS.index(joint) for joint in torques.joints]
    names = [_TIME, *(f"{joint}{_ENDING}" for joint in torques.joints)]
    values = np.column_stack([torques.time, torques.tau[:, known]])
    write_csv(path, _TITLE, Metadata(source=torques.source), names, values)


def torque_columns(table: NumericTable, columns: Mapping[str, str]) -> Array:
    """`(n, 12)` columns of a table in the order of `JOINTS`, by joint; NaN where a joint has no column."""
    tau = np.full((len(table.values), len(JOINTS)), np.nan)
    tau[:, [JOINTS.index(joint) for joint in columns]] = table.columns(columns.values())
    return tau


def to_torques(path: Path, time: Array, tau: Array, source: str) -> Torques:
    """The torques that a file describes, with a remark on samples of which none is known.

    Args:
        path: The file, for messages.
        time: `(n,)` [s].
        tau: `(n, 12)` in the order of `JOINTS` [N m]; NaN where unknown.
        source: Where they come from, in words.

    Raises:
        FormatError: The numbers are no torques.
    """
    with naming_file(path):
        empty = int(np.isnan(tau).all(axis=1).sum())
        said = f"{empty} of {len(tau)} samples hold no torque and stay unknown"
        return Torques(time, tau, source=source, remarks=(said,) if empty else ())

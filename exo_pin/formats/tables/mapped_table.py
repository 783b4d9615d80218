"""Foreign tables of joint angles (.csv, .tsv, .txt) as a walk, by a column mapping or a preset."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.column_mapping import (
    Column,
    Header,
    cells_of,
    column_mapping,
    find_header,
    positional_header,
    positional_mapping,
)
from exo_pin.formats.tables.metadata import Metadata, to_gait
from exo_pin.formats.tables.numeric_table import NumericTable, parse, refuse_length
from exo_pin.formats.units import RADIANS_PER
from exo_pin.gait import Gait
from exo_pin.signals import GAP, filled, longest_run

_FASTEST = 1e5
"""Rows per second that are believed [Hz]; force plates have 2000."""


def mapped_gait(path: Path, lines: Sequence[str], options: ReadOptions) -> Gait:
    """The walk in a table whose columns the mapping or a preset names; without either, our own names.

    Commas, semicolons and tabs separate; where it is not the comma, decimals may have one. The header is the
    first line that holds the mapped columns; a line of units below it is skipped. A key of the mapping may
    start with a minus (the sign is turned) or be a number (the joint is held there); its value may be several
    joints with commas between. Gaps (empty cells, NaN) up to 0.2 s are filled; of longer ones the longest
    stretch between is read, and the source names it.

    Args:
        path: The file, for messages.
        lines: Its lines.
        options: Mapping or preset, and units where the column names have none.

    Raises:
        FormatError: With file, line and reason: columns or joints that are missing, no units, a row without a
            time, nothing but gaps.
        UnknownNameError: The mapping names no joint of `JOINTS`, or there is no such preset.
    """
    mapping = column_mapping(options)
    refuse_length(path, len(lines))
    return _gait(find_header(path, lines, mapping), lines, mapping, options)


def positional_gait(path: Path, lines: Sequence[str], options: ReadOptions) -> Gait:
    """The walk in a table without column names; errors as in `mapped_gait`.

    Args:
        path: The file, for messages.
        lines: Its lines.
        options: What each column is, and all that `mapped_gait` takes.
    """
    options.refuse(path, "preset", why="its columns are named by position")
    mapping = positional_mapping(path, options.columns) | dict(options.mapping)
    refuse_length(path, len(lines))
    header = positional_header(path, lines, options.columns)
    return _gait(header, lines, column_mapping(options._replace(mapping=mapping)), options)


def _gait(header: Header, lines: Sequence[str], mapping: Mapping[str, str], options: ReadOptions) -> Gait:
    time, joints = header.time(mapping, options.row_rate), header.joints(mapping)
    angles = dict.fromkeys(column.name for column in joints.values() if column.constant is None)
    table = _table(header, lines, list(angles), time)
    scale = RADIANS_PER[header.unit(options.units, list(angles))]
    q = np.column_stack([_angles(table, joints[joint], scale) for joint in JOINTS])
    return _without_gaps(header.path, _times(table, time, options.row_rate), q, options)


def _times(table: NumericTable, column: str | None, row_rate: float | None) -> Array:
    """`(n,)` seconds of the rows."""
    if column is not None:
        return table.times(column)
    assert row_rate is not None  # Header.time refuses a table without both
    if not 0 < row_rate <= _FASTEST:
        raise FormatError(
            table.path, f"{row_rate:g} rows per second; more than 0, up to {_FASTEST:g} is accepted"
        )
    if len(table.values) < 2:
        raise FormatError(table.path, "only one row of data; a walk has at least 2", line=table.lines[0])
    return np.arange(len(table.values)) / row_rate


def _without_gaps(path: Path, t: Array, q: Array, options: ReadOptions) -> Gait:
    """Short gaps filled; the longest stretch between long ones."""
    whole = filled(t, q)
    start, stop = longest_run(np.isfinite(whole.values).all(axis=1))
    if stop - start < 2:
        raise FormatError(path, f"no two rows in a row without gaps longer than {GAP:g} s")
    how = [
        "columns by position"
        if options.columns
        else f"preset {options.preset}"
        if options.preset
        else "as mapped"
    ]
    how += [f"{options.row_rate:g} rows per second"] if options.row_rate is not None else []
    how += [f"{whole.filled} angles in gaps up to {GAP:g} s filled"] if whole.filled else []
    how += [f"rows {start + 1} to {stop} of {len(t)}, the rest has gaps"] if stop - start < len(t) else []
    metadata = Metadata(source=f"{path.name}, {', '.join(how)}")
    return to_gait(path, t[start:stop], whole.values[start:stop], None, metadata)


def _table(header: Header, lines: Sequence[str], angles: list[str], time: str | None) -> NumericTable:
    """The used columns as numbers, the time first where there is one."""
    used = [*([] if time is None else [time]), *angles]
    twice = next((name for name in used if header.names.count(name) > 1), None)
    if twice is not None:
        raise header.refused(f"column {twice[:80]!r} occurs more than once")
    if not used:
        raise header.refused("no column is used")
    places = [header.names.index(name) for name in used]
    rows = list[str]()
    for number, line in enumerate(lines[header.line :], header.line + 1):
        cells = cells_of(line, header.separator) if line.strip() and not line.startswith("#") else []
        if not cells or (not rows and _is_text(cells)):
            rows.append("")  # kept so that line numbers stay right
            continue
        if len(cells) <= max(places):
            why = f"{len(cells)} values, but the header has {len(header.names)}"
            raise FormatError(header.path, why, line=number)
        if time is not None and not cells[places[0]]:
            raise FormatError(header.path, f"{used[0][:80]} is empty; every row needs a time", line=number)
        rows.append(_row([cells[k] for k in places], header.separator))
    return parse(header.path, used, rows, first=header.line + 1, delimiter=",", gaps=True)


def _row(cells: Sequence[str], separator: str | None) -> str:
    """Numbers with points, separated by commas; a gap is NaN."""
    if separator != ",":
        cells = [cell.replace(",", ".") for cell in cells]
    return ",".join(cell or "nan" for cell in cells)


def _is_text(cells: Sequence[str]) -> bool:
    return not any(re.search(r"\d", cell) for cell in cells)


def _angles(table: NumericTable, column: Column, scale: float) -> Array:
    """`(n,)` angles of a joint [rad]; NaN in gaps."""
    n = len(table.values)
    values = (
        np.full(n, column.constant) if column.constant is not None else table.columns([column.name])[:, 0]
    )
    unit = "degrees" if scale != 1 else "radians"
    absurd = np.flatnonzero(np.abs(values * scale) > np.pi * (1 + 1e-12))  # False where there is a gap
    if len(absurd):
        k = absurd[np.abs(values[absurd]).argmax()]
        why = f"{column.name[:80]} is {values[k]:g}: more than half a turn; are these {unit}?"
        raise FormatError(table.path, why, line=table.lines[k])
    return np.clip(column.sign * values * scale, -np.pi, np.pi)

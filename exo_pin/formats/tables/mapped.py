"""Anybody's table of angles (.csv, .tsv, .txt) as a gait, given which column is which joint."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.files import read_lines
from exo_pin.formats.presets import preset
from exo_pin.formats.reading import UNITS, Reading
from exo_pin.formats.tables.notes import Notes, to_gait
from exo_pin.formats.tables.numeric_table import NumericTable, parse, refuse_length
from exo_pin.gait import Gait
from exo_pin.signals import GAP, filled, longest_run

TIME = "time"
TIMES = ("time_s", "time", "t", "time [s]", "time (s)", "time[s]", "time(s)")
"""What a column of seconds is called, in lower case, if the mapping does not say."""

LONGEST_HEADER = 200
"""Lines before the column names: what measuring programs write of themselves."""

UNIT_ENDING = re.compile(r"(?:_|\[|\(|\s)(deg|rad|degrees|radians|°)[\])]?$", re.IGNORECASE)
TO_RADIANS = {"deg": np.pi / 180, "rad": 1.0}


class Column(NamedTuple):
    """Where a joint's angle comes from: a column by name, or the same number in every row."""

    name: str
    sign: int
    constant: float | None


def read_gait(path: Path, reading: Reading) -> Gait:
    """Read a table whose columns the mapping or a preset names; without either, our own names.

    Commas, semicolons and tabs separate; where it is not the comma, decimals may have one. The header is the
    first line that holds the mapped columns; a line of units below it is skipped. A key of the mapping may
    start with a minus (the sign is turned) or be a number (the joint is held there); its value may be several
    joints with commas between. Gaps (empty cells, NaN) up to 0.2 s are filled; of longer ones the longest
    stretch between is read, and the source says so.

    Raises:
        FormatError: With file, line and reason: columns or joints that are missing, units that nobody says, a
            row without a time, nothing but gaps.
        UnknownNameError: The mapping names no joint of ours, or there is no such preset.
    """
    wanted = _wanted(reading)
    lines = read_lines(path)
    refuse_length(path, len(lines))
    start, separator = _header(path, lines, wanted)
    names = _cells(lines[start], separator)
    time = _time_column(path, names, wanted, start + 1)
    joints = _joints(path, names, wanted, start + 1)
    used = list(dict.fromkeys([time, *(c.name for c in joints.values() if c.constant is None)]))
    table = _table(path, names, lines, start, separator, used)
    scale = TO_RADIANS[_units(path, reading.units, used[1:], start + 1)]
    q = np.column_stack([_angles(table, joints[joint], scale) for joint in JOINTS])
    t = table.times(time)
    whole = filled(t, q)
    start, stop = longest_run(np.isfinite(whole.values).all(axis=1))
    if stop - start < 2:
        raise FormatError(path, f"no two rows in a row without gaps longer than {GAP:g} s")
    said = [f"preset {reading.preset}" if reading.preset else "as mapped"]
    said += [f"{whole.filled} angles in gaps up to {GAP:g} s filled"] if whole.filled else []
    said += [f"rows {start + 1} to {stop} of {len(t)}, the rest has gaps"] if stop - start < len(t) else []
    notes = Notes(source=f"{path.name}, {', '.join(said)}")
    return to_gait(path, t[start:stop], whole.values[start:stop], None, notes)


def _wanted(reading: Reading) -> dict[str, str]:
    """Column -> joints or time, of the preset and the mapping together; the mapping wins."""
    name = reading.preset or (None if reading.mapping else "exo_pin")
    chosen = preset(name).mapping if name else {}
    told = set(_split(reading.mapping.values()))
    for name in told:
        if name not in (TIME, *JOINTS):
            raise UnknownNameError("joint", name, (*JOINTS, TIME))
    wanted = {column: joint for column, joint in chosen.items() if joint not in told}
    return wanted | dict(reading.mapping)


def _split(values: Iterable[str]) -> list[str]:
    return [name.strip() for value in values for name in value.split(",")]


def _header(path: Path, lines: Sequence[str], wanted: Mapping[str, str]) -> tuple[int, str]:
    """The number of the line with the column names, counted from 0, and what separates them."""
    best: tuple[int, int, str] = (0, 0, ",")
    for k, line in enumerate(islice(lines, LONGEST_HEADER)):
        for separator in "\t;,":
            cells = _aliases(_cells(line, separator))
            found = sum(column in cells or column.lstrip("-") in cells for column in wanted)
            if found > best[0]:
                best = (found, k, separator)
    if not best[0]:
        columns = ", ".join(list(wanted)[:4])
        raise FormatError(
            path,
            f"no header line with the mapped columns ({columns} ...); map the names as the file has them",
        )
    return best[1], best[2]


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(separator)]


def _aliases(names: Iterable[str]) -> dict[str, str]:
    """A column answers to its name, and to its name without the unit at its end."""
    names = list(names)
    return {UNIT_ENDING.sub("", name).strip(): name for name in names} | {name: name for name in names}


def _time_column(path: Path, names: Sequence[str], wanted: Mapping[str, str], line: int) -> str:
    told = [column for column, name in wanted.items() if name == TIME]
    found = told or [name for name in names if name.lower() in TIMES]
    if not found or found[0] not in names:
        raise FormatError(path, "no column of seconds; map one to 'time'", line=line)
    return found[0]


def _joints(path: Path, names: Sequence[str], wanted: Mapping[str, str], line: int) -> dict[str, Column]:
    """Joint -> where its angle is."""
    known, columns = _aliases(names), {}
    for key, value in wanted.items():
        for joint in _split([value]):
            if joint != TIME:
                columns[joint] = _column(path, known, key, line)
    gone = [joint for joint in JOINTS if joint not in columns]
    if gone:
        why = f"no column is mapped to {', '.join(gone)}; a number as column holds a joint, as in 0={gone[0]}"
        raise FormatError(path, why, line=line)
    return columns


def _column(path: Path, known: Mapping[str, str], key: str, line: int) -> Column:
    if key in known:
        return Column(known[key], 1, None)
    if key.startswith("-") and key[1:] in known:
        return Column(known[key[1:]], -1, None)
    try:
        return Column(key, 1, float(key))
    except ValueError:
        shown = ", ".join(sorted(known)[:12])
        raise FormatError(path, f"no column {key[:80]!r}; the file has {shown[:300]}", line=line) from None


def _units(path: Path, told: str | None, columns: Sequence[str], line: int) -> str:
    """Degrees or radians: as told, or as every column's name says."""
    if told:
        if told not in UNITS:
            raise UnknownNameError("unit of angles", told, UNITS)
        return told
    said = {match[1].lower()[:3] if (match := UNIT_ENDING.search(name)) else "" for name in columns}
    said = {"deg" if unit == "°" else unit for unit in said}
    if len(said) == 1 and said <= set(UNITS):
        return said.pop()
    raise FormatError(path, "nothing says whether angles are deg or rad; give the units", line=line)


def _table(
    path: Path, names: list[str], lines: list[str], start: int, separator: str, used: list[str]
) -> NumericTable:
    """The used columns as numbers."""
    twice = next((name for name in used if names.count(name) > 1), None)
    if twice is not None:
        raise FormatError(path, f"column {twice[:80]!r} occurs more than once", line=start + 1)
    places = [names.index(name) for name in used]
    first, rows = start + 1, list[str]()
    for number, line in enumerate(lines[first:], first + 1):
        cells = _cells(line, separator) if line.strip() and not line.startswith("#") else []
        if not cells or (not rows and _no_numbers(cells)):
            rows.append("")  # kept so that line numbers stay right
            continue
        if len(cells) <= max(places):
            raise FormatError(path, f"{len(cells)} values, but the header has {len(names)}", line=number)
        if not cells[places[0]]:
            raise FormatError(path, f"{used[0][:80]} is empty; every row needs a time", line=number)
        rows.append(_row([cells[k] for k in places], separator))
    return parse(path, used, rows, first=first + 1, delimiter=",", gaps=True)


def _row(cells: Sequence[str], separator: str) -> str:
    """Numbers with points, separated by commas; a gap is NaN."""
    if separator != ",":
        cells = [cell.replace(",", ".") for cell in cells]
    return ",".join(cell or "nan" for cell in cells)


def _no_numbers(cells: Sequence[str]) -> bool:
    return not any(re.search(r"\d", cell) for cell in cells)


def _angles(table: NumericTable, column: Column, scale: float) -> Array:
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

"""Marker trials of Motion Analysis and OpenSim (.trc)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import numpy as np

from exo_pin.anatomy.names import LengthUnit
from exo_pin.arrays import Array, Mask
from exo_pin.errors import FormatError, naming_file
from exo_pin.files import read_lines
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.trial_file import TrialFile
from exo_pin.formats.units import METRES_PER
from exo_pin.gait import Gait
from exo_pin.gait.trial import Markers, unique

_MOST_NUMBERS = 30_000_000
"""Cells: an hour of forty markers at 60 Hz; bounds memory."""

_HEADER_LINES = 3
"""Above the names of the markers."""


@dataclass(frozen=True, eq=False)
class TrcFile(TrialFile):
    """A .trc file.

    Attributes:
        trial: Its markers.
    """

    trial: Markers

    @property
    def needs_inverse_kinematics(self) -> bool:
        """Always: it holds markers only."""
        return True

    @property
    def takes_length_unit(self) -> bool:
        """Always: files exist whose header has the unit of another program."""
        return True

    def with_length_unit(self, unit: LengthUnit) -> TrcFile:
        """The same content, its lengths in this unit whatever the header says."""
        trial, stated = self.trial, METRES_PER[self.trial.unit]
        if METRES_PER[unit] == stated:
            return self
        remark = f"lengths are read in {unit}, as the units are given; the header says {trial.unit}"
        scaled = trial.position * (METRES_PER[unit] / stated)
        return replace(
            self, trial=replace(trial, position=scaled, unit=unit, remarks=(*trial.remarks, remark))
        )

    def gait(self, options: ReadOptions) -> Gait:
        """Raises `FormatError`: there are no joint angles."""
        why = "holds markers, not angles; exo_pin.markers.load_walk makes a walk of them"
        raise FormatError(self.path, why)

    def markers(self) -> Markers:
        """The marker trial."""
        return self.trial


def open_trc(path: Path) -> TrcFile:
    """Read a .trc file.

    A marker whose cells are empty, NaN or all three exactly 0 was not seen. Decimals may have a comma. Counts
    of frames and markers in the header are often those of another trial: where the table is whole, a count
    that differs is a remark.

    The format does not state which axis is up.

    Raises:
        FormatError: With file, line and reason.
    """
    lines = read_lines(path)
    if not lines[0].startswith("PathFileType") or len(lines) < _HEADER_LINES + 3:
        raise FormatError(
            path, "the first line is not 'PathFileType ...'; expected a .trc marker file", line=1
        )
    header = _header(path, lines)
    unit = _unit(path, header)
    names = _names(path, lines, header)
    places = unique(names)
    values, first = _values(path, lines, len(names)), _HEADER_LINES + 3
    position = values[:, 2:].reshape(len(values), len(names), 3)[:, list(places.values())] * METRES_PER[unit]
    position = np.where((position == 0).all(axis=2, keepdims=True), np.nan, position)
    if np.isnan(values[:, 1]).any():
        raise FormatError(path, "a frame without a time", line=first)
    remarks = _remarks(header, len(names), len(values))
    again = _repeated(values)
    if again.any():
        remarks += (f"rows that repeat time and values of the row above: {again.sum()}, left out",)
        values, position = values[~again], position[~again]
    with naming_file(path):
        trial = Markers(values[:, 1], tuple(places), position, source=path.name, remarks=remarks, unit=unit)
    return TrcFile(path, trial)


def _repeated(values: Array) -> Mask:
    """`(n,)` whether a row has time and coordinates of the row above."""
    below, above = values[1:, 1:], values[:-1, 1:]
    same = (below == above) | (np.isnan(below) & np.isnan(above))
    return np.concatenate([[False], same.all(axis=1)])


def _header(path: Path, lines: Sequence[str]) -> dict[str, str]:
    """Key -> value of lines 2 and 3; some programs pad the values with more tabs than there are keys."""
    keys, values = (_cells(line) for line in lines[1:3])
    keys = [key.lower() for key in keys if key]
    layouts = [values, [value for value in values if value]]
    if len(keys) < 5 or len(layouts[0]) < 5:
        raise FormatError(
            path, "expected the keys DataRate, ..., Units and their values in lines 2 and 3", line=2
        )
    headers = [dict(zip(keys, layout, strict=False)) for layout in layouts]
    return next((found for found in headers if found.get("units", "").lower() in METRES_PER), headers[0])


def _unit(path: Path, header: dict[str, str]) -> str:
    unit = header.get("units", "").lower()
    if unit not in METRES_PER:
        raise FormatError(path, f"Units is {unit[:20]!r}; mm, cm and m are accepted", line=3)
    return unit


def _names(path: Path, lines: Sequence[str], header: dict[str, str]) -> list[str]:
    """Names of the markers.

    Usually one stands over every third column. Some programs leave two columns or one; then each name is that
    of the next three columns, provided that there are as many names as the header or the line of axes
    (X1 Y1 Z1 ...) below says.
    """
    number = _HEADER_LINES + 1
    cells = _cells(lines[_HEADER_LINES].rstrip())
    if len(cells) < 3 or not cells[1].lower().startswith("time"):
        raise FormatError(path, "expected Frame#, Time and the markers' names", line=number)
    usual, packed = cells[2::3], [cell for cell in cells[2:] if cell]
    stated = _count(header, "nummarkers")
    axes = len(lines[_HEADER_LINES + 1].split()) // 3
    for count in (stated, axes):
        for names in (usual, packed):
            if count == len(names) and (names is packed or set(packed) <= set(usual)):
                return names
    if set(packed) <= set(usual) and (0 < stated < len(usual) or len(usual) < stated == axes):
        # some programs leave more names than columns, others do not name the last markers
        return [*usual, *[""] * (stated - len(usual))][:stated]
    said = header.get("nummarkers", "")[:20]
    why = f"header says {said or 'no number of'} markers, the line of names has {len(packed)}"
    raise FormatError(path, why, line=number)


def _cells(line: str) -> list[str]:
    """The cells of a line between tabs, or between blanks where it has no tab."""
    return [cell.strip() for cell in line.split("\t")] if "\t" in line else line.split()


def _count(header: dict[str, str], key: str) -> int:
    """A number of the header; -1 where it holds none."""
    stated = header.get(key, "")
    return int(stated) if re.fullmatch(r"\d{1,15}", stated, re.ASCII) else -1


def _remarks(header: dict[str, str], markers: int, frames: int) -> tuple[str, ...]:
    """Where the header's counts differ from the table."""
    counts = (("nummarkers", "NumMarkers", markers, "markers"), ("numframes", "NumFrames", frames, "frames"))
    return tuple(
        f"the header's {key} is {header.get(name, '')[:20] or 'missing'}, "
        f"the file holds {count} {what}: all of these are read"
        for name, key, count, what in counts
        if _count(header, name) != count
    )


def _values(path: Path, lines: Sequence[str], k: int) -> Array:
    """`(n, 2 + 3 k)` frame, time and coordinates; NaN where a cell is empty or missing at the end."""
    rows = [
        (number, line)
        for number, line in enumerate(lines[_HEADER_LINES + 2 :], _HEADER_LINES + 3)
        if line.strip()
    ]
    width = 2 + 3 * k
    if not rows:
        raise FormatError(path, "no frames below the header")
    if len(rows) * width > _MOST_NUMBERS:
        raise FormatError(path, f"more than {_MOST_NUMBERS} numbers; split the trial")
    values = np.full((len(rows), width), np.nan)
    for i, (number, line) in enumerate(rows):
        cells = _cells(line.rstrip("\t ").replace(",", "."))
        if len(cells) > width or len(cells) < 2:
            raise FormatError(path, f"{len(cells)} values, but {k} markers need {width}", line=number)
        values[i, : len(cells)] = _row(path, cells, number)
    return values


def _row(path: Path, cells: Sequence[str], line: int) -> list[float]:
    try:
        row = [float(cell) if cell.strip() else np.nan for cell in cells]
    except ValueError:
        bad = next(islice((cell for cell in cells if not _is_number(cell)), 1))
        raise FormatError(path, f"{bad.strip()[:40]!r} is no number", line=line) from None
    return [x if abs(x) < 1e9 else np.nan if x != x else _absurd(path, x, line) for x in row]


def _absurd(path: Path, x: float, line: int) -> float:
    raise FormatError(path, f"{x:g} is no coordinate", line=line)


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return not cell.strip()
    return True

"""Marker files of Motion Analysis and OpenSim (.trc)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError
from exo_pin.files import read_lines
from exo_pin.gait.trial import Markers, unique

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
METRES |= {"millimeters": 1e-3, "centimeters": 1e-2, "meters": 1.0, "millimetres": 1e-3, "metres": 1.0}
"""Units of length a file may state."""

MOST_NUMBERS = 30_000_000
"""Cells: an hour of forty markers at 60 Hz; bounds memory."""

KEYS = 3
"""Lines above the names of the markers."""


def read_markers(path: Path) -> Markers:
    """Read a .trc file. What the header says must be true.

    A marker whose cells are empty, NaN or all three exactly 0 was not seen. Decimals may have a comma.

    The format does not say which axis is up.

    Raises:
        FormatError: With file, line and reason.
    """
    lines = read_lines(path)
    if not lines[0].startswith("PathFileType") or len(lines) < KEYS + 3:
        raise FormatError(
            path, "the first line is not 'PathFileType ...'; expected a .trc marker file", line=1
        )
    said = _keys(path, lines)
    names = _names(path, lines[KEYS], said)
    places = unique(names)
    values, first = _values(path, lines, len(names)), KEYS + 3
    stated = said.get("numframes", "")
    if re.fullmatch(r"\d{1,15}", stated) and int(stated) != len(values):
        raise FormatError(path, f"header says {stated} frames, the file has {len(values)}; cut short?")
    scale = METRES[_unit(path, said)]
    position = values[:, 2:].reshape(len(values), len(names), 3)[:, list(places.values())] * scale
    position = np.where((position == 0).all(axis=2, keepdims=True), np.nan, position)
    if np.isnan(values[:, 1]).any():
        raise FormatError(path, "a frame without a time", line=first)
    try:
        return Markers(values[:, 1], tuple(places), position, source=path.name)
    except GaitError as error:
        raise FormatError(path, str(error)) from error


def _keys(path: Path, lines: Sequence[str]) -> dict[str, str]:
    keys, values = lines[1].split("\t"), lines[2].split("\t")
    if len(keys) < 5 or len(values) < 5:
        raise FormatError(
            path, "expected the keys DataRate, ..., Units and their values in lines 2 and 3", line=2
        )
    return {key.strip().lower(): value.strip() for key, value in zip(keys, values, strict=False)}


def _unit(path: Path, said: dict[str, str]) -> str:
    unit = said.get("units", "").lower()
    if unit not in METRES:
        raise FormatError(path, f"Units is {unit[:20]!r}; mm, cm and m are accepted", line=3)
    return unit


def _names(path: Path, line: str, said: dict[str, str]) -> list[str]:
    """Names of the markers, each over three columns."""
    cells = line.rstrip().split("\t")
    if len(cells) < 3 or cells[1].strip().lower() != "time":
        raise FormatError(path, "expected Frame#, Time and the markers' names", line=KEYS + 1)
    names = [cell.strip() for cell in cells[2::3]]
    stated = said.get("nummarkers", "")
    if re.fullmatch(r"\d{1,9}", stated) and 0 < int(stated) < len(names):
        names = names[: int(stated)]  # some programs leave more names than columns
    if stated != str(len(names)):
        why = f"header says {stated[:20]} markers, the line of names has {len(names)}"
        raise FormatError(path, why, line=KEYS + 1)
    return names


def _values(path: Path, lines: Sequence[str], k: int) -> Array:
    """`(n, 2 + 3 k)` frame, time and coordinates; NaN where a cell is empty or missing at the end."""
    rows = [(number, line) for number, line in enumerate(lines[KEYS + 2 :], KEYS + 3) if line.strip()]
    width = 2 + 3 * k
    if not rows:
        raise FormatError(path, "no frames below the header")
    if len(rows) * width > MOST_NUMBERS:
        raise FormatError(path, f"more than {MOST_NUMBERS} numbers; split the trial")
    values = np.full((len(rows), width), np.nan)
    for i, (number, line) in enumerate(rows):
        cells = line.rstrip("\t ").replace(",", ".").split("\t")
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

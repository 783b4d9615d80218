"""Sections of a Vicon Nexus export: title, rate, names, axes, units, rows of numbers by frame."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.safe.plain_numbers import number_or_nan

TITLES = ("Model Outputs", "Trajectories", "Devices", "Events", "Joints", "Segments", "Global Model Outputs")
"""First cell of a section's first line."""

_RATE_UNIT = re.compile(r"\s*hz$", re.IGNORECASE)

_HEADER = 5
"""Lines of a section above its rows: title, rate, names, axes, units."""

_MOST_CELLS = 30_000_000
"""Of a section: bounds memory."""

_LARGEST = 1e9
"""No number of a section is larger, in any unit."""


class Quantity(NamedTuple):
    """A named quantity of a section: its columns.

    Attributes:
        name: With the subject's prefix, as the file has it.
        axes: Of each column, e.g. `X`.
        units: Of each column.
        values: `(n, k)`; NaN in empty cells.
    """

    name: str
    axes: tuple[str, ...]
    units: tuple[str, ...]
    values: Array


class ExportedSection(NamedTuple):
    """A section with numbers.

    Attributes:
        title: One of `TITLES`.
        line: Number of its first line, counted from 1.
        rate: Rows per second [Hz].
        frame: `(n,)` number of the frame of a row, counted from 1.
        part: `(n,)` number of the row within its frame, counted from 0.
        quantities: In the file's order.
    """

    title: str
    line: int
    rate: float
    frame: Array
    part: Array
    quantities: tuple[Quantity, ...]


class ExportedEvent(NamedTuple):
    """A row of the section Events: whose, what, and when [s]."""

    context: str
    name: str
    time: float


def title_of(line: str) -> str | None:
    """The title that a section's first line holds, or None."""
    first = _cells(line, _separator(line))[0] if line.strip() else ""
    alone = not line.replace(first, "", 1).strip(' ,;"\t')
    return next((title for title in TITLES if alone and title.lower() == first.lower()), None)


def read_sections(path: Path, lines: Sequence[str]) -> tuple[list[ExportedSection], list[ExportedEvent]]:
    """The sections of a file.

    Args:
        path: The file, for messages.
        lines: Its lines.

    Raises:
        FormatError: With line and reason: a section without rate, names or rows, ragged or not numeric rows.
    """
    starts = [k for k, line in enumerate(lines) if title_of(line)]
    sections, events = list[ExportedSection](), list[ExportedEvent]()
    for start, stop in pairwise([*starts, len(lines)]):
        title = title_of(lines[start])
        assert title is not None  # that is how starts were found
        body = lines[start:stop]
        if title == "Events":
            events += _events(path, body, start + 1)
        else:
            sections.append(_section(path, title, body, start + 1))
    return sections, events


def _separator(line: str) -> str:
    return max(",;\t", key=line.count)


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def _section(path: Path, title: str, body: Sequence[str], line: int) -> ExportedSection:
    rows = [(line + k, text) for k, text in enumerate(body[_HEADER:], _HEADER) if text.strip(' ,;"\t')]
    if len(body) < _HEADER or not rows:
        raise FormatError(path, f"section {title} has no rows below its names, axes and units", line=line)
    separator = _separator(body[3])
    rate = _number(_RATE_UNIT.sub("", _cells(body[1], separator)[0]), separator)
    if not 0 < rate <= 1e5:
        shown = body[1].strip()[:20]
        raise FormatError(path, f"section {title}: {shown!r} is no rate in Hz", line=line + 1)
    names, axes, units = (_cells(text, separator) for text in body[2:_HEADER])
    if not axes or axes[0].lower() != "frame":
        raise FormatError(path, f"section {title}: expected Frame, Sub Frame and axes", line=line + 3)
    width = len(axes)
    if len(rows) * width > _MOST_CELLS:
        raise FormatError(
            path, f"section {title} has more than {_MOST_CELLS} cells; split the trial", line=line
        )
    values = np.array([_row(path, text, separator, width, number) for number, text in rows])
    columns = 2 if len(axes) > 1 and axes[1].lower().replace(" ", "") == "subframe" else 1
    if not np.isfinite(values[:, :columns]).all():
        raise FormatError(path, f"section {title}: a row without a frame number", line=rows[0][0])
    part = values[:, 1] if columns == 2 else np.zeros(len(values))
    found = _quantities(names, axes, units, values, columns)
    return ExportedSection(title, line, rate, values[:, 0], part, found)


def _quantities(
    names: Sequence[str], axes: Sequence[str], units: Sequence[str], values: Array, first: int
) -> tuple[Quantity, ...]:
    """A name stands over its first column; the columns up to the next name belong to it."""
    padded = [*names[: len(axes)], *[""] * (len(axes) - len(names))]
    starts = [k for k in range(first, len(axes)) if padded[k]]
    units = [*units, *[""] * (len(axes) - len(units))]
    return tuple(
        Quantity(padded[k], tuple(axes[k:end]), tuple(units[k:end]), values[:, k:end])
        for k, end in pairwise([*starts, len(axes)])
    )


def _row(path: Path, text: str, separator: str, width: int, line: int) -> list[float]:
    cells = _cells(text, separator)
    if len(cells) > width and any(cells[width:]):
        raise FormatError(path, f"{len(cells)} values, but the line of axes has {width}", line=line)
    cells = [*cells[:width], *[""] * (width - len(cells))]
    row = [_number(cell, separator) for cell in cells]
    for cell, value in zip(cells, row, strict=True):
        if cell and not abs(value) < _LARGEST and cell.lower() != "nan":
            raise FormatError(path, f"{cell[:40]!r} is no number", line=line)
    return row


def _number(cell: str, separator: str) -> float:
    """A number, with a decimal comma where commas do not separate cells; NaN where it holds none."""
    return number_or_nan(cell if separator == "," else cell.replace(",", "."))


def _events(path: Path, body: Sequence[str], line: int) -> list[ExportedEvent]:
    """Rows of the section Events, whose line of names has Context, Name and Time."""
    head = next((k for k, text in enumerate(body) if "context" in text.lower()), None)
    if head is None:
        raise FormatError(path, "section Events: expected the columns Context, Name and Time (s)", line=line)
    separator = _separator(body[head])
    names = [name.lower() for name in _cells(body[head], separator)]
    places = [
        next((k for k, name in enumerate(names) if name.startswith(w)), -1)
        for w in ("context", "name", "time")
    ]
    if min(places) < 0:
        raise FormatError(
            path, "section Events: expected the columns Context, Name and Time (s)", line=line + head
        )
    out = list[ExportedEvent]()
    for text in body[head + 1 :]:
        cells = _cells(text, separator)
        if len(cells) > max(places) and any(cells):
            context, name, time = (cells[k] for k in places)
            out.append(ExportedEvent(context, name, _number(time, separator)))
    return out

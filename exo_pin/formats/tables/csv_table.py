"""CSV tables with known column names: comment lines, one header line, numbers between commas or tabs."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.files import write_text
from exo_pin.formats.tables.metadata import Comment, Metadata, comment_lines, comments_in
from exo_pin.formats.tables.numeric_table import (
    HEADERLESS,
    NumericTable,
    check_columns,
    is_number,
    parse,
    rows_of_text,
)

_MAPPING = "its column = our joint, --map COLUMN=JOINT"
"""How a table of others is read."""


class CsvTable(NamedTuple):
    """A table and what stands around it.

    Attributes:
        table: The numbers.
        groups: Groups of columns that are there.
        comments: Comment lines above the header.
    """

    table: NumericTable
    groups: tuple[str, ...]
    comments: list[Comment]


def parse_csv(
    path: Path,
    lines: Sequence[str],
    required: Sequence[str],
    groups: Mapping[str, Sequence[str]],
    *,
    separator: str = ",",
    empty: bool = False,
) -> CsvTable:
    """Parse a table whose columns are known by name; their order is free.

    Args:
        path: The file, for messages.
        lines: Its lines.
        required: Columns that must be there.
        groups: Columns that come all together or not at all, by the group's name.
        separator: A comma or a tab.
        empty: Whether a cell may be empty; it becomes NaN. A written `nan` is refused all the same.

    Raises:
        FormatError: For anything but such a table, with the line and what was expected.
    """
    start = next((i for i, line in enumerate(lines) if line.strip() and not line.startswith("#")), None)
    if start is None:
        raise FormatError(
            path, f"empty; expected a header line {','.join(required[:3])},... and rows of numbers"
        )
    names = [name.strip() for name in lines[start].split(separator)]
    if len(names) > 1 and all(map(is_number, names)):
        raise FormatError(path, HEADERLESS, line=start + 1)
    if separator == ",":
        _check_separator(path, lines[start], required, start + 1)
    _check_known(path, names, [*required, *(name for group in groups.values() for name in group)], start + 1)
    check_columns(path, names, required, line=start + 1)
    present = tuple(group for group, columns in groups.items() if set(columns) & set(names))
    for group in present:
        check_columns(path, names, groups[group], line=start + 1)
    rows = lines[start + 1 :]
    gaps = empty and not any("nan" in row.lower() for row in rows)
    if gaps:
        rows = [_with_nan(row, separator) for row in rows]
    table = parse(path, names, rows, first=start + 2, delimiter=separator, gaps=gaps)
    return CsvTable(table, present, comments_in(lines[:start]))


def _with_nan(row: str, separator: str) -> str:
    """A row with NaN for each empty cell; an empty row stays one."""
    if not row.strip():
        return row
    return separator.join(cell if cell.strip() else "nan" for cell in row.split(separator))


def write_csv(
    path: Path, title: str, metadata: Metadata, names: Iterable[str], values: Array, *, separator: str = ","
) -> None:
    """Write a title for people, the metadata, the header and the rows; a cell of NaN is empty.

    Args:
        path: The file.
        title: First comment line.
        metadata: Events, period and source.
        names: m column names.
        values: `(n, m)` numbers.
        separator: A comma or a tab.

    Raises:
        FormatError: The file cannot be written.
    """
    rows = rows_of_text(values, separator)
    if np.isnan(values).any():
        rows = [separator.join("" if x == "nan" else x for x in row.split(separator)) for row in rows]
    write_text(path, "\n".join([f"# {title}", *comment_lines(metadata), separator.join(names), *rows, ""]))


def _check_separator(path: Path, header: str, required: Sequence[str], line: int) -> None:
    other = next((mark for mark in (";", "\t") if mark in header), None)
    if other and "," not in header and required[0] in header:
        shown = "semicolons" if other == ";" else "tabs"
        raise FormatError(
            path, f"columns are separated by {shown}; expected commas and decimal points", line=line
        )


def _check_known(path: Path, names: Sequence[str], known: Sequence[str], line: int) -> None:
    strange = [name for name in names if name not in known]
    if 2 * len(strange) > len(names):
        shown, ours = (", ".join(words[:4])[:200] for words in (names, known))
        why = f"its columns ({shown} ...) are not ours ({ours} ...)"
        raise FormatError(path, f"{why}; a foreign table needs a mapping: {_MAPPING}", line=line)
    for name in strange:
        close = difflib.get_close_matches(name[:80], known, n=1)
        foreign = f"accepted: {', '.join(known)} (a foreign table needs a mapping: {_MAPPING})"
        hint = f"did you mean {close[0]!r}?" if close else foreign
        raise FormatError(path, f"unknown column {name[:80]!r}; {hint}", line=line)

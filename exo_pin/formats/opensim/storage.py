"""OpenSim's storage format (.mot, .sto): a header of keys, a line of column names, a table of numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.files import read_lines, write_text
from exo_pin.formats.tables.metadata import Comment, comments_in
from exo_pin.formats.tables.numeric_table import NumericTable, parse, rows_of_text

_MOST_HEADER_LINES = 10_000
"""A header has a dozen."""

_SIZE_KEYS = {"nrows": "rows", "datarows": "rows", "ncolumns": "columns", "datacolumns": "columns"}
"""Both styles of stating the size of the table."""


class Storage(NamedTuple):
    """A storage file as it stands.

    Attributes:
        title: First line, e.g. `Coordinates`.
        keys: Header entries, keys in lower case, e.g. `{"indegrees": "yes"}`.
        comments: Header lines `# key: value`, which only files of this package have.
        table: All columns, under the file's own names; cells may be NaN.
    """

    title: str
    keys: dict[str, str]
    comments: list[Comment]
    table: NumericTable

    def without_gaps(self) -> NumericTable:
        """The table; raises `FormatError` where a cell is NaN."""
        self.table.refuse(np.isnan(self.table.values), self.table.names, "expected a finite number")
        return self.table


def read_storage(path: Path) -> Storage:
    """Read a storage file; the size that it states must be true, and is never trusted.

    Raises:
        FormatError: It is not such a file, or cut short.
    """
    lines = read_lines(path)
    end = next(
        (i for i, line in enumerate(lines[:_MOST_HEADER_LINES]) if line.strip().lower() == "endheader"), None
    )
    if end is None:
        raise FormatError(path, "no line 'endheader'; expected an OpenSim .mot or .sto file")
    keys: dict[str, str] = {}
    for line in lines[:end]:
        key, equals, value = line.partition("=")
        words = line.split()
        if equals:
            keys[key.strip().lower()] = value.strip()
        elif len(words) == 2 and words[0].lower() in _SIZE_KEYS:
            keys[words[0].lower()] = words[1]
    start = next((i for i in range(end + 1, len(lines)) if lines[i].strip()), None)
    if start is None:
        raise FormatError(path, "no column names after 'endheader'", line=end + 1)
    names = lines[start].strip().split("\t") if "\t" in lines[start].strip() else lines[start].split()
    names = [name.strip() for name in names]
    table = parse(path, names, lines[start + 1 :], first=start + 2, delimiter=None, gaps=True)
    _check_size(path, keys, table)
    return Storage(lines[0].strip(), keys, comments_in(lines[:end]), table)


def _check_size(path: Path, keys: dict[str, str], table: NumericTable) -> None:
    """A file that holds less than it states was cut short."""
    size = dict(zip(("rows", "columns"), table.values.shape, strict=True))
    for key, what in _SIZE_KEYS.items():
        if key not in keys:
            continue
        stated = keys[key]
        if not re.fullmatch(r"\d{1,15}", stated):
            raise FormatError(path, f"header says {key} {stated[:40]!r}, expected a whole number")
        if int(stated) != size[what]:
            raise FormatError(
                path, f"header says {stated} {what}, the file has {size[what]}; cut short or edited?"
            )


def write_storage(
    path: Path, title: str, remarks: Sequence[str], names: Iterable[str], values: Array, *, degrees: bool
) -> None:
    """Write a storage file that OpenSim and `read_storage` read.

    Args:
        path: The file.
        title: First line.
        remarks: Lines of the header behind its keys.
        names: m column names.
        values: `(n, m)` numbers.
        degrees: Whether angles are in degrees (or radians).

    Raises:
        FormatError: The file cannot be written.
    """
    head = [title, "version=1", f"nRows={values.shape[0]}", f"nColumns={values.shape[1]}"]
    head += [f"inDegrees={'yes' if degrees else 'no'}", *remarks, "endheader", "\t".join(names)]
    write_text(path, "\n".join([*head, *rows_of_text(values, "\t"), ""]))

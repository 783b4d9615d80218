"""OpenSim's storage files (.mot, .sto): a header of keys, a line of column names, a table of numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.files import read_lines, write_text
from exo_pin.formats.tables.notes import Note, split
from exo_pin.formats.tables.numeric_table import NumericTable, parse, rows_of_text

LONGEST_HEADER = 10_000
"""Lines; a header is a dozen."""

COUNTS = {"nrows": "rows", "datarows": "rows", "ncolumns": "columns", "datacolumns": "columns"}
"""Both styles of saying how large the table is."""


class Storage(NamedTuple):
    """A storage file as it stands.

    Attributes:
        title: First line, e.g. `Coordinates`.
        keys: Header entries, keys in lower case, e.g. `{"indegrees": "yes"}`.
        notes: Header lines `# key: value`, which only our own files have.
        table: All columns, under the file's own names.
    """

    title: str
    keys: dict[str, str]
    notes: list[Note]
    table: NumericTable


def read_storage(path: Path, *, gaps: bool = False) -> Storage:
    """Read a storage file; what it says of its size must be true, and is never trusted.

    Args:
        path: The file.
        gaps: Whether a cell may be NaN.

    Raises:
        FormatError: If it is not such a file, or cut short.
    """
    lines = read_lines(path)
    end = next(
        (i for i, line in enumerate(lines[:LONGEST_HEADER]) if line.strip().lower() == "endheader"), None
    )
    if end is None:
        raise FormatError(path, "no line 'endheader'; expected an OpenSim .mot or .sto file")
    keys: dict[str, str] = {}
    for line in lines[:end]:
        key, equals, value = line.partition("=")
        words = line.split()
        if equals:
            keys[key.strip().lower()] = value.strip()
        elif len(words) == 2 and words[0].lower() in COUNTS:
            keys[words[0].lower()] = words[1]
    start = next((i for i in range(end + 1, len(lines)) if lines[i].strip()), None)
    if start is None:
        raise FormatError(path, "no column names after 'endheader'", line=end + 1)
    names = lines[start].strip().split("\t") if "\t" in lines[start].strip() else lines[start].split()
    names = [name.strip() for name in names]
    table = parse(path, names, lines[start + 1 :], first=start + 2, delimiter=None, gaps=gaps)
    _check_size(path, keys, table)
    return Storage(lines[0].strip(), keys, split(lines[:end]), table)


def _check_size(path: Path, keys: dict[str, str], table: NumericTable) -> None:
    """A file that holds less than it says was cut short."""
    size = dict(zip(("rows", "columns"), table.values.shape, strict=True))
    for key, what in COUNTS.items():
        if key not in keys:
            continue
        said = keys[key]
        if not re.fullmatch(r"\d{1,15}", said):
            raise FormatError(path, f"header says {key} {said[:40]!r}, expected a whole number")
        if int(said) != size[what]:
            raise FormatError(
                path, f"header says {said} {what}, the file has {size[what]}; cut short or edited?"
            )


def write_storage(
    path: Path, title: str, remarks: Sequence[str], names: Iterable[str], values: Array, *, degrees: bool
) -> None:
    """Write a storage file that OpenSim and `read_storage` read."""
    head = [title, "version=1", f"nRows={values.shape[0]}", f"nColumns={values.shape[1]}"]
    head += [f"inDegrees={'yes' if degrees else 'no'}", *remarks, "endheader", "\t".join(names)]
    write_text(path, "\n".join([*head, *rows_of_text(values, "\t"), ""]))

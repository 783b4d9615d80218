"""OpenSim's storage format (.mot, .sto): a header of keys, a line of column names, a table of numbers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

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
        table: All columns, under the file's own names, of which some may be repeated; cells may be NaN.
        remarks: What of its header is not so, a sentence each.
    """

    title: str
    keys: dict[str, str]
    comments: list[Comment]
    table: NumericTable
    remarks: tuple[str, ...] = ()


def read_storage(path: Path) -> Storage:
    """Read a storage file; the size that it states is never trusted, and remarked on where it is not so.

    Raises:
        FormatError: It is not such a file, its table is ragged, or its cells are vectors or quaternions.
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
    cells = lines[start].split("\t") if "\t" in lines[start].strip() else lines[start].split()
    names = [name.strip() for name in cells if name.strip()]
    rows = lines[start + 1 :]
    if _check_cells(path, keys, rows, start + 2) == 1:
        rows = [row.replace(",", ".") for row in rows]
    table = parse(path, names, rows, first=start + 2, delimiter=None, gaps=True, repeated=True)
    return Storage(lines[0].strip(), keys, comments_in(lines[:end]), table, _size_remarks(keys, table))


def _check_cells(path: Path, keys: dict[str, str], rows: Sequence[str], first: int) -> int:
    """Most commas in a cell of the first row, of which one is a decimal comma.

    Raises:
        FormatError: Cells hold several numbers with commas between: quaternions of sensors, vectors.
    """
    number, row = next(((k, row) for k, row in enumerate(rows, first) if row.strip()), (first, ""))
    commas = max((cell.count(",") for cell in row.split()), default=0)
    stated = keys.get("datatype", "").lower()
    if stated == "quaternion" or commas == 3:
        why = "holds orientations of sensors (quaternions), not joint angles; run OpenSim's IMU inverse "
        raise FormatError(
            path, why + "kinematics (OpenSense) first and read the .mot that it writes", line=number
        )
    if commas > 1:
        why = f"its cells hold {commas + 1} numbers each (vectors); expected one number a cell, as joint "
        raise FormatError(path, why + "coordinates have", line=number)
    return commas


def _size_remarks(keys: dict[str, str], table: NumericTable) -> tuple[str, ...]:
    """Where the header states another size than the table has; OpenSim reads the table, so is done here."""
    size = dict(zip(("rows", "columns"), table.values.shape, strict=True))
    found = []
    for key, what in _SIZE_KEYS.items():
        stated = keys.get(key, str(size[what])).lstrip("0") or "0"
        if stated != str(size[what]):
            fewer = stated.isdigit() and (len(stated), stated) > (len(str(size[what])), str(size[what]))
            end = "cut short, or the header was not renewed" if fewer else "the header was not renewed"
            shown = stated[:20] + "..." * (len(stated) > 20)
            found.append(f"the header says {shown} {what}, the table has {size[what]}, which are read: {end}")
    return tuple(found)


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

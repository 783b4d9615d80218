"""Records as a CSV table that can be continued: exact numbers, one line each, with a checksum."""

from __future__ import annotations

import csv
import dataclasses
import hashlib
import io
import math
from collections.abc import Callable, Iterable, Mapping, Set
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar, get_type_hints

from exo_pin.errors import FormatError
from exo_pin.files import read_text, write_text
from exo_pin.safe.spreadsheet_cells import marked, unmarked

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Record = TypeVar("Record", bound="DataclassInstance")

_DIGITS = 16
"""Hexadecimal digits of a checksum (SHA-256)."""

_READERS: Mapping[type, Callable[[str], Any]] = {
    int: int,
    float: lambda cell: float(cell) if cell else math.nan,
}


class RecordTable(Generic[Record]):
    """The table of one class of records, whose fields are texts and numbers.

    Args:
        record: The class.
        always: Columns of such a table whatever its version.
    """

    def __init__(self, record: type[Record], always: Set[str]) -> None:
        self._record, self._always = record, always
        self._fields = tuple(field.name for field in dataclasses.fields(record))
        types = get_type_hints(record)
        self._readers = tuple(_READERS.get(types[name], str) for name in self._fields)
        self.columns = (*self._fields, "checksum")
        """Names of the columns; the last one is of the other cells, and shows that none was edited."""

    def text(self, rows: Iterable[Record], *, heading: bool = True) -> str:
        """Rows as CSV; numbers in the shortest form that reads back as the same, an empty cell for NaN."""
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        if heading:
            writer.writerow(self.columns)
        for row in rows:
            cells = [_cell(value) for value in dataclasses.astuple(row)]
            writer.writerow([*cells, _checksum(cells)])
        return file.getvalue()

    def save(self, rows: Iterable[Record], path: str | Path) -> None:
        """Write rows as CSV, all or nothing.

        Raises:
            FormatError: The file cannot be written.
        """
        write_text(path, self.text(rows))

    def load(self, path: str | Path) -> list[Record]:
        """Read rows that `save` has written.

        Raises:
            FormatError: The file cannot be read, is no such table of this version, or a row was edited.
        """
        rows, unusable = self.rows_and_unusable_lines(path, read_text(path))
        if unusable:
            why = (
                f"not a row of a study as it was written: {len(self.columns)} cells, the last their checksum"
            )
            raise FormatError(path, why, line=unusable[0])
        return rows

    def rows_and_unusable_lines(self, path: str | Path, content: str) -> tuple[list[Record], list[int]]:
        """The rows of a table, and the numbers of its lines that are none: edited or damaged.

        Args:
            path: The file, for messages.
            content: Its text; empty is a table without rows.

        Raises:
            FormatError: It is no such table, or one of another version.
        """
        heading, *lines = content.split("\n")
        if content and _cells(heading) != list(self.columns):
            self.check_heading(path, content)
            why = (
                "the table of a study of another version (its columns differ); choose another file, or "
                "--restart"
            )
            raise FormatError(path, why, line=1)
        found = {k: self._row(line) for k, line in enumerate(lines, 2) if line.strip()}
        return [row for row in found.values() if row], [k for k, row in found.items() if not row]

    def check_heading(self, path: str | Path, content: str) -> None:
        """Raise `FormatError` for a text that is no such table of any version."""
        if content and not set(_cells(content.partition("\n")[0]) or []) >= self._always:
            raise FormatError(path, "not the table of a study (its columns differ)", line=1)

    def _row(self, line: str) -> Record | None:
        """The row of a line (each row is one), or None where its checksum is wrong."""
        cells = _cells(line)
        if cells is None or len(cells) != len(self.columns) or _checksum(cells[:-1]) != cells[-1]:
            return None
        try:
            values = [read(unmarked(cell)) for read, cell in zip(self._readers, cells[:-1], strict=True)]
        except ValueError:
            return None
        return self._record(**dict(zip(self._fields, values, strict=True)))


def _cells(line: str) -> list[str] | None:
    """The cells of a line; None where one is too long."""
    try:
        return next(csv.reader([line]), [])
    except csv.Error:
        return None


def _checksum(cells: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(cells).encode()).hexdigest()[:_DIGITS]


def _cell(value: str | int | float) -> str:
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    text = " ".join(str(value).split())  # one row is one line, so that an unfinished row is recognised
    return marked(text)

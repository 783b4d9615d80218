"""Numeric tables of text: named columns of numbers, with the line at fault where a cell holds no number."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.errors import FormatError
from exo_pin.gait.event import SAME_TIME
from exo_pin.safe import plain_numbers

MOST_ROWS = 2_000_000
"""Of a table: five hours at 100 Hz; bounds memory (a walk of this size takes 1.2 GB)."""

HEADERLESS = (
    "no line of column names, the first row holds numbers; name the columns by position, "
    "--columns time,left_hip_flexion,... (or write such a line into the file)"
)
"""Of a table that begins with numbers."""


@dataclass(frozen=True, eq=False)
class NumericTable:
    """Named columns of finite numbers (or NaN, where the reader allows gaps).

    Attributes:
        path: The file.
        names: Column names; only a storage file may repeat one, and then not one that is read.
        values: `(n, m)`.
        lines: Line number of each row, counted from 1.
    """

    path: Path
    names: tuple[str, ...]
    values: Array
    lines: Sequence[int]

    def columns(self, names: Iterable[str]) -> Array:
        """`(n, k)` values of the named columns, in that order."""
        return self.values[:, [self.names.index(name) for name in names]]

    def refuse_repeated(self, names: Iterable[str]) -> None:
        """Raise `FormatError` for one of these columns that the table has more than once."""
        count = Counter(self.names)
        twice = next((name for name in names if count[name] > 1), None)
        if twice is not None:
            raise FormatError(
                self.path, f"column {twice[:80]!r} occurs more than once", line=self.lines[0] - 1
            )

    def once_each_time(self, time: str, names: Sequence[str]) -> tuple[NumericTable, tuple[str, ...]]:
        """The table without rows that repeat time and values of the row above, and a remark on them.

        OpenSim's RRA and CMC write such rows where they restart.

        Args:
            time: Column of the time.
            names: Columns that must be the same, NaN being the same as NaN.

        Raises:
            FormatError: A time comes twice, with different values.
        """
        used = self.columns([time, *names])
        same = np.flatnonzero(np.abs(np.diff(used[:, 0])) < SAME_TIME) + 1
        if not same.size:
            return self, ()
        differs = ~np.isclose(used[same], used[same - 1], rtol=0, atol=1e-9, equal_nan=True)
        if differs.any():
            row, k = np.argwhere(differs)[0]
            row = same[row]
            why = f"time {used[row, 0]:.12g} comes twice, with {[time, *names][k]} {used[row - 1, k]:.9g} and"
            why += f" {used[row, k]:.9g}; expected increasing seconds, or the same row again"
            raise FormatError(self.path, why, line=self.lines[row])
        kept = np.setdiff1d(np.arange(len(used)), same)
        lines = [self.lines[row] for row in kept]
        remark = f"rows that repeat time and values of the row above: {len(same)}, left out"
        return NumericTable(self.path, self.names, self.values[kept], lines), (remark,)

    def refuse(self, bad: Mask, names: Sequence[str], why: str) -> None:
        """Refuse a table with bad cells.

        Args:
            bad: `(n, k)` whether a cell is bad.
            names: The k columns.
            why: What is expected.

        Raises:
            FormatError: A cell is bad; the message names the first.
        """
        if bad.any():
            row, k = np.argwhere(bad)[0]
            value = self.columns([names[k]])[row, 0]
            raise FormatError(self.path, f"{names[k]} is {value:g}: {why}", line=self.lines[row])

    def angles(self, names: Sequence[str], *, degrees: bool = True) -> Array:
        """`(n, k)` angles [rad]; raises `FormatError` for one beyond half a turn."""
        values = self.columns(names)
        bad = np.abs(values) > (180 if degrees else np.pi)
        self.refuse(bad, names, f"more than half a turn; expected {'degrees' if degrees else 'radians'}")
        return np.radians(values) if degrees else values

    def times(self, name: str) -> Array:
        """`(n,)` the time column; `FormatError` unless there are two rows or more and it increases."""
        time = self.columns([name])[:, 0]
        if len(time) < 2:
            raise FormatError(self.path, "only one row of data; a walk has at least 2", line=self.lines[0])
        late = np.flatnonzero(~(np.diff(time) > 0))  # NaN is not later either
        if late.size:
            why = f"{name} does not increase: {time[late[0] + 1]:.12g} after {time[late[0]]:.12g}"
            raise FormatError(
                self.path, f"{why}; expected strictly increasing seconds", line=self.lines[late[0] + 1]
            )
        return time


def parse(
    path: Path,
    names: Sequence[str],
    lines: Sequence[str],
    *,
    first: int,
    delimiter: str | None,
    gaps: bool = False,
    repeated: bool = False,
) -> NumericTable:
    """Read the rows below a header.

    Args:
        path: The file, for messages.
        names: Names of the columns.
        lines: The rows; empty ones are skipped.
        first: Line number of `lines[0]`, counted from 1.
        delimiter: What separates the cells; None is any blank.
        gaps: Whether a cell may be NaN.
        repeated: Whether a name may occur more than once.

    Raises:
        FormatError: For duplicate names, no rows, ragged rows, cells that are no number, infinity and (but
            for `gaps`) NaN.
    """
    refuse_length(path, len(lines))
    name, times = Counter(names).most_common(1)[0]
    if times > 1 and not repeated:
        raise FormatError(path, f"column {name[:80]!r} occurs more than once", line=first - 1)
    rows = [(number, line) for number, line in enumerate(lines, first) if line.strip()]
    if not rows:
        raise FormatError(path, "no rows of data below the header")
    try:
        values = np.loadtxt([line for _, line in rows], delimiter=delimiter, comments=None, ndmin=2)
    except ValueError as error:
        raise _culprit(path, names, rows, delimiter, str(error)) from error
    if values.shape != (len(rows), len(names)):
        raise _culprit(path, names, rows, delimiter, "the rows do not fit the header")
    table = NumericTable(path, tuple(names), values, [number for number, _ in rows])
    bad = np.isinf(values) if gaps else ~np.isfinite(values)
    if bad.any():
        row, k = np.argwhere(bad)[0]
        why = f"{names[k][:80]} is {values[row, k]:g}: expected a finite number"
        raise FormatError(path, why, line=table.lines[row])
    return table


def refuse_length(path: Path, rows: int) -> None:
    """Raise `FormatError` for a table that is too long to be read."""
    if rows > MOST_ROWS:
        raise FormatError(path, f"{rows} rows; at most {MOST_ROWS} are read, split or resample the recording")


def _culprit(
    path: Path, names: Sequence[str], rows: Sequence[tuple[int, str]], delimiter: str | None, error: str
) -> FormatError:
    """The error that names the first line which is at fault."""
    for number, line in rows:
        cells = line.split(delimiter)
        if len(cells) != len(names):
            why = f"{len(cells)} values, but the header has {len(names)} columns"
            return FormatError(path, why, line=number)
        for name, cell in zip(names, cells, strict=True):
            if not is_number(cell):
                shown = cell.strip()[:40]
                return FormatError(
                    path, f"{name[:80]} is {shown!r}, expected a number like 12.5", line=number
                )
    return FormatError(path, f"cannot be read as numbers: {error[:150]}")


def is_number(cell: str) -> bool:
    """Whether a cell holds a number."""
    try:
        plain_numbers.number(cell)
    except ValueError:
        return False
    return True


def check_columns(path: Path, names: Sequence[str], expected: Iterable[str], *, line: int) -> None:
    """Check that columns are there.

    Args:
        path: The file, for messages.
        names: Column names of the file.
        expected: Names of columns that must be among them.
        line: Number of the header line.

    Raises:
        FormatError: Some are not; the message lists them.
    """
    absent = [name for name in expected if name not in names]
    if absent:
        raise FormatError(path, f"missing column{'s' * (len(absent) > 1)}: {', '.join(absent)}", line=line)


def rows_of_text(values: Array, separator: str) -> list[str]:
    """Each row as text, with as many digits as bring back the same numbers."""
    return [separator.join(map(repr, row)) for row in values.tolist()]

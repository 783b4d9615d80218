"""Column mapping: which column of a foreign table is the time and which is which joint, and their unit."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import AngleUnit
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.sign_presets import find_preset
from exo_pin.formats.tables.numeric_table import HEADERLESS, is_number
from exo_pin.formats.units import ANGLE_UNITS, angle_unit

_TIME = "time"
"""What a mapping calls the column of seconds."""

_TIME_NAMES = ("time_s", "time", "t", "time [s]", "time (s)", "time[s]", "time(s)")
"""Names of a column of seconds, in lower case, where the mapping has none."""

_MOST_LINES = 200
"""Before the column names: what measuring programs write of themselves."""

_UNIT_ENDING = re.compile(r"(?:_|\[|\(|\s)(deg|rad|degrees|radians|°)[\])]?$", re.IGNORECASE)


class Column(NamedTuple):
    """Where a joint's angle comes from: a column by name, or the same number in every row."""

    name: str
    sign: int
    constant: float | None


class Header(NamedTuple):
    """The line with the column names.

    Attributes:
        path: The file, for messages.
        row: Number of the line, counted from 0; -1 where the first line of the file holds numbers.
        separator: What separates its cells: a comma, a semicolon, a tab, or None for any blanks.
        names: Names of the columns.
    """

    path: Path
    row: int
    separator: str | None
    names: list[str]

    @property
    def line(self) -> int:
        """Number of the line, counted from 1; 0 where there is no such line."""
        return self.row + 1

    def time(self, mapping: Mapping[str, str], row_rate: float | None) -> str | None:
        """The column of seconds: mapped to `time`, or of a usual name; None where a rate stands for it.

        Args:
            mapping: Column -> joint or `time`.
            row_rate: Rows per second [Hz] that the user gave.

        Raises:
            FormatError: There is neither such a column nor a rate, or both.
        """
        mapped = [column for column, name in mapping.items() if name == _TIME]
        found = mapped or [name for name in self.names if name.lower() in _TIME_NAMES]
        if row_rate is None and (not found or found[0] not in self.names):
            why = "no column of seconds; map one to 'time', or give the rows per second (--row-rate)"
            raise self.refused(why)
        if row_rate is not None and found:
            raise self.refused(f"{found[0][:80]} holds the seconds; a rate of rows is for a table without")
        return found[0] if found else None

    def refused(self, why: str) -> FormatError:
        """The error of this line, or of the file where there is no such line."""
        return FormatError(self.path, why, line=self.line or None)

    def joints(self, mapping: Mapping[str, str]) -> dict[str, Column]:
        """Joint -> where its angle is.

        Raises:
            FormatError: A mapped column or a joint is missing.
        """
        known, columns = _aliases(self.names), dict[str, Column]()
        for key, value in mapping.items():
            for joint in _split([value]):
                if joint != _TIME:
                    columns[joint] = self._column(known, key)
        absent = [joint for joint in JOINTS if joint not in columns]
        if absent:
            hint = f"a number as column holds a joint, as in 0={absent[0]}"
            why = f"no column is mapped to {', '.join(absent)}; {hint}"
            raise self.refused(why)
        return columns

    def unit(self, chosen: str | None, columns: Sequence[str]) -> AngleUnit:
        """The unit of angles.

        Args:
            chosen: By the user.
            columns: Names of the columns of angles, which may end in it.

        Raises:
            FormatError: Neither states it.
            UnknownNameError: There is no such unit.
        """
        if chosen:
            return angle_unit(chosen)
        endings = {match[1].lower()[:3] if (match := _UNIT_ENDING.search(name)) else "" for name in columns}
        units = {"deg" if unit == "°" else unit for unit in endings}
        if len(units) == 1 and units <= set(ANGLE_UNITS):
            return angle_unit(units.pop())
        raise self.refused("nothing says whether angles are deg or rad; give the units (--units)")

    def _column(self, known: Mapping[str, str], key: str) -> Column:
        if key in known:
            return Column(known[key], 1, None)
        if key.startswith("-") and key[1:] in known:
            return Column(known[key[1:]], -1, None)
        try:
            return Column(key, 1, float(key))
        except ValueError:
            why = f"no column {key[:80]!r}; the file has {', '.join(sorted(known)[:12])[:300]}"
            raise self.refused(why) from None


def column_mapping(options: ReadOptions) -> dict[str, str]:
    """Column -> joints or time, of the preset and the mapping together; the mapping wins.

    Raises:
        UnknownNameError: There is no such preset or joint.
    """
    name = options.preset or (None if options.mapping else "exo_pin")
    chosen = find_preset(name).mapping if name else {}
    mapped = set(_split(options.mapping.values()))
    for joint in mapped:
        if joint not in (_TIME, *JOINTS):
            raise UnknownNameError("joint", joint, (*JOINTS, _TIME))
    kept = {column: joint for column, joint in chosen.items() if joint not in mapped}
    return kept | dict(options.mapping)


def find_header(path: Path, lines: Sequence[str], mapping: Mapping[str, str]) -> Header:
    """The line with most of the mapped columns, among the first 200.

    Args:
        path: The file, for messages.
        lines: Its lines.
        mapping: Column -> joints or time.

    Raises:
        FormatError: No line has one of them.
    """
    most, best = 0, (0, ",")
    for k, line in enumerate(islice(lines, _MOST_LINES)):
        for separator in "\t;,":
            names = _aliases(cells_of(line, separator))
            found = sum(column in names or column.lstrip("-") in names for column in mapping)
            if found > most:
                most, best = found, (k, separator)
    if not most:
        if starts_with_numbers(lines):
            raise FormatError(path, HEADERLESS)
        columns = ", ".join(list(mapping)[:4])
        why = f"no header line with the mapped columns ({columns} ...); map the names as the file has them"
        raise FormatError(path, why)
    return Header(path, *best, cells_of(lines[best[0]], best[1]))


def positional_header(path: Path, lines: Sequence[str], columns: Sequence[str]) -> Header:
    """A header for a table without one: its columns are called `column 1`, `column 2` and so on.

    Lines of text above the first row of numbers, and comments, are left out.

    Args:
        path: The file, for messages.
        lines: Its lines.
        columns: What each column is.

    Raises:
        FormatError: No row holds as many numbers.
    """
    found = 0
    for k, line in enumerate(islice(lines, _MOST_LINES)):
        for separator in ("\t", ";", ",", None):
            n = _numbers_in(line, separator)
            if n == len(columns):
                return Header(path, k - 1, separator, [f"column {i}" for i in range(1, n + 1)])
            found = max(found, n) if found == 0 or n > 1 else found
    held = (
        f"its rows hold {found} numbers" if found else f"no row of numbers in the first {_MOST_LINES} lines"
    )
    raise FormatError(path, f"{len(columns)} columns are named, but {held}; `_` leaves a column out")


def positional_mapping(path: Path, columns: Sequence[str]) -> dict[str, str]:
    """`column 1` and so on -> joint or time; a minus before the joint goes before the column.

    Args:
        path: The file, for messages.
        columns: What each column is.

    Raises:
        FormatError: A joint is named twice.
        UnknownNameError: A column is named otherwise.
    """
    mapping = dict[str, str]()
    for number, word in enumerate(columns, 1):
        joint = word.strip()
        sign, joint = ("-", joint[1:]) if joint.startswith("-") else ("", joint)
        if joint not in ("_", _TIME, *JOINTS):
            raise UnknownNameError("column", joint, (*JOINTS, _TIME, "_"))
        if joint != "_" and joint in mapping.values():
            raise FormatError(path, f"{joint} is named twice; every column once, `_` leaves one out")
        if joint != "_":
            mapping[f"{sign}column {number}"] = joint
    return mapping


def starts_with_numbers(lines: Sequence[str]) -> bool:
    """Whether a table begins with a row of numbers, without names of columns."""
    first = next((line for line in lines if line.strip() and not line.startswith("#")), "")
    return any(_numbers_in(first, separator) > 1 for separator in ("\t", ";", ",", None))


def _numbers_in(line: str, separator: str | None) -> int:
    """Cells of a line, but for an empty last one; 0 unless they are numbers (or gaps between numbers)."""
    cells = cells_of(line, separator)
    cells = cells[:-1] if cells and not cells[-1] else cells
    whole = [cell if separator == "," else cell.replace(",", ".") for cell in cells if cell]
    return len(cells) if whole and all(map(is_number, whole)) else 0


def cells_of(line: str, separator: str | None) -> list[str]:
    """The cells of a line, without blanks and quotation marks around them."""
    return [cell.strip().strip('"') for cell in line.split(separator)]


def _split(values: Iterable[str]) -> list[str]:
    return [name.strip() for value in values for name in value.split(",")]


def _aliases(names: Iterable[str]) -> dict[str, str]:
    """Each name, and each name without the unit at its end -> the name."""
    names = list(names)
    return {_UNIT_ENDING.sub("", name).strip(): name for name in names} | {name: name for name in names}

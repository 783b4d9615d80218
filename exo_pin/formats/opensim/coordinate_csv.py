"""OpenSim coordinates in a table with commas or semicolons, as OpenCap and spreadsheets write them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from exo_pin.files import first_lines, read_lines
from exo_pin.formats.opensim.coordinate_names import LEG_COORDINATES
from exo_pin.formats.opensim.coordinate_table import TIME_COLUMN, plain_name
from exo_pin.formats.opensim.coordinates import coordinates_gait
from exo_pin.formats.opensim.storage import Storage
from exo_pin.formats.opensim.storage_file import StorageFile
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.column_mapping import cells_of
from exo_pin.formats.tables.numeric_table import is_number, parse
from exo_pin.formats.tables.table_file import TableFile
from exo_pin.gait import Gait

_HEAD = 65536
"""Bytes that the line of names fits in."""


@dataclass(frozen=True, eq=False)
class CoordinateCsv(StorageFile):
    """Such a table.

    Attributes:
        lines: Of the file.
    """

    lines: list[str]

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by its coordinates, or as any table where the user names its columns."""
        named = [key for key in options.mapping if not is_number(key)]
        if named or options.columns or options.row_rate is not None:
            return TableFile(self.path, self.lines, _separator(self.lines[0])).gait(options)
        return coordinates_gait(self.storage, options)


def is_coordinate_csv(path: Path) -> bool:
    """Whether the first line names the time and coordinates of the legs."""
    lines = first_lines(path, _HEAD)[:1]
    names = {plain_name(name) for line in lines for name in cells_of(line, _separator(line))}
    return TIME_COLUMN in names and len(names & {*LEG_COORDINATES}) > 1


def open_coordinate_csv(path: Path) -> CoordinateCsv:
    """Read such a table: a column without a name, the rows' numbers, is left out.

    Raises:
        FormatError: Ragged rows, cells that are no number.
    """
    lines = read_lines(path)
    separator = _separator(lines[0])
    names = [name or f"unnamed {k}" for k, name in enumerate(cells_of(lines[0], separator))]
    rows = [line.replace('"', "") for line in lines[1:]]
    if separator != ",":  # spreadsheets of many countries have a decimal comma
        rows = [row.replace(",", ".") for row in rows]
    table = parse(path, names, rows, first=2, delimiter=separator, gaps=True, repeated=True)
    return CoordinateCsv(path, Storage("Coordinates", {}, [], table), lines)


def _separator(line: str) -> str:
    """What separates the names: a comma, a semicolon or a tab."""
    return max(",;\t", key=line.count)

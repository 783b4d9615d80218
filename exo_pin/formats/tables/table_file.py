"""Tables (.csv, .tsv, .txt) of time, joint angles and pelvis pose, with own names or any by a mapping."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import SignPreset
from exo_pin.files import read_lines
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.csv_table import parse_csv, write_csv
from exo_pin.formats.tables.mapped_table import mapped_gait, positional_gait
from exo_pin.formats.tables.metadata import Metadata, read_metadata, to_gait
from exo_pin.formats.tables.pose_columns import pose_names, pose_values, read_poses
from exo_pin.formats.tables.torque_table import table_torques
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Gait
from exo_pin.gait.torques import Torques

TABLE_SUFFIXES = (".csv", ".tsv", ".txt")
"""Endings of tables of text."""

_TIME = "time_s"
_ANGLES = tuple(f"{joint}_deg" for joint in JOINTS)
_PELVIS = pose_names("pelvis")
_TITLE = "A walk: joint angles [deg]; the pelvis's pose in the world [m, unit quaternion] where it moves."


@dataclass(frozen=True, eq=False)
class TableFile(TrialFile):
    """A table of text.

    Attributes:
        lines: The file's lines.
        separator: A comma or a tab, between the columns of a table of this package.
    """

    lines: list[str]
    separator: str

    def gait(self, options: ReadOptions) -> Gait:
        """The walk of the columns; a mapping, positions or another preset name those of a foreign table.

        Raises:
            FormatError: The file is not such a table, or its numbers are no walk; with line and reason.
            UnknownNameError: The mapping names no joint of `JOINTS`, or there is no such preset.
        """
        if options.columns:
            return positional_gait(self.path, self.lines, options)
        if options.mapping or options.row_rate is not None or options.preset not in (None, "exo_pin"):
            return mapped_gait(self.path, self.lines, options)
        if self.separator == "\t" and (options.units or not self._has_own_names()):
            return mapped_gait(self.path, self.lines, options)
        options.refuse(self.path, "units", why="its columns end in _deg; map the columns of a foreign table")
        return self._own_gait()

    def torques(self, preset: SignPreset | None = None, mass: float | None = None) -> Torques:
        """Columns `<joint>_torque_nm`; arguments and errors as in `TrialFile.torques`."""
        return table_torques(self.path, self.lines, preset)

    def _own_gait(self) -> Gait:
        groups = {"pelvis": _PELVIS}
        found = parse_csv(self.path, self.lines, (_TIME, *_ANGLES), groups, separator=self.separator)
        base = read_poses(found.table, "pelvis") if found.groups else None
        metadata = read_metadata(self.path, found.comments)
        return to_gait(self.path, found.table.times(_TIME), found.table.angles(_ANGLES), base, metadata)

    def _has_own_names(self) -> bool:
        """Whether the header is this package's, with no other column."""
        header = next((line for line in self.lines if line.strip() and not line.startswith("#")), "")
        names = {name.strip() for name in header.split("\t")}
        return {_TIME, *_ANGLES} <= names <= {_TIME, *_ANGLES, *_PELVIS}


def open_csv(path: Path) -> TableFile:
    """Read a table with commas; raises `FormatError`."""
    return TableFile(path, read_lines(path), ",")


def open_tsv(path: Path) -> TableFile:
    """Read a table with tabs; raises `FormatError`."""
    return TableFile(path, read_lines(path), "\t")


def write_csv_gait(gait: Gait, path: Path) -> None:
    """Write a gait with commas; reading brings back the same numbers within 1e-12 rad and 1e-12 m."""
    _write(gait, path, ",")


def write_tsv_gait(gait: Gait, path: Path) -> None:
    """Write the same table with tabs."""
    _write(gait, path, "\t")


def _write(gait: Gait, path: Path, separator: str) -> None:
    names, parts = [_TIME, *_ANGLES], [gait.time[:, None], np.degrees(gait.q)]
    if gait.base is not None:
        names += _PELVIS
        parts.append(pose_values(gait.base))
    metadata = Metadata(gait.events, gait.periodic, gait.source)
    write_csv(path, _TITLE, metadata, names, np.hstack(parts), separator=separator)

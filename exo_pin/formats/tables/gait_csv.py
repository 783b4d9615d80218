"""Our own gait file: time, twelve angles in degrees and, where the pelvis moves, its pose."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.files import read_lines
from exo_pin.formats.reading import Reading
from exo_pin.formats.tables import mapped
from exo_pin.formats.tables.csv_table import read_csv, write_csv
from exo_pin.formats.tables.notes import Notes, read, to_gait
from exo_pin.formats.tables.pose_columns import pose_names, pose_values, read_poses
from exo_pin.gait import Gait

TIME = "time_s"
ANGLES = tuple(f"{joint}_deg" for joint in JOINTS)
TITLE = "A walk: joint angles [deg]; the pelvis's pose in the world [m, unit quaternion] where it moves."


PELVIS = pose_names("pelvis")


def read_gait(path: Path, reading: Reading) -> Gait:
    """Read a gait from our CSV, or from anybody's where a mapping or another preset names its columns.

    Raises:
        FormatError: If the file is not such a table, or its numbers are no walk; with file, line and reason.
        UnknownNameError: The mapping names no joint of ours, or there is no such preset.
    """
    if reading.mapping or reading.preset not in (None, "exo_pin"):
        return mapped.read_gait(path, reading)
    reading.refuse(path, "units", why="its columns end in _deg; map the columns of a foreign table")
    return _read(path, ",")


def read_tabs(path: Path, reading: Reading) -> Gait:
    """Read the same table with tabs between its columns; any other as `mapped.read_gait` does."""
    ours = not (reading.mapping or reading.units) and reading.preset in (None, "exo_pin")
    return _read(path, "\t") if ours and _has_our_names(path) else mapped.read_gait(path, reading)


def write_gait(gait: Gait, path: Path) -> None:
    """Write a gait so that `read_gait` brings back the same numbers within 1e-12 rad and 1e-12 m."""
    _write(gait, path, ",")


def write_tabs(gait: Gait, path: Path) -> None:
    """Write the same table with tabs between its columns."""
    _write(gait, path, "\t")


def _read(path: Path, separator: str) -> Gait:
    table, groups, comments = read_csv(path, (TIME, *ANGLES), {"pelvis": PELVIS}, separator=separator)
    base = read_poses(table, "pelvis") if groups else None
    return to_gait(path, table.times(TIME), table.angles(ANGLES), base, read(path, comments))


def _has_our_names(path: Path) -> bool:
    """Whether the header is ours, with no column that only somebody else knows."""
    header = next((line for line in read_lines(path) if line.strip() and not line.startswith("#")), "")
    names = {name.strip() for name in header.split("\t")}
    return {TIME, *ANGLES} <= names <= {TIME, *ANGLES, *PELVIS}


def _write(gait: Gait, path: Path, separator: str) -> None:
    names, parts = [TIME, *ANGLES], [gait.time[:, None], np.degrees(gait.q)]
    if gait.base is not None:
        names += PELVIS
        parts.append(pose_values(gait.base))
    notes = Notes(gait.events, gait.periodic, gait.source)
    write_csv(path, TITLE, notes, names, np.hstack(parts), separator=separator)

"""Our own gait file: time, twelve angles in degrees and, where the pelvis moves, its pose."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.formats import mapped
from exo_pin.formats.csvtable import read_csv, write_csv
from exo_pin.formats.notes import Notes, read, to_gait
from exo_pin.formats.posecolumns import pose_names, pose_values, read_poses
from exo_pin.formats.reading import Reading
from exo_pin.gait import Gait

TIME = "time_s"
ANGLES = tuple(f"{joint}_deg" for joint in JOINTS)
TITLE = "A walk: joint angles [deg]; the pelvis's pose in the world [m, unit quaternion] where it moves."


def read_gait(path: Path, reading: Reading) -> Gait:
    """Read a gait from our CSV, or from anybody's where a mapping or another preset names its columns.

    Raises:
        FormatError: If the file is not such a table, or its numbers are no walk; with file, line and reason.
        UnknownNameError: The mapping names no joint of ours, or there is no such preset.
    """
    if reading.mapping or reading.preset not in (None, "exo_pin"):
        return mapped.read_gait(path, reading)
    reading.refuse(path, "units", why="its columns end in _deg; map the columns of a foreign table")
    table, groups, comments = read_csv(path, (TIME, *ANGLES), {"pelvis": pose_names("pelvis")})
    notes = read(path, comments)
    base = read_poses(table, "pelvis") if groups else None
    return to_gait(path, table.times(TIME), table.angles(ANGLES), base, notes)


def write_gait(gait: Gait, path: Path) -> None:
    """Write a gait so that `read_gait` brings back the same numbers within 1e-12 rad and 1e-12 m."""
    names, parts = [TIME, *ANGLES], [gait.time[:, None], np.degrees(gait.q)]
    if gait.base is not None:
        names += pose_names("pelvis")
        parts.append(pose_values(gait.base))
    write_csv(path, TITLE, Notes(gait.events, gait.periodic, gait.source), names, np.hstack(parts))

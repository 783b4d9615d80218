"""The pelvis's motion as comment lines: for a message that has joints only, and must stay one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError
from exo_pin.formats.tables.notes import Note
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.formats.tables.pose_columns import pose_names, pose_values, read_poses

KEY = "pelvis"
"""`# pelvis: x y z qw qx qy qz` [m, unit quaternion], a line for every point."""


def to_lines(base: Array | None) -> list[str]:
    """The comment lines that `read_base` turns back into the same poses `(n, 4, 4)`."""
    rows = [] if base is None else pose_values(base).tolist()
    return [f"# {KEY}: {' '.join(map(repr, row))}" for row in rows]


def read_base(path: Path, notes: Sequence[Note], n: int) -> Array | None:
    """`(n, 4, 4)` T_world_pelvis, or None where no line tells it.

    Raises:
        FormatError: The lines are not n, or hold no poses.
    """
    said = [note for note in notes if note.key == KEY]
    if not said:
        return None
    if len(said) != n:
        raise FormatError(path, f"{len(said)} lines '# {KEY}: ...' for {n} points", line=said[0].line)
    values = np.array([_numbers(path, note) for note in said])
    return read_poses(NumericTable(path, pose_names(KEY), values, [note.line for note in said]), KEY)


def _numbers(path: Path, note: Note) -> list[float]:
    try:
        numbers = [float(word) for word in note.value.split()]
    except ValueError:
        numbers = []
    if len(numbers) != 7 or not np.isfinite(numbers).all():
        raise FormatError(path, f"{KEY}: expected x y z [m] and qw qx qy qz, seven numbers", line=note.line)
    return numbers

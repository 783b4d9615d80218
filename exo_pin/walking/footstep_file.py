"""Footsteps in a table: a CSV file of where the feet are set, one row a step."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.errors import FormatError, naming_file
from exo_pin.files import read_lines, write_text
from exo_pin.safe import plain_numbers
from exo_pin.walking.footsteps import Footstep, Footsteps

FOOTSTEP_COLUMNS = ("side", "x_m", "y_m", "heading_deg")
"""Of the table; the first two rows are where the left and the right foot stand before the first step."""


def load_footsteps(
    path: str | Path, *, step_time: float = 0.8, double_support: float = 0.2, clearance: float = 0.05
) -> Footsteps:
    """Read footsteps: columns `side,x_m,y_m,heading_deg`; lines that begin with # are comments.

    The first two rows are where both feet stand before the first step, each further row is a step.

    Args:
        path: The file.
        step_time: From the landing of one foot to that of the other [s].
        double_support: Share of it with both feet on the ground.
        clearance: Height of the swinging foot's ball over the ground in mid-swing [m].

    Raises:
        FormatError: The file is no such table; with line and reason.
        GaitError: A number is not accepted.
    """
    path = Path(path)
    rows = [
        (k, line) for k, line in enumerate(read_lines(path), 1) if line.strip() and not line.startswith("#")
    ]
    if not rows:
        raise FormatError(
            path, f"empty; expected a header line {','.join(FOOTSTEP_COLUMNS)} and a row for each step"
        )
    _check_header(path, *rows[0])
    feet = [_footstep(path, k, line) for k, line in rows[1:]]
    if len(feet) < 3:
        raise FormatError(path, f"{len(feet)} rows; expected two feet that stand, then at least one step")
    start = sorted(feet[:2], key=lambda foot: SIDES.index(foot.side))
    with naming_file(path):
        return Footsteps((start[0], start[1]), tuple(feet[2:]), step_time, double_support, clearance)


def save_footsteps(walk: Footsteps, path: str | Path) -> None:
    """Write footsteps so that `load_footsteps` reads them; times are not in the table.

    Raises:
        FormatError: The file cannot be written.
    """
    rows = [
        f"{foot.side},{foot.x!r},{foot.y!r},{math.degrees(foot.heading)!r}"
        for foot in (*walk.start, *walk.steps)
    ]
    title = "# Footsteps: the point of each sole under the ankle. Two feet that stand, then a row a step."
    write_text(Path(path), "\n".join([title, ",".join(FOOTSTEP_COLUMNS), *rows, ""]))


def _check_header(path: Path, number: int, line: str) -> None:
    names = [name.strip() for name in line.split(",")]
    if tuple(names) != FOOTSTEP_COLUMNS:
        raise FormatError(path, f"its header is not {','.join(FOOTSTEP_COLUMNS)}", line=number)


def _footstep(path: Path, number: int, line: str) -> Footstep:
    cells = [cell.strip() for cell in next(csv.reader([line]))]
    if len(cells) != len(FOOTSTEP_COLUMNS):
        raise FormatError(path, f"{len(cells)} cells; expected {len(FOOTSTEP_COLUMNS)}", line=number)
    side: Side | None = next((side for side in SIDES if side == cells[0]), None)
    if side is None:
        raise FormatError(path, f"side is {cells[0][:40]!r}; expected left or right", line=number)
    values = []
    for name, cell in zip(FOOTSTEP_COLUMNS[1:], cells[1:], strict=True):
        try:
            values.append(plain_numbers.number(cell))
        except ValueError:
            raise FormatError(path, f"{name} is {cell[:40]!r}; expected a number", line=number) from None
    with naming_file(path, line=number):
        return Footstep(side, values[0], values[1], math.radians(values[2]))

"""The table of a study as CSV: one row for each walk, body, device, condition and kind of motion."""

from __future__ import annotations

import csv
import dataclasses
import hashlib
import io
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, get_type_hints

from exo_pin.anatomy.names import PassiveJoints, PelvisMotion, Sex
from exo_pin.errors import FormatError
from exo_pin.files import read_text, write_text
from exo_pin.gait.phases import PHASES
from exo_pin.safe.spreadsheet_cells import marked, unmarked

MotionKind = Literal["best", "copy"]
"""The least-squares best towards the recorded soles, or the plain copy of the joints."""

MOTIONS: tuple[MotionKind, ...] = ("best", "copy")
"""The two rows of every device on every walk."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """What one device loses of one walk on one body; the unit stands at the end of a name.

    Attributes:
        gait: Name of the speed, or path of the recording within its folder.
        source: Of the walk's numbers.
        samples: Of the walk.
        duration_s: Of the walk; a periodic walk's stride time.
        stature_m: Of the body.
        mass_kg: Of the body, without the device.
        sex: Whose average segment masses the body has.
        device: Name of the device.
        motors: Number of its motors.
        pelvis: `"recorded"`: it moves as the walker's; `"device"`: as the device holds it.
        passive: Passive joints: `"held"` or `"released"`.
        motion: `"best"`: the least-squares best towards the recorded soles; `"copy"`: the plain copy.
        sole_rms_mm: Distance of the soles' corners from the recorded ones, root mean square.
        sole_max_mm: The same, largest (root mean square of the four corners of a foot).
        foot_rms_mm: Distance of the foot frames, root mean square.
        foot_max_mm: The same, largest.
        foot_rms_deg: Angle between the feet, root mean square.
        foot_max_deg: The same, largest.
        loading_response_rms_mm: The sole's error in this phase of the foot's cycle; NaN without events.
        mid_stance_rms_mm: Likewise.
        terminal_stance_rms_mm: Likewise.
        pre_swing_rms_mm: Likewise.
        initial_swing_rms_mm: Likewise.
        mid_swing_rms_mm: Likewise.
        terminal_swing_rms_mm: Likewise.
        step_width_mm: Of the device, mean at heel strikes; NaN without events.
        step_width_lost_mm: Recorded minus the device's.
        clearance_mm: Least height of the swinging sole over the standing one in mid swing.
        clearance_lost_mm: Recorded minus the device's.
        hip_change_deg: Largest difference of hip flexion from the required angle.
        knee_change_deg: The same of knee flexion.
        com_rms_mm: Distance of the centre of mass from the recorded walk's, root mean square.
        doubts: The reasons of `exo_pin.gait.Plausibility` against the walk; empty for a plausible one.
        version: Of exo_pin.
        inputs: Fingerprint of exo_pin's code, walk, body, device and conditions: equal inputs, equal rows.
    """

    gait: str
    source: str
    samples: int
    duration_s: float
    stature_m: float
    mass_kg: float
    sex: Sex
    device: str
    motors: int
    pelvis: PelvisMotion
    passive: PassiveJoints
    motion: MotionKind
    sole_rms_mm: float
    sole_max_mm: float
    foot_rms_mm: float
    foot_max_mm: float
    foot_rms_deg: float
    foot_max_deg: float
    loading_response_rms_mm: float
    mid_stance_rms_mm: float
    terminal_stance_rms_mm: float
    pre_swing_rms_mm: float
    initial_swing_rms_mm: float
    mid_swing_rms_mm: float
    terminal_swing_rms_mm: float
    step_width_mm: float
    step_width_lost_mm: float
    clearance_mm: float
    clearance_lost_mm: float
    hip_change_deg: float
    knee_change_deg: float
    com_rms_mm: float
    doubts: str
    version: str
    inputs: str

    @property
    def sole_rms_by_phase(self) -> dict[str, float]:
        """The sole's error in each phase of the foot's cycle [mm]; NaN without events."""
        values = (
            self.loading_response_rms_mm,
            self.mid_stance_rms_mm,
            self.terminal_stance_rms_mm,
            self.pre_swing_rms_mm,
            self.initial_swing_rms_mm,
            self.mid_swing_rms_mm,
            self.terminal_swing_rms_mm,
        )
        return dict(zip(PHASES, values, strict=True))


_FIELDS = tuple(field.name for field in dataclasses.fields(Row))

TABLE_COLUMNS = (*_FIELDS, "checksum")
"""Names of the columns, in order; the last one is of the other cells, and shows that none was edited."""

_DIGITS = 16
"""Hexadecimal digits of a checksum (SHA-256)."""

_READERS: Mapping[type, Callable[[str], Any]] = {
    int: int,
    float: lambda cell: float(cell) if cell else math.nan,
}
_TYPES = get_type_hints(Row)
_COLUMN_READERS = tuple(_READERS.get(_TYPES[name], str) for name in _FIELDS)


def phase_column(phase: str) -> str:
    """The column of a phase of the cycle (`exo_pin.compare.PHASES`)."""
    return f"{phase.replace(' ', '_').replace('-', '_')}_rms_mm"


def text(rows: Iterable[Row], *, heading: bool = True) -> str:
    """Rows as CSV; numbers in the shortest form that reads back as the same number, an empty cell for NaN."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    if heading:
        writer.writerow(TABLE_COLUMNS)
    for row in rows:
        cells = [_cell(value) for value in dataclasses.astuple(row)]
        writer.writerow([*cells, _checksum(cells)])
    return file.getvalue()


def save(rows: Iterable[Row], path: str | Path) -> None:
    """Write rows as CSV, all or nothing.

    Raises:
        FormatError: The file cannot be written.
    """
    write_text(path, text(rows))


def load(path: str | Path) -> list[Row]:
    """Read rows that `save` has written.

    Raises:
        FormatError: The file cannot be read, is no table of a study of this version, or a row was edited.
    """
    rows, unusable = rows_and_unusable_lines(path, read_text(path))
    if unusable:
        why = f"not a row of a study as it was written: {len(TABLE_COLUMNS)} cells, the last their checksum"
        raise FormatError(path, why, line=unusable[0])
    return rows


def rows_and_unusable_lines(path: str | Path, content: str) -> tuple[list[Row], list[int]]:
    """The rows of a table, and the numbers of its lines that are none: edited or damaged.

    Args:
        path: The file, for messages.
        content: Its text; empty is a table without rows.

    Raises:
        FormatError: It is no table of a study, or one of another version.
    """
    heading, *lines = content.split("\n")
    if content and _cells(heading) != list(TABLE_COLUMNS):
        check_heading(path, content)
        why = (
            "the table of a study of another version (its columns differ); choose another file, or --restart"
        )
        raise FormatError(path, why, line=1)
    found = {k: _row(line) for k, line in enumerate(lines, 2) if line.strip()}
    return [row for row in found.values() if row], [k for k, row in found.items() if not row]


def check_heading(path: str | Path, content: str) -> None:
    """Raise `FormatError` for a text that is no table of a study of any version."""
    if content and not set(_cells(content.partition("\n")[0]) or []) >= _ALWAYS:
        raise FormatError(path, "not the table of a study (its columns differ)", line=1)


_ALWAYS = {"gait", "device", "motion", "sole_rms_mm", "version", "inputs"}
"""Columns of every table of a study, whatever its version."""


def _row(line: str) -> Row | None:
    """The row of a line (each row is one), or None where its checksum is wrong."""
    cells = _cells(line)
    if cells is None or len(cells) != len(TABLE_COLUMNS) or _checksum(cells[:-1]) != cells[-1]:
        return None
    try:
        values = [read(unmarked(cell)) for read, cell in zip(_COLUMN_READERS, cells[:-1], strict=True)]
    except ValueError:
        return None
    return Row(**dict(zip(_FIELDS, values, strict=True)))


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

"""The table of a study as CSV: one row for each walk, body, device, condition and kind of motion."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from exo_pin.anatomy.names import PassiveJoints, PelvisMotion, Sex
from exo_pin.gait.phases import PHASES
from exo_pin.study.record_table import RecordTable

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


TABLE = RecordTable(Row, {"gait", "device", "motion", "sole_rms_mm", "version", "inputs"})
"""The table of such rows."""

TABLE_COLUMNS = TABLE.columns
"""Names of the columns, in order; the last one is of the other cells, and shows that none was edited."""


def phase_column(phase: str) -> str:
    """The column of a phase of the cycle (`exo_pin.compare.PHASES`)."""
    return f"{phase.replace(' ', '_').replace('-', '_')}_rms_mm"


def save(rows: Iterable[Row], path: str | Path) -> None:
    """Write rows as CSV, all or nothing.

    Raises:
        FormatError: The file cannot be written.
    """
    TABLE.save(rows, path)


def load(path: str | Path) -> list[Row]:
    """Read rows that `save` has written.

    Raises:
        FormatError: The file cannot be read, is no table of a study of this version, or a row was edited.
    """
    return TABLE.load(path)

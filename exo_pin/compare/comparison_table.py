"""Comparisons as tables: the same rows for the terminal, Markdown and CSV."""

from __future__ import annotations

import math
from collections.abc import Sequence

from exo_pin.compare.comparison import Comparison
from exo_pin.compare.joint_choices import JointChoices
from exo_pin.compare.loss import Loss
from exo_pin.compare.motor_demand import MotorDemand
from exo_pin.safe import spreadsheet_cells

LOSS_COLUMNS = (
    "device",
    "motors",
    "sole rms mm",
    "sole max mm",
    "foot rms mm",
    "foot rms deg",
    "copy rms mm",
    "width lost mm",
    "clearance lost mm",
    "knee change deg",
    "com rms mm",
)
"""Headings. Sole: of the soles' corners; foot: of the foot frames; copy: the sole in the plain copy."""

MOTOR_COLUMNS = ("device", "torque %", "hardest joint", "peak N m", "limit N m", "peak power W", "too weak")
"""Headings. Torque: the largest part of a motor's effort that is used; power: the largest of any motor."""

PARETO_COLUMNS = ("motors", "sole rms mm", "driven, each leg")
MOVEMENT_COLUMNS = ("movement", "locked alone: sole rms mm", "added as", "then left mm")


def rows(comparison: Comparison) -> list[list[str]]:
    """One row of text per device, least loss first."""
    return [_row(*pair) for pair in zip(comparison.best, comparison.projected, strict=True)]


def phase_rows(comparison: Comparison) -> list[list[str]]:
    """By device: the sole's error in each phase of the foot's cycle [mm]."""
    return [
        [loss.device.name, *(_fixed(1e3 * value) for value in loss.by_phase.values())]
        for loss in comparison.best
    ]


def motor_rows(comparison: Comparison) -> list[list[str]]:
    """Torque and power of each device's motors, as `MOTOR_COLUMNS`; none without torques."""
    return [_motor_row(motor) for motor in comparison.motors or ()]


def _motor_row(motor: MotorDemand) -> list[str]:
    hardest = motor.hardest
    if hardest is None or hardest.torque is None:
        return [motor.device.name, *["-"] * (len(MOTOR_COLUMNS) - 1)]
    torque = hardest.torque
    numbers = [f"{x:.0f}" for x in (torque.peak, torque.available, motor.peak_power)]
    words = "; ".join(motor.failures) or "none"
    return [motor.device.name, f"{100 * torque.use:.0f}", hardest.joint.replace("_", " "), *numbers, words]


def front_rows(choices: JointChoices) -> list[list[str]]:
    """The best choice of joints for each number of motors, as `PARETO_COLUMNS`."""
    return [
        [str(motors), _fixed(1e3 * loss), ", ".join(movements) or "none"]
        for motors, movements, loss in choices.pareto
    ]


def single_rows(choices: JointChoices) -> list[list[str]]:
    """A row per movement, locked alone or added to others, as `MOVEMENT_COLUMNS`; the largest loss first."""
    places = {movement: (k, left) for k, (movement, left) in enumerate(choices.add_one_in, 1)}
    return [
        [m, _fixed(1e3 * loss), f"{places[m][0]}.", _fixed(1e3 * places[m][1])]
        for m, loss in choices.leave_one_out.items()
    ]


def markdown(columns: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    """A Markdown table of rows of text under headings."""
    table = [columns, ["---", *["---:"] * (len(columns) - 1)], *lines]
    return "\n".join("| " + " | ".join(line) + " |" for line in table) + "\n"


def csv(columns: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    """A CSV table; units stand at the end of the names, `_` between words."""
    return spreadsheet_cells.table([[name.replace(" ", "_") for name in columns], *lines])


def conditions(comparison: Comparison) -> str:
    """The walk, the body and the conditions of a comparison, in a sentence."""
    walk = comparison.walk
    body = walk.robot.body
    who = "" if body is None else f"body {body.stature:g} m, {body.mass:g} kg; "
    pelvis = {
        "recorded": "every pelvis moves as recorded",
        "device": "every pelvis as its device holds it (upright; slides as they suit the feet)",
    }[comparison.conditions.pelvis]
    return (
        f"{walk.gait.source or 'gait'}: {len(walk.gait)} samples, {walk.gait.duration:.2f} s; {who}{pelvis}; "
        f"passive joints {comparison.conditions.passive}; the default joint limits and speeds or the "
        "device's own are kept."
    )


def _row(best: Loss, copied: Loss) -> list[str]:
    values = [
        1e3 * best.sole_spread.rms,
        1e3 * best.sole_spread.max,
        1e3 * best.position_spread.rms,
        math.degrees(best.rotation_spread.rms),
        1e3 * copied.rms,
        1e3 * best.step_width_lost,
        1e3 * best.clearance_lost,
        math.degrees(best.angle_change["knee_flexion"]),
        1e3 * best.com_error,
    ]
    return [best.device.name, str(best.device.motors), *map(_fixed, values)]


def _fixed(value: float) -> str:
    """One decimal, no minus before a zero; `-` where the gait has no events."""
    return "-" if value != value else f"{round(value, 1) + 0.0:.1f}"

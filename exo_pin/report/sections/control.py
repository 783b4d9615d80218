"""Control: a simulated run of the walk by torques, its verdict, tracking, and what each motor does."""

from __future__ import annotations

import math
from dataclasses import replace

from exo_pin.anatomy import JOINTS, MOVEMENTS, SIDES
from exo_pin.anatomy.names import Movement
from exo_pin.gait import leg_cycles
from exo_pin.report.document.blocks import Block, Figure, Paragraph, Section, Table, Tiles
from exo_pin.report.draw.chart import draw, key
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.sections.angles import joint_charts
from exo_pin.simulation import Run, walked, wanted

_SHOWN: tuple[Movement, ...] = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
_SIZE = (280.0, 150.0)  # [px]
_RIGID = (
    "The soles are rigid: the first peak of the ground reaction is about 40 % higher than people's. Torques "
    "are those of motors at the joints, not forces at the cuffs."
)


def control(run: Run) -> Section:
    """The chapter.

    Args:
        run: What was simulated.
    """
    numbers, verdict = run.numbers, run.verdict
    tiles = (
        ("simulated by torques", verdict.word, verdict.word == "walks"),
        ("tracking, rms", _shown(numbers.tracking_rms_deg, "deg"), None),
        ("motors' share of all torques", _shown(100 * numbers.motor_share, "%"), None),
        ("weight on the legs", _shown(numbers.vertical_force_mean_bw, "weights", 2), None),
    )
    patient = "no patient: the motors do it all" if run.patient is None else f"patient {run.patient.name}"
    held = f"support {run.support.name}, body-weight support {run.body_weight_support:g}"
    words = f"{verdict.word}: {verdict.why}. Controller {run.controller}; {patient}; {held}."
    balance = f"Energy balance {run.energy_balance_percent:.2g} %. {_RIGID}"
    blocks: list[Block] = [Tiles(tiles), Paragraph(words), *_curves(run), _motors(run)]
    return Section("Control", (*blocks, Paragraph(balance, "note")))


def _curves(run: Run) -> list[Block]:
    """Simulated (solid) and planned (dashed) flexion over the cycle."""
    found, plan = leg_cycles(walked(run)), leg_cycles(wanted(run))
    if not found:
        return [Paragraph("The run has no whole cycle: no curves.")]
    made = dict(zip(MOVEMENTS, joint_charts(found, dashed=plan, other="to follow"), strict=True))
    charts = [replace(made[name], legend=False, width=_SIZE[0], height=_SIZE[1]) for name in _SHOWN]
    drawings = [Drawing(f"control_{name}", x.title, draw(x)) for name, x in zip(_SHOWN, charts, strict=True)]
    legend = Drawing("control_key", "Key of the curves", key(charts))
    caption = "Solid: simulated; dashed: the walk to follow."
    return [Figure(tuple(drawings), caption), Figure((legend,), columns=1)]


def _motors(run: Run) -> Table:
    found = run.numbers
    rows = [
        [
            name,
            f"{found.peak_torque[name]:.1f}",
            f"{found.motor_rms[name]:.1f}",
            f"{found.saturated.get(name, 0.0):.1f}",
        ]
        for name in JOINTS
        if name in found.motor_rms
    ]
    half = -(-len(rows) // len(SIDES))
    both = [[*a, *b] for a, b in zip(rows[:half], [*rows[half:], *[["", "", "", ""]] * half], strict=False)]
    heads = ("motor", "peak N m", "rms N m", "at its limit %")
    return Table((*heads, *heads), both, "Motors, on the cycles that count")


def _shown(value: float, unit: str, digits: int = 1) -> str:
    return "-" if math.isnan(value) else f"{value:.{digits}f} {unit}"

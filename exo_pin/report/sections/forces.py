"""Forces and motors: ground reaction, torques and powers over the cycle, and whether the drives bear them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Movement, Side
from exo_pin.arrays import Array
from exo_pin.clinic.clinical_cycles import PERCENT
from exo_pin.dynamics import Dynamics
from exo_pin.gait import Gait
from exo_pin.gait.leg_cycles import cycle_times
from exo_pin.report.document.blocks import Figure, Paragraph, Section, Table
from exo_pin.report.draw import svg, walk_charts
from exo_pin.report.draw.band_layers import MOST_LINES
from exo_pin.report.draw.chart import Chart, Curve, draw, key
from exo_pin.report.draw.drawing import Drawing
from exo_pin.sizing import JointSizing, Sizing

TITLE = "Forces and motors"
_SHOWN: tuple[Movement, ...] = ("hip_flexion", "hip_adduction", "knee_flexion", "ankle_dorsiflexion")
_SIZE = (280.0, 150.0)  # [px]


class Loads(NamedTuple):
    """What the chapter is made of.

    Attributes:
        gait: The walk whose forces they are, with its events.
        dynamics: Its torques.
        sizing: Its loads against the device's drives.
    """

    gait: Gait
    dynamics: Dynamics
    sizing: Sizing


def forces(loads: Loads) -> Section:
    """The chapter.

    Args:
        loads: Of the walk.
    """
    found = loads.dynamics
    charts = {name: chart for name, chart in _charts(loads).items() if chart.curves}
    drawings = tuple(Drawing(name, chart.title, draw(chart)) for name, chart in charts.items())
    legend = Drawing("forces_key", "Key of the curves", key(list(charts.values())))
    figures = (Figure(drawings, _words(found), columns=4), Figure((legend,), columns=1)) if charts else ()
    none = () if charts else (Paragraph("No foot has a whole cycle with a known ground reaction."),)
    return Section(TITLE, (*figures, *none, *_sized(loads.sizing)), "sheet")


def not_known(why: str) -> Section:
    """The chapter where there are no torques, with the reason."""
    return Section(TITLE, (Paragraph(f"No torques: {why}"),), "sheet")


def _words(found: Dynamics) -> str:
    measured = found.reaction == "measured"
    how = "measured by force plates" if measured else "predicted, an assumption: no number here is measured"
    residual = found.residual.facts()
    left = f" Residual {residual['force_rms_N']:.0f} N, {residual['moment_rms_Nm']:.0f} N m rms." * measured
    frames = f" {int(found.valid.sum())} of {len(found.valid)} frames are known." if measured else ""
    return (
        f"Ground reaction {how}.{frames} Torques by inverse dynamics, positive the way the joint is named, "
        f"per kg of {found.mass:.1f} kg ({found.masses}: whose masses move); BW: its weight.{left}"
    )


def _charts(loads: Loads) -> dict[str, Chart]:
    found = loads.dynamics
    weight, word = found.weight_force, found.reaction
    charts = {
        "ground_up": _chart(loads, f"Ground force up, {word} [BW]", found.ground.force[:, :, 2] / weight)
    }
    forward = _forward(found)
    if forward is not None:
        title = f"Forward, {word} [BW]"
        charts["ground_forward"] = _chart(loads, title, forward / weight)
    for movement in _SHOWN:
        columns = [JOINTS.index(f"{side}_{movement}") for side in SIDES]
        name = walk_charts.MOVEMENT_TITLES[movement].removesuffix(" [deg]")
        torque, power = found.torque[:, columns] / found.mass, found.power[:, columns] / found.mass
        charts[f"torque_{movement}"] = _chart(loads, f"{name} torque [N m/kg]", torque)
        charts[f"power_{movement}"] = _chart(loads, f"{name} power [W/kg]", power)
    return {name: charts[name] for name in sorted(charts, key=_place)}


def _place(name: str) -> int:
    """Torques first, then powers, then the ground reaction."""
    return ("torque", "power", "ground").index(name.partition("_")[0])


def _forward(found: Dynamics) -> Array | None:
    """`(n, 2)` force along the pelvis's mean heading [N]; None where it has none."""
    x, y = found.motion.base[:, :2, 0].mean(axis=0)
    length = float(np.hypot(x, y))
    if length < 0.5:
        return None
    return np.asarray((found.ground.force[:, :, :2] @ np.array([x, y])) / length)


def _chart(loads: Loads, title: str, values: Array) -> Chart:
    """A series `(n, 2)` of both sides over their own cycles."""
    curves: list[Curve] = []
    for column, side in enumerate(SIDES):
        curves += _curves(_cycles(loads, side, values[:, column]), side)
    return Chart(
        title=title,
        x_label="% of the side's gait cycle",
        curves=tuple(curves),
        x_range=(0, 100),
        least=0.2,
        legend=False,
        width=_SIZE[0],
        height=_SIZE[1],
    )


def _cycles(loads: Loads, side: Side, values: Array) -> Array:
    """`(k, 101)` of the cycles in which some of it is known; NaN where it is not."""
    gait = loads.gait
    times = cycle_times(gait, side)
    period = gait.duration if gait.periodic else None
    rows = np.interp(times, loads.dynamics.time, values, period=period)
    return np.asarray(rows[np.isfinite(rows).any(axis=1)])


def _curves(rows: Array, side: Side) -> Sequence[Curve]:
    if not len(rows):
        return ()
    colour = svg.SIDE_COLOURS[side]
    thin = [Curve(PERCENT, row, colour, "single cycles", None, 0.6, 0.5) for row in rows[:MOST_LINES]]
    known = np.isfinite(rows).any(axis=0)
    mean = np.full(len(PERCENT), np.nan)
    mean[known] = np.nanmean(rows[:, known], axis=0)
    return (*(thin if len(rows) > 1 else ()), Curve(PERCENT, mean, colour, side, None, 1.9))


def _sized(found: Sizing) -> tuple[Table | Paragraph, ...]:
    """Loads of the drives and the verdict."""
    wrong = [joint for joint in found.joints if not joint.fits]
    verdict = "Every drive bears its joint" if not wrong else f"Too weak: {'; '.join(map(_why, wrong))}"
    heads = ("joint", "peak N m", "rms N m", "peak rad/s", "peak W", "J a stride", "torque %", "speed %", "")
    table = Table(heads, [_row(joint) for joint in found.joints], "Loads of the drives, no person helping")
    words = f"{verdict}. Ground reaction {found.reaction}. Limit: {found.limit}."
    if found.passive:
        words += f" Passive joints are not sized: {', '.join(found.passive)}."
    return (Paragraph(words), table) if found.joints else (Paragraph("The device drives no joint."),)


def _row(joint: JointSizing) -> list[str]:
    load = joint.load
    energy = load.energy()
    values = (load.peak_torque, load.rms_torque, load.peak_speed, load.peak_power)
    shares = (f"{100 * joint.torque_use:.0f}", f"{100 * joint.speed_use:.0f}")
    return [
        load.joint,
        *(f"{value:.1f}" for value in values),
        "-" if not np.isfinite(energy) else f"{energy:.1f}",
        *shares,
        "bears it" if joint.fits else "too weak",
    ]


def _why(joint: JointSizing) -> str:
    load = joint.load
    words = load.joint.replace("_", " ")
    if joint.torque_use > 1:
        words += f", {load.peak_torque:.0f} of {joint.effort:.0f} N m"
    if joint.speed_use > 1:
        words += f", {load.peak_speed:.1f} of {joint.velocity:.1f} rad/s"
    return words

"""What charts over time share: titles, curves that close, shaded stance, a chart for every movement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.report.document.blocks import Drawing
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart import Chart, Curve, Level, Span, draw

LIMIT = "#7a3fb0"
"""The colour of a limit: neither leg's."""

TITLES = {
    "hip_flexion": "Hip flexion [deg]",
    "hip_adduction": "Hip adduction [deg]",
    "hip_rotation": "Hip internal rotation [deg]",
    "knee_flexion": "Knee flexion [deg]",
    "ankle_dorsiflexion": "Ankle dorsiflexion [deg]",
    "ankle_inversion": "Ankle inversion [deg]",
}


def stances(gait: Gait) -> tuple[Span, ...]:
    """Shaded stance of both feet over time, in two strips; none where there are no events."""
    spans = []
    for lane, side in enumerate(SIDES):
        for start, end in stance_intervals(gait, side):
            spans.append(Span(start, end, svg.COLOURS[side], f"{side} stance", lane))
    return tuple(spans)


def stance_intervals(gait: Gait, side: Side) -> list[tuple[float, float]]:
    """From, to [s] of a foot's contacts within the walk, by its events; cut at the walk's ends."""
    start = float(gait.time[0])
    end = start + gait.duration
    mine = [(e.time, e.kind) for e in gait.events if e.side == side]
    if not mine:
        return []
    if gait.periodic:
        mine = [(t + k * gait.duration, kind) for k in (-1, 0, 1) for t, kind in mine]
    else:  # what the first event ends was there before; what the last begins goes on
        mine = [(start, "heel_strike")] * (mine[0][1] == "toe_off") + mine
        mine += [(end, "toe_off")] * (mine[-1][1] == "heel_strike")
    spans = [
        (max(a, start), min(b, end))
        for (a, first), (b, second) in pairwise(mine)
        if (first, second) == ("heel_strike", "toe_off")
    ]
    return [(a, b) for a, b in spans if b > a]


def over_time(gait: Gait, values: Array) -> tuple[Array, Array]:
    """Time and samples `(n, ...)`; a periodic walk's first sample is shown at its end again."""
    if not gait.periodic:
        return gait.time, values
    return np.append(gait.time, gait.time[0] + gait.duration), np.concatenate([values, values[:1]])


def by_movement(
    gait: Gait,
    values: Array,
    names: Sequence[str],
    what: str,
    unit: str,
    *,
    limits: Mapping[str, float],
    limit: str,
    least: float = 1.0,
) -> tuple[Drawing, ...]:
    """A joint quantity `(n, J)` over time, by movement, both legs.

    Args:
        gait: Its time and events.
        values: In `unit`; NaN makes a gap.
        names: The joints of the columns.
        what: e.g. `"velocity"`.
        unit: Of the values.
        limits: Joint -> largest size of the quantity; infinite or missing: none.
        limit: What the limit is, for the legend.
        least: Smallest extent of the axis.
    """
    drawings = []
    time, closed = over_time(gait, values)
    for movement in MOVEMENTS:
        mine = [f"{side}_{movement}" for side in SIDES if f"{side}_{movement}" in names]
        curves = [
            Curve(time, closed[:, names.index(j)], svg.COLOURS[j.split("_")[0]], j.split("_")[0])
            for j in mine
        ]
        ends = {limits[joint] for joint in mine if joint in limits}
        title = f"{TITLES[movement].removesuffix(' [deg]')} {what} [{unit}]"
        chart = Chart(
            title=title,
            x_label="time [s]",
            curves=tuple(curves),
            spans=stances(gait),
            levels=tuple(Level(y, LIMIT, f"{limit} ±{end:g}", True) for end in ends for y in (-end, end)),
            least=least,
            height=170,
        )
        if mine:
            drawings.append(Drawing(f"{what}_{movement}", title, draw(chart)))
    return tuple(drawings)

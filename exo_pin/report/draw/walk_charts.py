"""Charts of a walk over time: a chart for every movement, with shaded stance and closed cycles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.anatomy.names import Movement
from exo_pin.arrays import Array
from exo_pin.gait import Gait, stance_times
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart import Chart, Curve, Level, Span, draw
from exo_pin.report.draw.drawing import Drawing

LIMIT_COLOUR = "#7a3fb0"
"""Of a limit: the colour of neither leg."""

MOVEMENT_TITLES: dict[Movement, str] = {
    "hip_flexion": "Hip flexion [deg]",
    "hip_adduction": "Hip adduction [deg]",
    "hip_rotation": "Hip internal rotation [deg]",
    "knee_flexion": "Knee flexion [deg]",
    "ankle_dorsiflexion": "Ankle dorsiflexion [deg]",
    "ankle_inversion": "Ankle inversion [deg]",
}


def stance_spans(gait: Gait) -> tuple[Span, ...]:
    """Shaded stance of both feet over time, in two strips; empty for a walk without events."""
    first = float(gait.time[0])
    return tuple(
        Span(first + start, first + end, svg.SIDE_COLOURS[side], f"{side} stance", lane)
        for lane, side in enumerate(SIDES)
        for start, end in stance_times(gait, side)
    )


def over_time(gait: Gait, values: Array) -> tuple[Array, Array]:
    """Time and samples `(n, ...)`; those of a periodic walk with the first sample repeated at the end."""
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
        gait: The walk: its time and events.
        values: `(n, J)` in `unit`; NaN makes a gap.
        names: The joints of the columns.
        what: e.g. `"velocity"`.
        unit: Of the values.
        limits: Joint -> largest size of the quantity; infinite or missing: none.
        limit: What the limit is, for the legend.
        least: Smallest extent of the y axis.
    """
    drawings = []
    time, closed = over_time(gait, values)
    for movement in MOVEMENTS:
        mine = [f"{side}_{movement}" for side in SIDES if f"{side}_{movement}" in names]
        curves = [
            Curve(time, closed[:, names.index(f"{side}_{movement}")], svg.SIDE_COLOURS[side], side)
            for side in SIDES
            if f"{side}_{movement}" in names
        ]
        ends = {limits[joint] for joint in mine if joint in limits}
        title = f"{MOVEMENT_TITLES[movement].removesuffix(' [deg]')} {what} [{unit}]"
        chart = Chart(
            title=title,
            x_label="time [s]",
            curves=tuple(curves),
            spans=stance_spans(gait),
            levels=tuple(
                Level(y, LIMIT_COLOUR, f"{limit} ±{end:g}", True) for end in ends for y in (-end, end)
            ),
            least=least,
            height=170,
        )
        if mine:
            drawings.append(Drawing(f"{what}_{movement}", title, draw(chart)))
    return tuple(drawings)

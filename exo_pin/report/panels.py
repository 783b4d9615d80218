"""Charts of a walk: joint curves, ranges, rates, foot paths, centre of mass, contact."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.gait import Gait, normative_gait, normative_sd
from exo_pin.report import svg
from exo_pin.report.axis import ticks
from exo_pin.report.blocks import Drawing
from exo_pin.report.chart import Band, Chart, Curve, Level, Span, draw
from exo_pin.report.cycle import Leg

Array = npt.NDArray[np.float64]

TITLES = {
    "hip_flexion": "Hip flexion [deg]",
    "hip_adduction": "Hip adduction [deg]",
    "hip_rotation": "Hip internal rotation [deg]",
    "knee_flexion": "Knee flexion [deg]",
    "ankle_dorsiflexion": "Ankle dorsiflexion [deg]",
    "ankle_inversion": "Ankle inversion [deg]",
}
BAND_SOURCE = (
    "Schwartz 2008, {speed}: mean and 1 standard deviation of 51 to 82 children a speed; ankle inversion: "
    "Oxford foot model. Its hip flexion is measured against a pelvis tilted forward by 10 to 18 deg, so "
    "compare shapes and ranges, and levels with care; hip rotation and ankle inversion are weak channels."
)
_LEAST = 20.0  # [deg] smallest extent of an angle's axis


def joints(
    found: Sequence[Leg], *, speed: str | None, limits: dict[str, tuple[float, float]]
) -> tuple[Drawing, ...]:
    """Six charts over the cycle, both legs in each, before the normative band.

    Args:
        found: The legs' curves.
        speed: Which normative band to draw; None: none.
        limits: By movement, the joint's range [rad].
    """
    return tuple(_joint(k, movement, found, speed, limits) for k, movement in enumerate(MOVEMENTS))


def _joint(
    k: int, movement: str, found: Sequence[Leg], speed: str | None, limits: dict[str, tuple[float, float]]
) -> Drawing:
    bands, curves, spans = [], [], []
    if speed is not None:
        percent, mean, sd = normal(speed, k)
        bands.append(Band(percent, mean - sd, mean + sd, "#7d8894", "normal, ±1 sd", 0.28))
        curves.append(Curve(percent, mean, "#8b95a0", "normal, mean", dash="5 3", width=1.1))
    same = len(found) > 1 and np.array_equal(found[0].percent, found[1].percent)
    same = same and np.allclose(found[0].q, found[1].q, atol=1e-3)
    for leg in found:
        q, colour = np.degrees(leg.q[:, k]), svg.COLOURS[leg.side]
        if leg.sd is not None:
            sd = np.degrees(leg.sd[:, k])
            bands.append(Band(leg.percent, q - sd, q + sd, colour))
        over = "6 6" if same and leg.side == "right" else None  # two equal curves are seen both
        curves.append(Curve(leg.percent, q, colour, leg.side, over))
        if np.isfinite(leg.stance):
            spans.append(Span(0, min(leg.stance, 100.0), colour, f"{leg.side} stance", SIDES.index(leg.side)))
    levels = [Level(float(np.degrees(x)), "#7a3fb0", "joint limit") for x in limits.get(movement, ())]
    chart = Chart(
        title=TITLES[movement],
        x_label="% of the leg's gait cycle",
        curves=tuple(curves),
        bands=tuple(bands),
        spans=tuple(spans),
        levels=tuple(levels),
        x_range=(0, 100),
        least=_LEAST,
    )
    return Drawing(f"curve_{movement}", TITLES[movement], draw(chart))


def normal(speed: str, movement: int) -> tuple[Array, Array, Array]:
    """Percent, mean and standard deviation `(101,)` [deg] of a movement, the end point repeated."""
    mean, sd = normative_gait(speed).q[:, movement], normative_sd(speed)[:, movement]
    return np.linspace(0, 100, 101), np.degrees([*mean, mean[0]]), np.degrees([*sd, sd[0]])


def stances(gait: Gait) -> tuple[Span, ...]:
    """Shaded stance of both feet over time, in two strips; none where there are no events."""
    spans = []
    for lane, side in enumerate(SIDES):
        for start, end in stance_intervals(gait, side):
            spans.append(Span(start, end, svg.COLOURS[side], f"{side} stance", lane))
    return tuple(spans)


def stance_intervals(gait: Gait, side: str) -> list[tuple[float, float]]:
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


def rates(gait: Gait, values: Array, names: Sequence[str], what: str, unit: str) -> tuple[Drawing, ...]:
    """A joint quantity `(n, J)` over time, by movement, both legs.

    Args:
        gait: Its time and events.
        values: In `unit`.
        names: The joints of the columns.
        what: e.g. `"velocity"`.
        unit: Of the values.
    """
    drawings = []
    time, closed = over_time(gait, values)
    for movement in MOVEMENTS:
        curves = [
            Curve(time, closed[:, names.index(f"{side}_{movement}")], svg.COLOURS[side], side)
            for side in SIDES
            if f"{side}_{movement}" in names
        ]
        title = f"{TITLES[movement].removesuffix(' [deg]')} {what} [{unit}]"
        chart = Chart(
            title=title, x_label="time [s]", curves=tuple(curves), spans=stances(gait), least=1.0, height=170
        )
        drawings.append(Drawing(f"{what}_{movement}", title, draw(chart)))
    return tuple(drawings)


def centre_of_mass(gait: Gait, position: Array) -> tuple[Drawing, ...]:
    """Forward, left and up `(n, 3)` [m] about their means, in millimetres."""
    time, closed = over_time(gait, 1e3 * (position - position.mean(axis=0)))
    drawings = []
    for axis, name in enumerate(("forward", "to the left", "up")):
        title = f"Centre of mass, {name} [mm]"
        chart = Chart(
            title=title,
            x_label="time [s]",
            curves=(Curve(time, closed[:, axis], "#2f7d5b"),),
            spans=stances(gait),
            least=10.0,
            height=170,
        )
        drawings.append(Drawing(f"com_{'xyz'[axis]}", title, draw(chart)))
    return tuple(drawings)


def foot_paths(gait: Gait, corners: Array) -> tuple[Drawing, ...]:
    """Heels and balls of the feet: from the side, and their height over time.

    Args:
        gait: Its time and events.
        corners: `(n, 8, 3)` of the sole corners in the world, as in `anatomy.CORNERS` [m].
    """
    points = 100 * corners.reshape(len(corners), 2, 2, 2, 3).mean(axis=3)  # side, heel or ball [cm]
    time, closed = over_time(gait, points)
    side, height = [], []
    for s, name in enumerate(SIDES):
        for part, dash in ((0, None), (1, "4 3")):
            label = f"{name} {('heel', 'ball')[part]}"
            xyz = closed[:, s, part]
            side.append(Curve(xyz[:, 0], xyz[:, 2], svg.COLOURS[name], label, dash))
            height.append(Curve(time, xyz[:, 2], svg.COLOURS[name], label, dash))
    charts = (
        Chart(
            title="From the side: height over forward [cm]",
            x_label="forward [cm]",
            curves=tuple(side),
            width=420,
        ),
        Chart(
            title="Height of heel and ball [cm]",
            x_label="time [s]",
            curves=tuple(height),
            spans=stances(gait),
            width=420,
        ),
    )
    return tuple(Drawing(f"foot_{k}", chart.title, draw(chart)) for k, chart in enumerate(charts))


def contact_timeline(gait: Gait) -> Drawing:
    """Which foot is on the ground when, with the events."""
    width, start, end = 900.0, float(gait.time[0]), float(gait.time[0]) + gait.duration

    def at(t: float) -> float:
        return 60 + (width - 80) * (t - start) / (end - start)

    parts = []
    for row, side in enumerate(SIDES):
        y, colour = 14 + 34 * row, svg.COLOURS[side]
        parts.append(svg.text(52, y + 15, side, text_anchor="end", font_weight=600, fill=colour))
        parts.append(svg.tag("rect", x=60, y=y, width=width - 80, height=22, fill=colour, opacity=0.1))
        for a, b in stance_intervals(gait, side):
            box = {"x": at(a), "y": y, "width": at(b) - at(a), "height": 22, "rx": 3}
            parts.append(svg.tag("rect", fill=colour, **box))
            if at(b) - at(a) > 46:
                middle = (at(a) + at(b)) / 2
                words = f"{b - a:.2f} s"
                parts.append(svg.text(middle, y + 15, words, text_anchor="middle", fill="#fff"))
    for t in ticks(start, end, 8):
        parts.append(svg.line([[at(t), 78], [at(t), 83]], svg.GREY, stroke_width=0.8))
        parts.append(svg.text(at(t), 95, f"{t:.2f}", text_anchor="middle", font_size=10, fill=svg.GREY))
    parts.append(svg.text(60 + (width - 80) / 2, 110, "time [s]", text_anchor="middle", fill=svg.GREY))
    return Drawing("contact", "Feet on the ground", svg.drawing(width, 116, parts, "Feet on the ground"))


def range_bars(rows: Sequence[tuple[str, float, float, float, float]]) -> Drawing:
    """By joint: what the walk uses of the joint's range.

    Args:
        rows: Joint, smallest and largest angle, lower and upper limit [deg].
    """
    width, left = 900.0, 160.0
    low, high = min(r[3] for r in rows) - 5, max(r[4] for r in rows) + 5
    low, high = min(low, *(r[1] for r in rows)), max(high, *(r[2] for r in rows))
    scale = (width - left - 16) / (high - low)
    parts = []
    bottom = 10 + 19 * len(rows)
    for x in ticks(low, high, 9):
        at = left + scale * (x - low)
        parts.append(svg.line([[at, 8], [at, bottom]], svg.FAINT, stroke_width=0.8))
        parts.append(svg.text(at, bottom + 13, f"{x:.0f}", text_anchor="middle", font_size=10, fill=svg.GREY))
    for k, (joint, a, b, lower, upper) in enumerate(rows):
        y, colour = 10 + 19 * k, svg.COLOURS.get(joint.split("_")[0], svg.GREY)
        parts.append(svg.text(left - 8, y + 12, joint.replace("_", " "), text_anchor="end"))
        room = {"x": left + scale * (lower - low), "y": y + 4, "width": scale * (upper - lower), "height": 9}
        parts.append(svg.tag("rect", fill="#c9d1d9", rx=2, **room))
        used = {"x": left + scale * (a - low), "y": y + 2, "width": max(scale * (b - a), 1.5), "height": 13}
        parts.append(svg.tag("rect", fill=colour, rx=3, **used))
    title = "Angles used (coloured) within the joints' ranges (grey) [deg]"
    parts.append(svg.text(left + (width - left) / 2, bottom + 28, title, text_anchor="middle", fill=svg.GREY))
    return Drawing("ranges", title, svg.drawing(width, bottom + 34, parts, title))

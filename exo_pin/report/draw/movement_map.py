"""The movement map of a walk: bars of the nine variable scores, left beside right, and the profile score."""

from __future__ import annotations

import math

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.clinic import NINE, GaitProfile
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart_axis import ticks
from exo_pin.report.draw.drawing import Drawing

_WIDTH, _HEIGHT, _LEFT, _TOP = 900.0, 150.0, 34.0, 12.0
_BAR = 22.0


def movement_map(found: GaitProfile) -> Drawing:
    """Bars for each variable, a grey dash where normal walks themselves are on average.

    The dash is the root mean square over the cycle of the band's standard deviation: the score of a walk
    that is one standard deviation off everywhere.

    Args:
        found: Scores of a walk.
    """
    groups = [
        (angle.replace("_", " "), [found.variables.get((s, angle), math.nan) for s in SIDES])
        for angle in NINE
    ]
    groups.append(("GPS", [found.sides[side] for side in SIDES]))
    usual = {
        angle.replace("_", " "): float(np.sqrt(np.mean(found.band.curves[angle].sd ** 2)))
        for angle in NINE
        if angle in found.band.curves
    }
    values = [np.degrees(x) for _, pair in groups for x in pair if not math.isnan(x)]
    top = max([5.0, *values, *np.degrees(list(usual.values()))]) * 1.12
    bottom = _TOP + _HEIGHT

    def up(degrees: float) -> float:
        return float(bottom - _HEIGHT * degrees / top)

    parts = []
    for y in ticks(0.0, top, 5):
        parts.append(svg.line([[_LEFT, up(y)], [_WIDTH, up(y)]], svg.FAINT, stroke_width=0.8))
        parts.append(
            svg.text(_LEFT - 5, up(y) + 3.5, f"{y:g}", text_anchor="end", font_size=10, fill=svg.GREY)
        )
    step = (_WIDTH - _LEFT) / len(groups)
    for k, (name, pair) in enumerate(groups):
        middle = _LEFT + step * (k + 0.5)
        for s, (side, value) in enumerate(zip(SIDES, pair, strict=True)):
            x = middle + (s - 1) * (_BAR + 2) + 1
            if math.isnan(value):
                parts.append(svg.text(x + _BAR / 2, bottom - 4, "-", text_anchor="middle", fill=svg.GREY))
                continue
            degrees = float(np.degrees(value))
            parts.append(
                svg.tag(
                    "rect",
                    x=x,
                    y=up(degrees),
                    width=_BAR,
                    height=bottom - up(degrees),
                    fill=svg.SIDE_COLOURS[side],
                )
            )
            parts.append(
                svg.text(
                    x + _BAR / 2,
                    up(degrees) - 3,
                    f"{degrees:.1f}",
                    text_anchor="middle",
                    font_size=10,
                    paint_order="stroke",
                    stroke="#fff",
                    stroke_width=2.5,
                )
            )
        if name in usual:
            at = up(float(np.degrees(usual[name])))
            parts.append(
                svg.line(
                    [[middle - _BAR - 5, at], [middle + _BAR + 5, at]],
                    svg.INK,
                    stroke_width=1.2,
                    stroke_dasharray="3 2",
                )
            )
        for line, word in enumerate(name.split(" ", 1)):
            parts.append(
                svg.text(middle, bottom + 13 + 12 * line, word, text_anchor="middle", font_size=10.5)
            )
    title = "Movement map: score of each variable [deg], left red, right blue; dashes: 1 sd of normal walks"
    return Drawing("movement_map", title, svg.drawing(_WIDTH, bottom + 34, parts, title))

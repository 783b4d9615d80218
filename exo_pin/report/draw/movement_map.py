"""The movement map of a walk: bars of the nine variable scores, left beside right, and the profile score."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import ClinicalAngle, Side
from exo_pin.clinic import NINE, GaitProfile
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart_axis import ticks
from exo_pin.report.draw.drawing import Drawing

_WIDTH, _HEIGHT, _LEFT, _TOP = 900.0, 150.0, 34.0, 12.0
_BOTTOM, _BAR = _TOP + _HEIGHT, 22.0


def movement_map(found: GaitProfile) -> Drawing:
    """Bars for each variable, a grey dash where normal walks themselves are on average.

    The dash is the root mean square over the cycle of the band's standard deviation: the score of a walk
    that is one standard deviation off everywhere.

    Args:
        found: Scores of a walk.
    """
    groups = [_Group.of(found, angle) for angle in NINE]
    groups.append(_Group("GPS", [float(np.degrees(found.sides[side])) for side in SIDES], math.nan))
    known = [x for group in groups for x in (*group.scores, group.usual) if not math.isnan(x)]
    scale = _Scale(max([5.0, *known]) * 1.12)
    step = (_WIDTH - _LEFT) / len(groups)
    parts = scale.grid()
    for k, group in enumerate(groups):
        parts += _bars(group, _LEFT + step * (k + 0.5), scale)
    title = "Movement map: score of each variable [deg], left red, right blue; dashes: 1 sd of normal walks"
    return Drawing("movement_map", title, svg.drawing(_WIDTH, _BOTTOM + 34, parts, title))


class _Group(NamedTuple):
    """A variable: its name, the scores of left and right, the usual one [deg]; NaN where it is not known."""

    name: str
    scores: list[float]
    usual: float

    @classmethod
    def of(cls, found: GaitProfile, angle: ClinicalAngle) -> _Group:
        """A variable of a profile."""
        scores = [float(np.degrees(found.variables.get((side, angle), math.nan))) for side in SIDES]
        curve = found.band.curves.get(angle)
        usual = math.nan if curve is None else float(np.degrees(np.sqrt(np.mean(curve.sd**2))))
        return cls(angle.replace("_", " "), scores, usual)


class _Scale(NamedTuple):
    """The vertical axis, from 0 to `top` [deg]."""

    top: float

    def up(self, degrees: float) -> float:
        """Where a score stands in the picture [px]."""
        return float(_BOTTOM - _HEIGHT * degrees / self.top)

    def grid(self) -> list[str]:
        """Lines across, with their numbers."""
        parts = []
        for y in ticks(0.0, self.top, 5):
            at = self.up(y)
            parts.append(svg.line([[_LEFT, at], [_WIDTH, at]], svg.FAINT, stroke_width=0.8))
            parts.append(
                svg.text(_LEFT - 5, at + 3.5, f"{y:g}", text_anchor="end", font_size=10, fill=svg.GREY)
            )
        return parts


def _bars(group: _Group, middle: float, scale: _Scale) -> list[str]:
    """Two bars, the dash of the usual score, the name below."""
    parts = []
    for s, (side, degrees) in enumerate(zip(SIDES, group.scores, strict=True)):
        parts += _bar(middle + (s - 1) * (_BAR + 2) + 1, degrees, side, scale)
    if not math.isnan(group.usual):
        at, ends = scale.up(group.usual), (middle - _BAR - 5, middle + _BAR + 5)
        dash = {"stroke_width": 1.2, "stroke_dasharray": "3 2"}
        parts.append(svg.line([[ends[0], at], [ends[1], at]], svg.INK, **dash))
    for line, word in enumerate(group.name.split(" ", 1)):
        parts.append(svg.text(middle, _BOTTOM + 13 + 12 * line, word, text_anchor="middle", font_size=10.5))
    return parts


def _bar(x: float, degrees: float, side: Side, scale: _Scale) -> list[str]:
    """A bar with its number above; a dash where it is not known."""
    if math.isnan(degrees):
        return [svg.text(x + _BAR / 2, _BOTTOM - 4, "-", text_anchor="middle", fill=svg.GREY)]
    top = scale.up(degrees)
    halo = {"paint_order": "stroke", "stroke": "#fff", "stroke_width": 2.5}
    return [
        svg.tag("rect", x=x, y=top, width=_BAR, height=_BOTTOM - top, fill=svg.SIDE_COLOURS[side]),
        svg.text(x + _BAR / 2, top - 3, f"{degrees:.1f}", text_anchor="middle", font_size=10, **halo),
    ]

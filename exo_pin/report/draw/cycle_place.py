"""Where a series of a walk is drawn: over a foot's cycle, mean of its cycles, or over time without any."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait, strides
from exo_pin.report.draw import panels, svg
from exo_pin.report.draw.chart import Span
from exo_pin.report.draw.leg_cycles import legs

POINTS = 101
"""0, 1, ... 100 % of the cycle."""


@dataclass(frozen=True, eq=False)
class Place:
    """An x axis for series of a walk.

    Attributes:
        gait: The walk.
        moments: (k, `POINTS`) of the foot's k cycles [s]; k = 0: the series are drawn over time.
        label: Of the axis.
        spans: When the feet are on the ground.
    """

    gait: Gait
    moments: Array
    label: str
    spans: tuple[Span, ...]

    @property
    def x(self) -> Array:
        """(m,) percent of the cycle, or time [s]."""
        return (
            np.linspace(0, 100, POINTS)
            if len(self.moments)
            else panels.over_time(self.gait, self.gait.time)[0]
        )

    def of(self, values: Array) -> Array:
        """A series (n,) of the walk at `x` (m,): the mean of its cycles."""
        if not len(self.moments):
            return panels.over_time(self.gait, values)[1]
        period = self.gait.duration if self.gait.periodic else None
        return np.asarray(np.interp(self.moments, self.gait.time, values, period=period).mean(axis=0))


def place(gait: Gait, side: Side) -> Place:
    """Over the cycle of a foot where the walk has a whole one, else over time."""
    spans = [span for span in strides(gait, side) if not span.why]
    if not spans:
        return Place(gait, np.zeros((0, POINTS)), "time [s]", panels.stances(gait))
    moments = np.array([np.linspace(span.start, span.end, POINTS) for span in spans])
    how = f", mean of {len(spans)}" if len(spans) > 1 else ""
    leg = next((leg for leg in legs(gait) if leg.side == side), None)
    stance: tuple[Span, ...] = ()
    if leg is not None and np.isfinite(leg.stance):
        lane = SIDES.index(side)
        stance = (Span(0.0, min(leg.stance, 100.0), svg.COLOURS[side], f"{side} stance", lane),)
    return Place(gait, moments, f"% of the {side} foot's cycle{how}", stance)

"""The x axis for a series of a walk: percent of a foot's cycle, or time where no cycle is whole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait, leg_cycles
from exo_pin.gait.leg_cycles import cycle_times, mean_over_cycles
from exo_pin.report.draw import svg, walk_charts
from exo_pin.report.draw.chart import Span


@dataclass(frozen=True, eq=False)
class CycleAxis:
    """An x axis for series of a walk.

    Attributes:
        gait: The walk.
        times: `(k, 101)` of the foot's k cycles [s]; k = 0: the series are drawn over time.
        label: Of the axis.
        spans: When the feet are on the ground.
    """

    gait: Gait
    times: Array
    label: str
    spans: tuple[Span, ...]

    @property
    def x(self) -> Array:
        """`(m,)` percent of the cycle, or time [s]."""
        if len(self.times):
            return np.linspace(0, 100, self.times.shape[1])
        return walk_charts.over_time(self.gait, self.gait.time)[0]

    def series(self, values: Array) -> Array:
        """A series `(n,)` of the walk at `x` `(m,)`: the mean of its cycles."""
        if len(self.times):
            return mean_over_cycles(self.gait, self.times, values)
        return walk_charts.over_time(self.gait, values)[1]


def cycle_axis(gait: Gait, side: Side) -> CycleAxis:
    """Over the cycle of a foot where the walk has a whole one, else over time."""
    times = cycle_times(gait, side)
    if not len(times):
        return CycleAxis(gait, times, "time [s]", walk_charts.stance_spans(gait))
    how = f", mean of {len(times)}" if len(times) > 1 else ""
    leg = next((leg for leg in leg_cycles(gait) if leg.side == side), None)
    stance: tuple[Span, ...] = ()
    if leg is not None and np.isfinite(leg.stance):
        lane = SIDES.index(side)
        stance = (Span(0.0, min(leg.stance, 100.0), svg.SIDE_COLOURS[side], f"{side} stance", lane),)
    return CycleAxis(gait, times, f"% of the {side} foot's cycle{how}", stance)

"""The gait cycles in which the page counts phase: from heel strike to heel strike of a foot."""

from __future__ import annotations

from itertools import pairwise

from exo_pin.anatomy.names import Side
from exo_pin.gait import Gait
from exo_pin.gait.strides import side_with_more_strides, strides
from exo_pin.viewer.scenes.scene import Interval, PhaseCycles


def cycles(gait: Gait) -> PhaseCycles:
    """The cycles of the foot that has more of them, the left one if both have as many.

    A periodic walk is one cycle, seen around its end; without heel strikes it begins at its first sample.
    Spans of a recording that are no strides (a pause, a turn) are no cycles.
    """
    side = side_with_more_strides(gait)
    found = _of(gait, side)
    if gait.periodic and not found:
        return PhaseCycles("", ((0.0, gait.duration),))
    return PhaseCycles(side if found else "", found)


def _of(gait: Gait, side: Side) -> tuple[Interval, ...]:
    """From, to [s] after the first sample."""
    start = float(gait.time[0])
    if not gait.periodic:
        spans = strides(gait, side)
        return tuple((span.start - start, span.end - start) for span in spans if not span.why)
    strikes = [e.time - start for e in gait.events if (e.side, e.kind) == (side, "heel_strike")]
    return tuple(pairwise([t + k * gait.duration for k in (-1, 0, 1) for t in strikes]))

"""Gait cycles of each leg on the page's clock, and the phase of every sample in them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait import Gait, strides
from exo_pin.viewer.scenes.scene import Interval


def cycles_of(gait: Gait, side: Side) -> tuple[Interval, ...]:
    """From, to [s] after the first sample of a leg's cycles; those of a periodic walk reach over its ends."""
    start = float(gait.time[0])
    if not gait.periodic:
        spans = strides(gait, side)
        return tuple((span.start - start, span.end - start) for span in spans if not span.why)
    strikes = [e.time - start for e in gait.events if (e.side, e.kind) == (side, "heel_strike")]
    return tuple(pairwise([t + k * gait.duration for k in (-1, 0, 1) for t in strikes]))


def leg_phases(gait: Gait) -> tuple[Array, float | None]:
    """Phase `(n, 2)` of left and right leg, NaN outside of whole cycles, and the mean stride time [s]."""
    time, lengths = gait.time - gait.time[0], list[float]()
    phases = np.full((len(time), len(SIDES)), np.nan)
    for k, side in enumerate(SIDES):
        for start, end in cycles_of(gait, side):
            inside = (time >= start) & (time < end)
            phases[inside, k] = (time[inside] - start) / (end - start)
            lengths.append(end - start)
    return phases, float(np.mean(lengths)) if lengths else None

"""Phases of the gait cycle of a foot (Perry 1992), from its heel strikes and toe-offs."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Mask
from exo_pin.gait.event import SAME_TIME
from exo_pin.gait.gait import Gait

PHASES = {
    "loading response": (0.0, 12.0),
    "mid stance": (12.0, 31.0),
    "terminal stance": (31.0, 50.0),
    "pre-swing": (50.0, 62.0),
    "initial swing": (62.0, 75.0),
    "mid swing": (75.0, 87.0),
    "terminal swing": (87.0, 100.0),
}
"""Begin and end in percent of the foot's cycle (Perry 1992, Gait Analysis); toe-off is at 62."""

_SPANS = {("heel_strike", "toe_off"): (0.0, 62.0), ("toe_off", "heel_strike"): (62.0, 100.0)}


def percent(gait: Gait, side: Side) -> Array:
    """Percent (n,) of the foot's cycle: stance is stretched to 0 .. 62, swing to 62 .. 100.

    So a recording shorter than a stride still has phases. NaN where no whole stance or swing surrounds a
    sample.
    """
    events = [(e.time, e.kind) for e in gait.events if e.side == side]
    if gait.periodic:
        events = [(t + k * gait.duration, kind) for k in (-1, 0, 1) for t, kind in events]
    share = np.full(len(gait), np.nan)
    for (begin, kind), (end, following) in pairwise(sorted(events)):
        if (kind, following) not in _SPANS:
            continue
        low, high = _SPANS[kind, following]
        inside = (gait.time >= begin - SAME_TIME) & (gait.time < end - SAME_TIME)
        done = (gait.time[inside] - begin) / (end - begin)
        share[inside] = low + (high - low) * np.clip(done, 0.0, 1.0)
    return share


def masks(gait: Gait, side: Side) -> dict[str, Mask]:
    """Which samples (n,) belong to each phase of a foot; none where events are missing."""
    share = percent(gait, side)
    with np.errstate(invalid="ignore"):  # NaN belongs to no phase
        return {name: (share >= low) & (share < high) for name, (low, high) in PHASES.items()}

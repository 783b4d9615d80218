"""Toe clearance: how high the toe passes over the ground in mid swing."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.gait.event import Event, flat_times
from exo_pin.gait.spatiotemporal import Number
from exo_pin.gait.time_series import rows_within

MID_SWING = (0.3, 0.8)
"""Part of the swing in which the toe passes lowest (Winter, Phys Ther 72 (1992) 45-53): after it
has been lifted, before it is raised for the strike."""


def toe_clearances(time: Array, toes: Array, events: Sequence[Event]) -> dict[str, Number]:
    """`left_toe_clearance` and `right_toe_clearance`, from the lowest height of each swing.

    Heights count from the toe's own mean height while its foot rests flat, so where on the toe it is measured
    and how the floor lies does not matter.

    Args:
        time: `(n,)` [s].
        toes: `(n, 2, 3)` left and right toe in the world, z up [m]; NaN where it was not seen.
        events: Heel strikes and toe-offs, sorted by time.
    """
    out = {}
    for k, side in enumerate(SIDES):
        values = _clearances(time, toes[:, k, 2], events, side)
        if values:
            out[f"{side}_toe_clearance"] = Number.of(values, "m")
    return out


def _clearances(time: Array, height: Array, events: Sequence[Event], side: Side) -> list[float]:
    """Of each swing that was seen whole in its middle [m]; none without a stance to measure from."""
    resting = [height[rows_within(time, a, b)] for a, b in flat_times(events, side)]
    levels = [float(part.mean()) for part in resting if len(part) and np.isfinite(part).all()]
    if not levels:
        return []
    values, level = [], float(np.mean(levels))
    for off, strike in pairwise(event for event in events if event.side == side):
        if (off.kind, strike.kind) != ("toe_off", "heel_strike"):
            continue
        a, b = (off.time + part * (strike.time - off.time) for part in MID_SWING)
        middle = height[rows_within(time, a, b)]
        if len(middle) and np.isfinite(middle).all():
            values.append(float(middle.min()) - level)
    return values

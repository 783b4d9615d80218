"""Which foot stands when: from the gait's events, or estimated from the lowest corners of the soles."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from exo_pin.anatomy import CORNERS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import real, table, word
from exo_pin.arrays import Array, Mask
from exo_pin.errors import GaitError
from exo_pin.gait import Gait, stance_times
from exo_pin.gait.event import SAME_TIME
from exo_pin.gait.time_series import runs

Intervals = Mapping[Side, tuple[tuple[float, float], ...]]
"""Side -> (from, to) [s] after the gait's first sample."""

_NEAR_GROUND = 0.010
"""A foot whose lowest corner is this close to the lower foot's is taken to stand as well [m] (a choice)."""

_BEFORE_END = 1e-6
"""The last sample counts as this much earlier [s]: intervals that last to the end do not hold at it."""


def stance_from_events(gait: Gait) -> Intervals | None:
    """Stance of both feet from heel strikes and toe-offs, or None where the events do not tell."""
    try:
        for side in SIDES:
            gait.stance(side)  # checks that there are events, and that strike and toe-off take turns
    except GaitError:
        return None
    return {side: stance_times(gait, side) for side in SIDES}


def estimated_stance(gait: Gait, heights: Mapping[Side, Array]) -> Intervals:
    """Stance guessed from heights: the lower foot stands, and the other if it is nearly as low.

    Args:
        gait: The walk that the heights belong to, sample by sample.
        heights: Side -> `(n,)` height of the sole's lowest corner [m].

    Raises:
        UnknownNameError: A side is missing.
        DescriptionError: The shape of a height does not fit the walk, or a number is not finite.
    """
    for side in SIDES:
        word("side of heights", side, table("heights", heights))
    heights = {side: real(f"heights of {side}", heights[side], (len(gait),)) for side in SIDES}
    lowest = np.minimum(*(heights[side] for side in SIDES))
    return {side: _runs(gait, heights[side] <= lowest + _NEAR_GROUND) for side in SIDES}


def lowest_corners(positions: Array) -> dict[Side, Array]:
    """Side -> `(n,)` lowest height, from the positions `(n, 8, 3)` of `CORNERS` [m]."""
    positions = real("positions", positions, ("n", len(CORNERS), 3))
    mine = {side: [k for k, name in enumerate(CORNERS) if name.startswith(side)] for side in SIDES}
    return {side: positions[:, mine[side], 2].min(axis=1) for side in SIDES}


def standing(intervals: Intervals, side: Side, time: Array) -> Mask:
    """Whether a foot is on the ground.

    Args:
        intervals: Side -> (from, to) [s] after the gait's first sample.
        side: `"left"` or `"right"`.
        time: `(n,)` after the gait's first sample [s].

    Returns:
        `(n,)` contact.

    Raises:
        UnknownNameError: There is no such side.
        DescriptionError: A time is not finite.
    """
    word("side", side, SIDES)
    time = real("time", time, ("n",))
    inside = np.zeros(len(time), dtype=bool)
    moment = time + SAME_TIME  # an event that is meant to lie on a sample may miss it by rounding
    for start, end in intervals[side]:
        inside |= (start <= moment) & (moment < end)
    return inside


def standing_at_samples(gait: Gait, corners: Array) -> Mask:
    """`(n, 2)` which foot stands at each sample, by the events, else by the heights of the soles.

    Args:
        gait: The walk; a foot that stands to its end stands at its last sample too.
        corners: `(n, 8, 3)` positions of `CORNERS` [m].
    """
    stance = stance_from_events(gait) or estimated_stance(gait, lowest_corners(corners))
    time = np.minimum(gait.time - gait.time[0], gait.duration - _BEFORE_END)
    return np.stack([standing(stance, side, time) for side in SIDES], axis=1)


def _runs(gait: Gait, contact: Mask) -> tuple[tuple[float, float], ...]:
    time = np.r_[gait.time - gait.time[0], gait.duration]
    return tuple((float(time[a]), float(time[b])) for a, b in runs(contact))

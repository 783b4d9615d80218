"""When a foot is on the ground, as intervals of time, by the events of the walk."""

from __future__ import annotations

from itertools import pairwise

from exo_pin.anatomy.names import SIDES, EventKind, Side
from exo_pin.arguments import word
from exo_pin.gait.gait import Gait


def stance_times(gait: Gait, side: Side) -> tuple[tuple[float, float], ...]:
    """Start and end [s] of each contact of a foot, counted from the gait's first sample.

    The events need not alternate: a contact is a heel strike followed by a toe-off. A recording's first
    toe-off ends a contact that began before the recording, and its last heel strike begins one that lasts
    to its end. In a periodic gait contacts continue across the end of the cycle; they are cut there.

    Raises:
        UnknownNameError: There is no such side.
    """
    word("side", side, SIDES)
    start = float(gait.time[0])
    mine: list[tuple[float, EventKind]] = [(e.time - start, e.kind) for e in gait.events if e.side == side]
    if not mine:
        return ()
    if gait.periodic:
        mine = [(t + k * gait.duration, kind) for k in (-1, 0, 1) for t, kind in mine]
    else:
        if mine[0][1] == "toe_off":
            mine.insert(0, (0.0, "heel_strike"))
        if mine[-1][1] == "heel_strike":
            mine.append((gait.duration, "toe_off"))
    spans = [
        (max(a, 0.0), min(b, gait.duration))
        for (a, first), (b, second) in pairwise(mine)
        if (first, second) == ("heel_strike", "toe_off")
    ]
    return tuple((a, b) for a, b in spans if b > a)

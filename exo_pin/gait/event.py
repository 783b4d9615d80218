"""Gait events: heel strikes and toe-offs, and the stance of a foot between them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import EventKind, Side
from exo_pin.arguments import number
from exo_pin.arrays import Array, Mask
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.frozen_fields import set_fields

EVENT_KINDS: tuple[EventKind, ...] = ("heel_strike", "toe_off")
"""Initial contact of a foot with the ground, and the end of its contact."""

WHOLE_STRIDE: tuple[EventKind, ...] = ("heel_strike", "toe_off", "heel_strike")
"""Events of a foot in a row that make a whole stride."""

SAME_TIME = 1e-9
"""Two times closer than this are the same [s]: an event so close to a sample lies on it."""

FOOT_FLAT = (0.2, 0.5)
"""Part of the stance in which the whole foot rests on the ground: after the heel rocker, before heel-off."""


@dataclass(frozen=True)
class Event:
    """One contact event of one foot.

    Attributes:
        time: When it happens, on the gait's own time axis [s].
        kind: `"heel_strike"` or `"toe_off"`.
        side: `"left"` or `"right"`.
        source: Origin of the time, e.g. `"force plate"`.

    Raises:
        GaitError: If the time is not finite, or kind or side are unknown.
    """

    time: float
    kind: EventKind
    side: Side
    source: str = ""

    def __post_init__(self) -> None:
        time = number(f"event {self.kind} {self.side}: time", self.time, error=GaitError)
        set_fields(self, time=time)  # numpy scalars would print as np.float64(...)
        for what, value, known in (("kind", self.kind, EVENT_KINDS), ("side", self.side, SIDES)):
            if value not in known:
                choices = " or ".join(map(repr, known))
                raise GaitError(f"event at {self.time:g} s: {what} is {value!r}, expected {choices}")


def times_of(events: Iterable[Event], kind: EventKind, side: Side) -> list[float]:
    """The times of one kind of event of one foot [s].

    Args:
        events: Sorted by time.
        kind: `"heel_strike"` or `"toe_off"`.
        side: `"left"` or `"right"`.
    """
    return [event.time for event in events if (event.kind, event.side) == (kind, side)]


def between(times: Sequence[float], start: float, end: float) -> Sequence[float]:
    """The times strictly between two moments.

    Args:
        times: Sorted [s].
        start: The moment before [s].
        end: The moment after [s].
    """
    return times[bisect_right(times, start) : bisect_left(times, end)]


def flat_times(events: Iterable[Event], side: Side) -> Iterator[tuple[float, float]]:
    """Start and end [s] of the part of each whole stance in which the foot rests flat (`FOOT_FLAT`).

    Args:
        events: Sorted by time.
        side: `"left"` or `"right"`.
    """
    for strike, off in whole_stances(events, side):
        a, b = (strike + part * (off - strike) for part in FOOT_FLAT)
        yield a, b


def whole_stances(events: Iterable[Event], side: Side) -> Iterator[tuple[float, float]]:
    """Heel strike and toe-off [s] of each stance of a foot that both are known of.

    Args:
        events: Sorted by time.
        side: `"left"` or `"right"`.
    """
    for strike, off in pairwise(event for event in events if event.side == side):
        if (strike.kind, off.kind) == ("heel_strike", "toe_off"):
            yield strike.time, off.time


def stance_shares(events: Iterable[Event], side: Side) -> list[float]:
    """Stance as a part of the stride, of each heel strike, toe-off and next heel strike of a foot in a row.

    Args:
        events: Sorted by time.
        side: `"left"` or `"right"`.
    """
    mine = [event for event in events if event.side == side]
    return [
        (b.time - a.time) / (c.time - a.time)
        for a, b, c in zip(mine, mine[1:], mine[2:], strict=False)
        if (a.kind, b.kind, c.kind) == WHOLE_STRIDE
    ]


def stance(time: Array, events: Sequence[Event], side: Side, *, periodic: bool) -> Mask:
    """Whether a foot is on the ground: from its heel strike until its toe-off.

    Args:
        time: `(n,)` [s].
        events: Sorted by time.
        side: `"left"` or `"right"`.
        periodic: Whether the last event of the cycle also precedes the first.

    Returns:
        `(n,)` contact.

    Raises:
        GaitError: If the side has no events, or they do not take turns (then contact is unknown).
        UnknownNameError: If there is no such side.
    """
    if side not in SIDES:
        raise UnknownNameError("side", side, SIDES)
    mine = [event for event in events if event.side == side]
    if not mine:
        raise GaitError(f"the gait has no events of the {side} foot, so its contact is unknown")
    _check_turns(mine, periodic)
    times = np.array([event.time for event in mine]) - SAME_TIME
    latest = np.searchsorted(times, time, side="right") - 1
    strikes = np.array([event.kind == "heel_strike" for event in mine])
    before = not strikes[0]  # before its first event the foot is in the state which that event ends
    return np.where(latest < 0, before, strikes[latest])


def _check_turns(events: Sequence[Event], periodic: bool) -> None:
    pairs = [*pairwise(events), *([(events[-1], events[0])] if periodic else [])]
    for first, second in pairs:
        if first.kind == second.kind:
            raise GaitError(
                f"two {first.side} {first.kind} events follow each other, "
                f"at {first.time:g} s and {second.time:g} s; heel_strike and toe_off must take turns"
            )

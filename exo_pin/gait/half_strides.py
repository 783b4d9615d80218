"""Strides that a recording does not hold whole: estimated from the other foot, toe-offs or a step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import MOST_SAMPLES, number, word
from exo_pin.errors import GaitError
from exo_pin.gait.event import Event, between, times_of
from exo_pin.gait.gait import Gait
from exo_pin.gait.stride_checks import QUICKEST_STRIDE
from exo_pin.gait.strides import Stride, strides, strides_of_both


@dataclass(frozen=True)
class StrideEstimate:
    """The stride of a foot that has no whole cycle in the recording.

    Attributes:
        side: Whose.
        strike: Its heel strike, which places it in the cycle [s].
        duration: Estimated stride time [s].
        by: What the duration comes from.
        spans: The spans from toe-off to toe-off that it was measured between; empty for other estimates.
    """

    side: Side
    strike: float
    duration: float
    by: str
    spans: tuple[Stride, ...] = ()

    def __str__(self) -> str:
        """That it is an estimate, and its source."""
        return (
            f"no whole cycle of the {self.side} foot in the recording; estimated by its heel strike at "
            f"{self.strike:.3f} s and {self.by}, {self.duration:.3f} s"
        )

    def cycles(self, start: float, end: float) -> tuple[tuple[float, float], ...]:
        """From and to [s] of the estimated cycles that reach into a span of time.

        Args:
            start: Begin of the span [s].
            end: End of the span [s].

        Raises:
            GaitError: A time is not finite, or the span holds more than a million cycles.
        """
        number("start", start, error=GaitError)
        number("end", end, least=start, most=start + MOST_SAMPLES * self.duration, error=GaitError)
        first, stop = (np.floor((t - self.strike) / self.duration) for t in (start, end))
        edges = self.strike + self.duration * np.arange(first, stop + 2)
        return tuple((float(a), float(b)) for a, b in pairwise(edges) if a < end)


def walk_estimate(gait: Gait) -> StrideEstimate | None:
    """The estimate for a walk in which no foot has a whole cycle: of the foot that strikes first.

    None where a foot has one, or where nothing tells the stride time.
    """
    if any(not span.why for span in strides_of_both(gait)):
        return None
    found = (stride_estimate(gait, side) for side in SIDES)
    return min((x for x in found if x), key=lambda x: x.strike, default=None)


def stride_estimate(gait: Gait, side: Side) -> StrideEstimate | None:
    """The stride of a foot without a whole cycle, by the first of these that the events hold.

    The other foot's strides; the time from a foot's toe-off to its next one, which is a whole stride as well;
    twice the time from one foot's strike to the other's, which takes both steps as equal. None without a
    strike of the foot, or where spans between strikes are no strides of a walk (a turn, a pause).

    Args:
        gait: A walk with events.
        side: Whose stride.

    Raises:
        UnknownNameError: There is no such side.
    """
    word("side", side, SIDES)
    strikes = times_of(gait.events, "heel_strike", side)
    if not strikes:
        return None
    other: Side = SIDES[1 - SIDES.index(side)]
    whole = [span for span in strides(gait, other) if not span.why]
    if whole:
        duration = float(np.mean([span.duration for span in whole]))
        return StrideEstimate(side, strikes[0], duration, f"the {other} foot's stride")
    if gait.periodic or any(strides(gait, x) for x in SIDES):
        return None
    spans = _between_toe_offs(gait.events)
    if spans:
        whose = " and ".join(dict.fromkeys(span.side for span in spans))
        duration = float(np.mean([span.duration for span in spans]))
        by = f"the time from toe-off to toe-off ({whose})"
    else:
        duration, by = 2 * _step_time(gait.events), "a stride of twice the step time"
    return StrideEstimate(side, strikes[0], duration, by, spans) if duration > QUICKEST_STRIDE else None


def _between_toe_offs(events: Sequence[Event]) -> tuple[Stride, ...]:
    """The spans from a foot's toe-off to its next one with one strike of it between them."""
    return tuple(
        Stride(side, a, b)
        for side in SIDES
        for a, b in pairwise(times_of(events, "toe_off", side))
        if len(between(times_of(events, "heel_strike", side), a, b)) == 1
    )


def _step_time(events: Sequence[Event]) -> float:
    """Mean time from one foot's strike to the other's [s]; 0 where one of them does not strike."""
    strikes = [event for event in events if event.kind == "heel_strike"]
    steps = [b.time - a.time for a, b in pairwise(strikes) if a.side != b.side]
    return float(np.mean(steps)) if steps else 0.0

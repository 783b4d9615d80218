"""Strides: spans from heel strike to heel strike, with the reason where one is no stride of a walk."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arguments import word
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.event import EVENT_KINDS, SAME_TIME, between, times_of
from exo_pin.gait.gait import Gait
from exo_pin.gait.heading import yaw

_LONGEST = 3.0
"""A stride longer than this many median strides holds a pause or a missed event."""

_SHARPEST_TURN = np.radians(30.0)
"""A pelvis that turns further in a stride [rad] is turning: a circle of 2.7 m radius."""

_MOSTLY = 0.5
"""Where more than this part of the strides have a toe-off, one without it is incomplete."""

_STANDING_SHARE = 0.3
"""Part of the usual stride in which some joint moves, in a walk of any speed ..."""

_STANDING_RANGE = 0.1
"""... by this part of its range; where none does, the person stands."""

_MOVING = [k for k, joint in enumerate(JOINTS) if joint.endswith(("hip_flexion", "knee_flexion"))]


class Stride(NamedTuple):
    """A span between two heel strikes of a foot.

    Attributes:
        side: Whose.
        start: Heel strike [s].
        end: The foot's next heel strike [s].
        why: Why it is no stride; empty where it is one.
    """

    side: Side
    start: float
    end: float
    why: str = ""

    @property
    def duration(self) -> float:
        """Stride time [s]."""
        return self.end - self.start


def strides(gait: Gait, side: Side) -> tuple[Stride, ...]:
    """Every span between two heel strikes of a foot, with the reason where it is not a stride of a walk.

    No stride is: a span in which the person stands still, one longer than three median strides, one in which
    the pelvis turns by more than 30 degrees, or one without the foot's toe-off where most have it.

    Args:
        gait: A walk with events; one that repeats has as many strides as strikes, followed around its end.
        side: Whose heel strikes.

    Raises:
        UnknownNameError: There is no such side.
    """
    word("side", side, SIDES)
    if gait.periodic:
        first = gait.duration - SAME_TIME
        return tuple(span for span in strides(unrolled(gait), side) if span.start < first)
    strikes, offs = (times_of(gait.events, kind, side) for kind in EVENT_KINDS)
    spans = [Stride(side, a, b) for a, b in pairwise(strikes)]
    if not spans:
        return ()
    usual = float(np.median([span.duration for span in spans]))
    lifted = np.array([bool(between(offs, span.start, span.end)) for span in spans])
    rest, turns = _still(gait, usual).tolist(), turns_of(gait, strikes)
    whys = [
        _why(span, usual, rest, abs(turn)) or ("" if lift or lifted.mean() <= _MOSTLY else "no toe-off in it")
        for span, turn, lift in zip(spans, turns, lifted, strict=True)
    ]
    return tuple(span._replace(why=why) for span, why in zip(spans, whys, strict=True))


def strides_of_both(gait: Gait) -> tuple[Stride, ...]:
    """The `strides` of the left foot, then those of the right one."""
    return tuple(span for side in SIDES for span in strides(gait, side))


def counted_strides(gait: Gait) -> list[Stride]:
    """The strides of both feet without a reason against them; none where no foot strikes twice.

    Raises:
        GaitError: Every span between two strikes has a reason against it; the message gives the first one.
    """
    spans = strides_of_both(gait)
    counted = [span for span in spans if not span.why]
    if spans and not counted:
        raise GaitError(f"no gait cycles found: {spans[0].why}")
    return counted


def side_with_more_strides(gait: Gait) -> Side:
    """The foot that has more strides (those without a reason against them); left if both have as many."""
    return max(SIDES, key=lambda side: sum(not span.why for span in strides(gait, side)))


def unrolled(gait: Gait) -> Gait:
    """A periodic gait as a recording of a cycle and a bit: every heel strike is followed by another one."""
    if not gait.periodic:
        return gait
    thrice = gait.repeated(3)
    keep = thrice.time <= 2 * gait.duration
    base = None if thrice.base is None else thrice.base[keep]
    end = float(thrice.time[keep][-1])
    events = tuple(event for event in thrice.events if event.time <= end)
    return Gait(thrice.time[keep], thrice.q[keep], base=base, events=events, source=gait.source)


def _why(span: Stride, usual: float, rest: Sequence[float], turn: float) -> str:
    """Why the span is no stride."""
    if turn > _SHARPEST_TURN:
        return (
            f"the pelvis turns by {np.degrees(turn):.0f} deg in a stride, more than "
            f"{np.degrees(_SHARPEST_TURN):.0f}: turning, not walking straight on"
        )
    window = _STANDING_SHARE * usual / 2
    if between(rest, span.start + window, span.end - window):
        return "stands still in it"
    if span.duration > _LONGEST * usual:
        return f"lasts {span.duration:.2f} s, others {usual:.2f} s: a pause, or a missed heel strike"
    return ""


def turns_of(gait: Gait, times: Sequence[float] | Array) -> Array:
    """How far the pelvis's level heading turns from each of `(m,)` times to the next, `(m - 1,)` [rad]."""
    if gait.base is None:
        return np.zeros(len(times) - 1)
    return np.diff(np.interp(times, gait.time, yaw(gait.base)))


def _still(gait: Gait, usual: float) -> Array:
    """Times `(m,)` around which no hip and no knee moves for a part of the usual stride [s]."""
    q = gait.q[:, _MOVING]
    width = int(np.ceil(_STANDING_SHARE * usual * (len(gait) - 1) / (gait.time[-1] - gait.time[0]))) + 1
    if width > len(q) or width < 2:
        return np.empty(0)
    low, high = np.percentile(q, [0.5, 99.5], axis=0)  # a single bad sample must not set the scale
    rests = (_ranges(q, width) <= _STANDING_RANGE * (high - low)).all(axis=1)
    return np.asarray(gait.time[np.flatnonzero(rests) + width // 2])


def _ranges(y: Array, width: int) -> Array:
    """Largest less smallest value of each window of `width` samples of curves `(n, k)`, `(n - width + 1, k)`.

    Windows of twice the size are made of two, so that a long one costs little more than a short one.
    """
    highest = lowest = y
    size = 1
    while size < width:
        step = min(size, width - size)
        highest = np.maximum(highest[:-step], highest[step:])
        lowest = np.minimum(lowest[:-step], lowest[step:])
        size += step
    return highest - lowest

"""The strides of a walk: from heel strike to heel strike, and why some of those spans are none."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import JOINTS
from exo_pin.gait.walk import Gait

Array = NDArray[np.float64]

ROUNDING = 1e-9
"""Of times, as a part of the walk's duration."""

LONGEST = 3.0
"""A stride longer than this many median strides holds a pause or a missed event."""

TURNING = np.radians(30.0)
"""A pelvis that turns further in a stride [rad] is on a turn, not on a walk: a circle of 2.7 m radius."""

REST = 0.3
"""Part of the usual stride in which some joint moves, in a walk of any speed ..."""

STILL = 0.1
"""... by this part of its range; where none does, the person stands."""

_MOVING = [k for k, joint in enumerate(JOINTS) if joint.endswith(("hip_flexion", "knee_flexion"))]


class Stride(NamedTuple):
    """A span between two heel strikes of a foot.

    Attributes:
        side: Whose.
        start: Heel strike [s].
        end: The foot's next heel strike [s].
        why: Why it is not counted as a stride; empty where it is.
    """

    side: str
    start: float
    end: float
    why: str = ""

    @property
    def duration(self) -> float:
        """Stride time [s]."""
        return self.end - self.start


def strides(gait: Gait, side: str) -> tuple[Stride, ...]:
    """Every span between two heel strikes of a foot, with the reason where it is not a stride of a walk.

    No stride is: a span in which the person stands still, one longer than three median strides, one in which
    the pelvis turns by more than 30 degrees, or one without the foot's toe-off where most have it.

    Args:
        gait: A walk with events; one that repeats has as many strides as strikes, followed around its end.
        side: Whose heel strikes.
    """
    if gait.periodic:
        first = gait.duration * (1 - ROUNDING)
        return tuple(span for span in strides(unrolled(gait), side) if span.start < first)
    mine = [event for event in gait.events if event.side == side]
    strikes = [event.time for event in mine if event.kind == "heel_strike"]
    spans = [Stride(side, a, b) for a, b in pairwise(strikes)]
    if not spans:
        return ()
    usual = float(np.median([span.duration for span in spans]))
    offs = [event.time for event in mine if event.kind == "toe_off"]
    lifted = [any(span.start < t < span.end for t in offs) for span in spans]
    missed = [not lift and np.mean(lifted) > 0.5 for lift in lifted]
    rest = _still(gait, usual)
    return tuple(
        span._replace(why=_why(gait, span, usual, rest) or ("no toe-off in it" if miss else ""))
        for span, miss in zip(spans, missed, strict=True)
    )


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


def _why(gait: Gait, span: Stride, usual: float, rest: Array) -> str:
    """Why the span is no stride."""
    turn = abs(turned(gait, span.start, span.end))
    if turn > TURNING:
        return (
            f"the pelvis turns by {np.degrees(turn):.0f} deg in a stride, more than "
            f"{np.degrees(TURNING):.0f}: turning, not walking straight on"
        )
    window = REST * usual / 2
    if ((rest > span.start + window) & (rest < span.end - window)).any():
        return "stands still in it"
    if span.duration > LONGEST * usual:
        return f"lasts {span.duration:.2f} s, others {usual:.2f} s: a pause, or a missed heel strike"
    return ""


def turned(gait: Gait, start: float, end: float) -> float:
    """How far the pelvis's level heading turns between two times [rad]."""
    if gait.base is None:
        return 0.0
    yaw = np.unwrap(np.arctan2(gait.base[:, 1, 0], gait.base[:, 0, 0]))
    return float(np.interp(end, gait.time, yaw) - np.interp(start, gait.time, yaw))


def _still(gait: Gait, usual: float) -> Array:
    """Times `(m,)` around which no hip and no knee moves for a part of the usual stride [s]."""
    q = gait.q[:, _MOVING]
    width = int(np.ceil(REST * usual * (len(gait) - 1) / (gait.time[-1] - gait.time[0]))) + 1
    if width > len(q) or width < 2:
        return np.empty(0)
    low, high = np.percentile(q, [0.5, 99.5], axis=0)  # a single bad sample must not set the scale
    windows = np.lib.stride_tricks.sliding_window_view(q, width, axis=0)  # (m, 4, width)
    rests = (np.ptp(windows, axis=2) <= STILL * (high - low)).all(axis=1)
    return np.asarray(gait.time[np.flatnonzero(rests) + width // 2])

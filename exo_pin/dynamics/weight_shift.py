"""How two standing feet share the weight: from the foot that leaves to the foot that has struck."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.ground import Intervals

_TOUCH = 1e-9
"""Intervals of a periodic walk that meet within this [s] are one, cut at the end of the cycle."""

Span = tuple[float, float]


def shares(gait: Gait, stance: Intervals) -> Array:
    """`(n, 2)` part of the ground reaction under each foot: 1 in single support, 0 in the air.

    In double support the weight moves by s^2 (3 - 2 s), from the strike of one foot to the toe-off of the
    other. Where the recording cuts a double support off, the missing end is placed by the mean length of
    the others; NaN where there are no others.

    Args:
        gait: The walk.
        stance: Side -> intervals on the ground, after the gait's first sample [s].
    """
    time = gait.time - gait.time[0]
    open_ends = (-np.inf, np.inf) if gait.periodic else (_TOUCH, float(time[-1]) - _TOUCH)
    doubles = double_supports(gait, stance)
    whole = [b - a for a, b, _ in doubles if a > open_ends[0] and b < open_ends[1]]
    typical = float(np.mean(whole)) if whole else np.nan
    share = standing_feet(gait, stance).astype(float)
    for a, b, late in doubles:
        inside = (time >= a) & (time <= b)
        start = a if a > open_ends[0] else b - typical
        stop = b if b < open_ends[1] else start + typical
        s = np.clip((time[inside] - start) / (stop - start), 0.0, 1.0)
        new = s * s * (3.0 - 2.0 * s)
        share[inside, late], share[inside, 1 - late] = new, 1.0 - new
    return share


def standing_feet(gait: Gait, stance: Intervals) -> Mask:
    """`(n, 2)` which foot stands."""
    return np.stack([_standing(gait.time - gait.time[0], spans) for spans in _spans(gait, stance)], axis=1)


def double_supports(gait: Gait, stance: Intervals) -> list[tuple[float, float, int]]:
    """From, to [s after the first sample] and the foot (0 left, 1 right) that struck last, with both down."""
    return _double_supports(*_spans(gait, stance))


def _spans(gait: Gait, stance: Intervals) -> list[list[Span]]:
    return [_joined(stance[side], gait.duration if gait.periodic else 0.0) for side in SIDES]


def _joined(spans: tuple[Span, ...], period: float) -> list[Span]:
    """Intervals; those of a periodic walk with their copies one period before and after, joined."""
    if not period:
        return list(spans)
    copies = sorted((a + k * period, b + k * period) for k in (-1, 0, 1) for a, b in spans)
    out: list[Span] = []
    for a, b in copies:
        if out and a - out[-1][1] <= _TOUCH:
            out[-1] = (out[-1][0], b)
        else:
            out.append((a, b))
    return out


def _double_supports(left: list[Span], right: list[Span]) -> list[tuple[float, float, int]]:
    """From, to and the foot (0 left, 1 right) that struck last, of every time with both feet down."""
    found = []
    for one in left:
        for other in right:
            a, b = max(one[0], other[0]), min(one[1], other[1])
            if b > a:
                found.append((a, b, int((other[0], other[1]) > (one[0], one[1]))))
    return found


def _standing(time: Array, spans: list[Span]) -> Mask:
    inside = np.zeros(len(time), dtype=bool)
    for a, b in spans:
        inside |= (time >= a) & (time <= b)
    return inside

"""Clocks: time stamps that a file rounded to its decimals, put back on the even grid of the camera."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array

_MOST_DECIMALS = 6
"""A stamp with more decimals lies so near its grid that nothing is gained."""

_NOTICEABLE = 1e-4
"""Stamps less than this part of a step off their grid stay as they are: the error of an acceleration, about
speed times that part over the step, is then below the noise of any camera."""

_WITHIN = 0.6
"""Most that a stamp may be moved, as a part of the last decimal: rounding is half of it, the fit the rest."""

_FINE = 0.25
"""Last decimal as a part of a step, up to which few samples do; a coarser one needs `_MANY`."""

_MANY = 20
"""Samples after which rounding alone explains stamps that lie within half a decimal of an even grid."""


def even_clock(time: Array) -> Array | None:
    """The evenly spaced times `(n,)` of which these stamps are the rounded ones [s].

    A whole number of samples a second is preferred (60 Hz: 16, 17, 17 ms become 1/60 s), else the fitted line
    is taken. Differences of rounded stamps amplify the rounding by one over the step, second differences
    by its square.

    Args:
        time: `(n,)` strictly increasing [s].

    Returns:
        `(n,)` times that differ from the stamps by rounding only, or None: the stamps are even already, or
        no even grid explains them.
    """
    n = len(time)
    last = _last_decimal(time)
    if n < 4 or last is None:
        return None
    k = np.arange(n, dtype=np.float64)
    step = float(np.polyfit(k, time - time[0], 1)[0])
    if not last < (_FINE if n < _MANY else 1.0) * step:
        return None
    for trial in (1 / max(round(1 / step), 1), step):
        even = _nearest_grid(time, trial, k, last)
        off = np.abs(even - time).max()
        if off <= _WITHIN * last:
            return even if off > _NOTICEABLE * step else None
    return None


def evened_remark(time: Array, even: Array) -> str:
    """The sentence for a reader whose time stamps `(n,)` were moved to even ones [s]."""
    moved = 1e3 * float(np.abs(even - time).max())
    how = f"time stamps, rounded by the file, are evened to {1 / (even[1] - even[0]):.6g} Hz"
    return f"{how} (moved by {moved:.2g} ms at most)"


def within(event_time: float, even: Array) -> float:
    """An event's time [s], kept within the evened clock."""
    return min(max(event_time, float(even[0])), float(even[-1]))


def _last_decimal(time: Array) -> float | None:
    """The unit of the last decimal [s] that the stamps were rounded to, or None."""
    for decimals in range(1, _MOST_DECIMALS + 1):
        scaled = time * 10.0**decimals
        if np.abs(scaled - np.round(scaled)).max() < 1e-4:
            return float(10.0**-decimals)
    return None


def _nearest_grid(time: Array, step: float, k: Array, last: float) -> Array:
    """The grid of that step in the middle of the stamps; at whole multiples of the step where these do."""
    off = time - step * k
    first = (off.max() + off.min()) / 2
    whole = step * round(first / step)
    half = (off.max() - off.min()) / 2
    start = whole if abs(whole - first) + half <= _WITHIN * last else first
    return np.asarray(start + step * k)

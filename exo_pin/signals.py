"""Signal processing of sampled curves: low-pass filter, filling of gaps, outliers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arguments import count, number, real
from exo_pin.arguments import names as as_names
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.short_repr import short_repr

__all__ = [
    "CUTOFF",
    "EVEN_GRID",
    "GAP",
    "ORDER",
    "ROUNDED_TIME",
    "Filled",
    "Outlier",
    "filled",
    "longest_run",
    "lowpass",
    "outliers",
    "spikes",
]

CUTOFF = 6.0
"""Usual in gait laboratories [Hz]."""

ORDER = 4
"""Of forward and backward pass together."""

GAP = 0.2
"""Longest gap that is filled [s]: a sixth of a stride."""

_OUTLIER_FACTOR = 8.0
"""A sample is an outlier if it is this many times the usual deviation off the curve around it."""

_ROUNDING = 1e-12
"""Deviations below are rounding."""

EVEN_GRID = 1e-3
"""How far samples may lie off an even grid, as a fraction of the step ..."""

ROUNDED_TIME = 1.1e-3
"""... or this far [s]: files round times to milliseconds, the camera did not."""


class Filled(NamedTuple):
    """Curves after filling.

    Attributes:
        values: `(n, ...)`; NaN where a gap was too long or open at an end.
        filled: Samples that were filled.
        left: Samples that are still missing.
    """

    values: Array
    filled: int
    left: int

    def __repr__(self) -> str:
        return short_repr(self)


class Outlier(NamedTuple):
    """A sample that stands out of its curve.

    Attributes:
        name: Of the curve.
        time: When [s].
        off: How far it is off the cubic through its neighbours, in the curve's units.
    """

    name: str
    time: float
    off: float


def lowpass(time: ArrayLike, y: ArrayLike, *, cutoff: float = CUTOFF, order: int = ORDER) -> Array:
    """Zero-lag Butterworth filter: forward, then backward, so nothing is delayed.

    The pass's own cut-off is raised so that both passes together have their -3 dB at `cutoff` (Winter,
    Biomechanics and Motor Control of Human Movement: the factor (2^(1/2) - 1)^(1/4) for order 4).

    Args:
        time: `(n,)` even samples [s].
        y: `(n, ...)` curves without gaps.
        cutoff: Frequency that keeps half its power [Hz].
        order: 2, 4, 6 or 8, of both passes together.

    Returns:
        `(n, ...)` the filtered curves.

    Raises:
        GaitError: Uneven or too few samples, gaps, or a cut-off beyond half the sampling rate.
    """
    from scipy import signal  # 0.3 s, needed here only

    t, values = _curves(time, y, gaps=True, increasing=False)
    rate = _rate(t)
    if count("order", order, 2, 8, error=GaitError) % 2:
        raise GaitError(f"order is {order}; 2, 4, 6 or 8 (forward and backward together) is accepted")
    if not number("cut-off", cutoff, error=GaitError) < rate / 2 or cutoff <= 0:
        raise GaitError(f"cut-off is {cutoff:g} Hz; more than 0 and less than {rate / 2:g} Hz is accepted")
    if np.isnan(values).any():
        raise GaitError("a curve with gaps cannot be filtered; fill them first")
    half = order // 2
    correction = (np.sqrt(2.0) - 1.0) ** (1 / (2 * half))
    warped = np.tan(np.pi * cutoff / rate) / correction  # the digital filter's frequencies are bent by tan
    sos = signal.butter(half, np.arctan(warped) * rate / np.pi, fs=rate, output="sos")
    pad = min(len(t) - 1, int(3 * rate / cutoff))
    return np.asarray(signal.sosfiltfilt(sos, values, axis=0, padlen=pad))


def filled(time: ArrayLike, y: ArrayLike, *, limit: float = GAP) -> Filled:
    """Fill gaps (NaN) up to a limit with a monotone-preserving cubic (PCHIP), never beyond the ends.

    Args:
        time: `(n,)` increasing [s].
        y: `(n, ...)` curves; a sample is missing where it is NaN.
        limit: Longest gap that is filled, from the last sample before to the first after it [s].

    Raises:
        GaitError: The shapes do not fit, the time does not increase, or a number is infinite.
    """
    t, given = _curves(time, y, gaps=True)
    number("limit", limit, least=0.0, error=GaitError)
    values = given.copy()
    flat = values.reshape(len(t), -1)
    before = int(np.isnan(flat).sum())
    if not before:
        return Filled(values, 0, 0)
    from scipy.interpolate import PchipInterpolator  # 0.3 s, needed here only

    for k in range(flat.shape[1]):
        seen = np.flatnonzero(~np.isnan(flat[:, k]))
        if len(seen) in (0, 1, len(t)):
            continue
        curve = PchipInterpolator(t[seen], flat[seen, k])
        gaps = np.flatnonzero((np.diff(seen) > 1) & (np.diff(t[seen]) <= limit))
        for gap in gaps:
            rows = slice(seen[gap] + 1, seen[gap + 1])
            flat[rows, k] = curve(t[rows])
    left = int(np.isnan(flat).sum())
    return Filled(flat.reshape(values.shape), before - left, left)


def longest_run(good: ArrayLike) -> tuple[int, int]:
    """Start and stop of the longest run of True in `(n,)`; 0 and 0 without any.

    Raises:
        GaitError: The values are no truth values `(n,)`.
    """
    marked = np.concatenate([[False], real("good", good, ("n",), error=GaitError) != 0.0, [False]])
    runs = np.flatnonzero(marked[1:] != marked[:-1]).reshape(-1, 2)
    if not len(runs):
        return 0, 0
    start, stop = runs[np.diff(runs, axis=1)[:, 0].argmax()]
    return int(start), int(stop)


def spikes(time: ArrayLike, y: ArrayLike, *, factor: float = _OUTLIER_FACTOR, least: float = 0.0) -> Array:
    """How far samples stand out of their surroundings: 0 where they do not, and at two samples of each end.

    Each sample is compared with the cubic through its two neighbours on either side. It stands out if it is
    off by `factor` times what is usual for the curve (1.4826 times the median, a robust standard deviation),
    by `least`, and by more than the samples around it.

    Args:
        time: `(n,)` increasing [s].
        y: `(n, ...)` curves without gaps.
        factor: Times the usual.
        least: Smaller deviations are no outliers, in units of y.

    Returns:
        `(n, ...)` signed deviations.

    Raises:
        GaitError: The shapes do not fit, the time does not increase, or a number is not finite.
    """
    t, values = _curves(time, y)
    number("factor", factor, least=0.0, error=GaitError)
    number("least", least, least=0.0, error=GaitError)
    off = np.zeros(values.shape)
    if len(values) < 5:
        return off
    weights = _around(t)
    curves, flat = values.reshape(len(t), -1).T, off.reshape(len(t), -1).T
    for curve, found in zip(curves, flat, strict=True):  # one at a time: a long recording's are large
        away = curve[2:-2] - sum(w * curve[_shifted(lag)] for lag, w in weights.items())
        size = np.abs(away)
        around = np.pad(size, 2)
        highest = np.maximum.reduce([around[k : k + len(size)] for k in range(5)])
        beyond = max(factor * 1.4826 * float(np.median(size)), least, _ROUNDING)
        found[2:-2] = np.where((size > beyond) & (size == highest), away, 0.0)
    return off


def outliers(time: ArrayLike, y: ArrayLike, names: Sequence[str], *, least: float) -> tuple[Outlier, ...]:
    """The samples of named curves that are outliers (`spikes`), sorted by time.

    Args:
        time: `(n,)` increasing [s].
        y: `(n, m)` curves without gaps.
        names: m names.
        least: Smaller deviations are no outliers, in units of y.

    Raises:
        GaitError: The shapes do not fit, the time does not increase, or a number is not finite.
    """
    texts = as_names("names", names, error=GaitError)
    times, values = _curves(time, y)
    if values.shape[1:] != (len(texts),):
        raise GaitError(
            f"{len(texts)} names for curves of shape {values.shape}; (n, {len(texts)}) is accepted"
        )
    off = spikes(times, values, least=least)
    return tuple(Outlier(texts[k], float(times[i]), float(off[i, k])) for i, k in np.argwhere(off))


def _curves(
    time: ArrayLike, y: ArrayLike, *, gaps: bool = False, increasing: bool = True
) -> tuple[Array, Array]:
    """Increasing times `(n,)` and curves `(n, ...)` on them.

    Args:
        time: As given [s].
        y: As given.
        gaps: Whether NaN is accepted in curves.
        increasing: Whether times must differ: rounded ones may not.

    Raises:
        GaitError: They are not; or a number is not finite, NaN for gaps excepted.
    """
    t = real("time", time, ("n",), error=GaitError)
    values = real("y", y, gaps=gaps, error=GaitError)
    if values.shape[:1] != t.shape:
        raise GaitError(f"y has shape {values.shape}; ({len(t)}, ...) is accepted, a row for each time")
    if increasing and not (np.diff(t) > 0).all():
        raise GaitError(f"time does not increase after sample {int((np.diff(t) <= 0).argmax())}")
    return t, values


def _around(t: Array) -> dict[int, Array]:
    """Lagrange weights `(n - 4,)` of each inner sample's four neighbours, by how far away they are."""
    lags = (-2, -1, 1, 2)
    at = {lag: t[_shifted(lag)] for lag in (*lags, 0)}
    return {k: np.prod([(at[0] - at[m]) / (at[k] - at[m]) for m in lags if m != k], axis=0) for k in lags}


def _shifted(lag: int) -> slice:
    """The samples that lie `lag` after the inner ones; inner are all but two at each end."""
    return slice(2 + lag, lag - 2 or None)


def _rate(time: Array) -> float:
    """Samples per second of an even grid."""
    if len(time) < 10:
        raise GaitError(f"{len(time)} samples are too few to filter; 10 are accepted")
    step = float(time[-1] - time[0]) / (len(time) - 1)
    off = float(np.abs(time - time[0] - step * np.arange(len(time))).max())
    if off > max(EVEN_GRID * step, min(ROUNDED_TIME, step / 4)):
        raise GaitError(f"samples lie up to {off:.2g} s off an even grid; resample before filtering")
    return 1.0 / step

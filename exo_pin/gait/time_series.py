"""Time series: derivatives, resampling and Fourier interpolation of samples; runs of marked samples."""

from __future__ import annotations

import math

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.chunks import for_chunks


def derivative(time: Array, y: Array, order: int, period: float | None) -> Array:
    """First or second time derivative of the samples.

    Args:
        time: `(n,)` strictly increasing [s].
        y: `(n, m)` samples.
        order: 1 or 2.
        period: The period of evenly sampled periodic data (exact for band-limited data), or None
            (then second-order accurate differences, on uneven time and at the ends too) [s].

    Returns:
        `(n, m)` derivatives.
    """
    return _differences(time, y, order) if period is None else _spectral(y, order, period)


def runs(marked: Mask) -> list[tuple[int, int]]:
    """First sample of each run of True in `(n,)`, and the one after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def rows_within(time: Array, start: float, end: float) -> slice:
    """The samples at `(n,)` increasing times from one moment to another, both included [s]."""
    return slice(int(np.searchsorted(time, start)), int(np.searchsorted(time, end, side="right")))


def resampled(time: Array, y: Array, new: Array, periodic: bool) -> Array:
    """The curve through `(n, m)` samples at the evenly spaced times `new`.

    Args:
        time: `(n,)` times of the samples [s].
        y: `(n, m)` samples.
        new: `(k,)` times; for periodic data they must divide the same period evenly [s].
        periodic: Trigonometric interpolation if True, else C1 cubic Hermite pieces.

    Returns:
        `(k, m)` values.
    """
    return _trigonometric(y, len(new)) if periodic else _hermite(time, y, new)


def at_phase(y: Array, phase: Array) -> Array:
    """The periodic curve through `(n, m)` samples of a cycle at any phases `(k,)`; 1 is a full cycle.

    Trigonometric interpolation, smooth in the phase: `(k, m)` values.
    """
    n = len(y)
    c = np.fft.rfft(y, axis=0) / n
    c[1:] *= 2
    if n % 2 == 0:
        c[-1] /= 2  # the highest cosine has no partner
    angle = 2j * np.pi * np.outer(phase, np.arange(len(c)))
    return np.asarray((np.exp(angle) @ c).real)


def low_harmonics(y: Array, highest: int) -> Array:
    """Evenly sampled periodic curves `(n, ...)` without the harmonics above the `highest` of their period."""
    spectrum = np.fft.rfft(y, axis=0)
    spectrum[highest + 1 :] = 0
    return np.fft.irfft(spectrum, len(y), axis=0)


def _spectral(y: Array, order: int, period: float) -> Array:
    n = len(y)
    factor = (2j * np.pi * np.fft.rfftfreq(n, 1 / n) / period) ** order
    if n % 2 == 0 and order % 2:
        factor[-1] = 0  # the highest cosine has its derivative's zeros exactly on the samples
    return np.fft.irfft(factor[:, None] * np.fft.rfft(y, axis=0), n, axis=0)


def _trigonometric(y: Array, k: int) -> Array:
    """Evaluate the Fourier interpolant on k even points: frequencies that look alike there are added."""
    n = len(y)
    c = np.fft.fft(y, axis=0) / n
    frequency = np.round(np.fft.fftfreq(n, 1 / n)).astype(int)
    if n % 2 == 0:  # the highest frequency belongs half to each sign, or the curve would not be real
        c[n // 2] /= 2
        c = np.concatenate([c, c[n // 2 : n // 2 + 1]])
        frequency = np.append(frequency, n // 2)
    folded = np.zeros((k, y.shape[1]), dtype=complex)
    np.add.at(folded, frequency % k, c)
    return np.fft.ifft(folded, axis=0).real * k


def _differences(time: Array, y: Array, order: int) -> Array:
    """Differentiate the polynomial through each sample's neighbours: order + 2 points give 2nd order."""
    n = len(time)
    width = min(order + 2, n)
    derivatives = np.zeros_like(y)
    if width <= order:
        return derivatives  # two samples have no second derivative

    def of_chunk(part: slice) -> None:
        at = np.arange(part.start, part.stop)
        stencil = np.clip(at - 1, 0, n - width)[:, None] + np.arange(width)  # (m, width)
        away = time[stencil] - time[at, None]
        scale = np.abs(away).max(axis=1)
        powers = (away / scale[:, None])[:, None, :] ** np.arange(width)[:, None]  # (m, power, width)
        right = np.zeros((len(at), width, 1))
        right[:, order, 0] = math.factorial(order)
        weights = np.linalg.solve(powers, right)[:, :, 0] / scale[:, None] ** order
        for i in range(width):
            derivatives[part] += weights[:, i, None] * y[stencil[:, i]]

    for_chunks(n, y, of_chunk)
    return derivatives


def _hermite(time: Array, y: Array, new: Array) -> Array:
    slope = _differences(time, y, 1)
    i = np.clip(np.searchsorted(time, new, side="right") - 1, 0, len(time) - 2)
    h = (time[i + 1] - time[i])[:, None]
    s = (new - time[i])[:, None] / h
    return np.asarray(
        (1 + 2 * s) * (1 - s) ** 2 * y[i]
        + s * (1 - s) ** 2 * h * slope[i]
        + s**2 * (3 - 2 * s) * y[i + 1]
        - s**2 * (1 - s) * h * slope[i + 1]
    )

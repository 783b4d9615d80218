"""Velocities and accelerations between the samples of a motion, as weights on neighbouring samples.

A recording runs between its samples along cubic Hermite pieces whose slopes are second-order differences
(`Gait.resampled`): velocity is a parabola on each piece, acceleration a straight line, so that the values at
the ends of the pieces bound it. The Fourier series of a cycle is close to the polynomials through six
samples, but not equal: `largest_rates` measures either as `Gait.dq` and `Gait.ddq` have it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.gait import time_series

FINER = 10
"""Rates are measured on so many times as many samples."""

_DENSER = 4
"""The rates of a Fourier series are limited at so many times as many points."""

_AROUND = range(-2, 4)  # the samples that a piece of a cycle depends on
_PLACES = (0.0, 0.5)  # along it, where its rates are limited
_SLOPE_PLACES = (0.0, 0.5, 1.0)  # along a piece, where its velocity is limited
_CURVATURE_PLACES = (0.0, 1.0)  # and its acceleration


@dataclass(frozen=True, eq=False)
class Clock:
    """The times of the samples.

    Attributes:
        time: Increasing (n,) [s]; of a cycle evenly spaced.
        period: Length of the cycle [s]; None for a motion that does not repeat.
    """

    time: Array
    period: float | None

    def largest_rates(self, q: Array) -> tuple[Array, Array]:
        """Largest speeds and accelerations (J,) of motions q (n, J), ten times as finely sampled."""
        n = FINER * len(self.time)
        start, end = self.time[0], self.time[-1]
        cycle = None if self.period is None else start + self.period * np.arange(n) / n
        fine = np.linspace(start, end, n) if cycle is None else cycle
        dense = time_series.resampled(self.time, q, fine, self.period is not None)
        parts = [(self.time, q), (fine, dense)]
        first, second = (
            np.max(
                [np.abs(time_series.derivative(*part, order, self.period)).max(axis=0) for part in parts], 0
            )
            for order in (1, 2)
        )
        return first, second

    def pieces(self) -> Pieces:
        """The pieces between neighbouring samples: for a cycle, of polynomials through six of them."""
        n = len(self.time)
        if self.period is not None:
            nodes = (np.arange(n)[:, None] + _AROUND) % n
            weights = (_polynomial(order, self.period / n) for order in (1, 2))
            return Pieces(nodes, *(np.broadcast_to(rows, (n, *rows.shape)) for rows in weights))
        width, i = min(4, n), np.arange(n - 1)
        nodes = np.clip(i - 1, 0, n - width)[:, None] + np.arange(width)
        begin = i - nodes[:, 0]
        first = np.clip(np.stack([i - 1, i], axis=1), 0, max(n - 3, 0)) - nodes[:, :1]
        time = self.time[nodes]
        slopes = np.stack([_slope(time, begin + k, first[:, k]) for k in (0, 1)])
        return Pieces(nodes, *_rows(time, begin, slopes))

    def cycle(self) -> tuple[Array, Array]:
        """Weights (m, n) of velocities and of accelerations of the cycle's Fourier series."""
        assert self.period is not None
        n = len(self.time)
        fine = self.period * np.arange(_DENSER * n) / (_DENSER * n)
        series = time_series.resampled(self.time, np.eye(n), fine, periodic=True)
        velocity, acceleration = (
            time_series.derivative(fine, series, order, self.period) for order in (1, 2)
        )
        return velocity, acceleration


@dataclass(frozen=True, eq=False)
class Pieces:
    """Rates on P pieces as weights of the samples around them.

    Attributes:
        nodes: The samples (P, w) that a piece depends on.
        velocity: Weights (P, k, w) of velocities along it [1/s].
        acceleration: Weights (P, k, w) of accelerations along it [1/s^2].
    """

    nodes: Index
    velocity: Array
    acceleration: Array


def _polynomial(order: int, step: float) -> Array:
    """Weights (2, 6) of a derivative of the polynomial through six samples, in their middle and one before.

    Args:
        order: 1 or 2.
        step: Between the samples [s].
    """
    powers = np.arange(len(_AROUND))
    vandermonde = np.asarray(_AROUND, dtype=float)[:, None] ** powers
    rows = []
    for place in _PLACES:
        factor = np.prod([powers - k for k in range(order)], axis=0)
        at = factor * place ** np.maximum(powers - order, 0)
        rows.append(np.linalg.solve(vandermonde.T, at) / step**order)
    return np.array(rows)


def _slope(time: Array, at: Index, first: Index) -> Array:
    """Weights (P, w) of the slope at a node: of the parabola through three nodes, of a line through two.

    Args:
        time: Times of the nodes (P, w).
        at: The node (P,).
        first: The first of the three nodes (P,).
    """
    width, rows = time.shape[1], np.arange(len(time))
    count = min(3, width)
    weights = np.zeros_like(time)
    chosen = first[:, None] + np.arange(count)
    x = time[rows[:, None], chosen] - time[rows, at][:, None]
    for k in range(count):
        others = [j for j in range(count) if j != k]
        below = np.prod([x[:, k] - x[:, j] for j in others], axis=0)
        above = -sum(x[:, j] for j in others) if count == 3 else 1.0
        weights[rows, chosen[:, k]] = above / below
    return weights


def _rows(time: Array, begin: Index, slopes: Array) -> tuple[Array, Array]:
    """The weights of velocities and accelerations along cubic Hermite pieces."""
    rows = np.arange(len(time))
    h = (time[rows, begin + 1] - time[rows, begin])[:, None]
    chord = np.zeros_like(time)
    chord[rows, begin], chord[rows, begin + 1] = -1.0 / h[:, 0], 1.0 / h[:, 0]
    m0, m1 = slopes
    velocity = [
        6 * (s - s * s) * chord + (1 - 4 * s + 3 * s * s) * m0 + (3 * s * s - 2 * s) * m1
        for s in _SLOPE_PLACES
    ]
    acceleration = [
        ((6 - 12 * s) * chord + (6 * s - 4) * m0 + (6 * s - 2) * m1) / h for s in _CURVATURE_PLACES
    ]
    return np.stack(velocity, axis=1), np.stack(acceleration, axis=1)

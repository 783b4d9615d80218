"""The foot velocity method: heel strikes where the foot falls fastest, near Zeni's moments."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.arrays import Array
from exo_pin.gait.event import Event

FOOT_VELOCITY = "O'Connor 2007"
_EARLIEST, _LATEST = -0.02, 0.10
"""The strike lies so far from Zeni's moment [s]: of the recordings at hand Zeni is 21 to 56 ms early."""

_SLOWEST = 0.05
"""A foot that comes down slower than this [m/s] is put down softly: its velocity does not show when."""

_HALF_WINDOW = 0.025
"""Velocities are slopes of lines through the samples this far before and after [s]: a low pass that takes the
noise of markers, and leaves the fall of a foot, which takes 0.1 s, as it is."""


def at_largest_fall(time: Array, height: Array, events: Sequence[Event]) -> list[Event]:
    """The events with each heel strike moved to where the foot falls fastest.

    C. M. O'Connor, S. K. Thorpe, M. J. O'Malley, C. L. Vaughan, "Automatic detection of gait events using
    kinematic data", Gait & Posture 25 (2007) 469-474: heel strike is the trough of the vertical velocity of
    the foot's centre, midway between heel and toe; 16 +- 15 ms (mean, sd) from force plates in 54 children.
    A strike without a trough near it, as of a foot put down softly, stays where it is.

    Args:
        time: `(n,)` [s].
        height: `(n, 2)` of the left and right foot's centre above the ground [m].
        events: Heel strikes and toe-offs by Zeni's method, sorted by time.
    """
    grid, velocity = slopes(time, height, _HALF_WINDOW)
    moved = [
        _moved(event, grid, velocity[:, SIDES.index(event.side)]) if event.kind == "heel_strike" else event
        for event in events
    ]
    return sorted(moved, key=lambda event: event.time)


def _moved(event: Event, time: Array, velocity: Array) -> Event:
    first, stop = np.searchsorted(time, [event.time + _EARLIEST, event.time + _LATEST])
    if stop - first < 3:
        return event
    k = int(first + velocity[first:stop].argmin())
    if not first < k < stop - 1 or velocity[k] > -_SLOWEST:
        return event
    return dataclasses.replace(event, time=vertex(time, -velocity, k), source=FOOT_VELOCITY)


def slopes(time: Array, values: Array, half: float) -> tuple[Array, Array]:
    """The slopes of lines fitted around each sample, on an even grid: a derivative with little noise.

    Args:
        time: `(n,)` [s].
        values: `(n, k)`.
        half: How far before and after a sample the line is fitted [s].

    Returns:
        `(m,)` even times [s] and `(m, k)` slopes per second; towards the ends the lines are shorter.
    """
    m = round(float((time[-1] - time[0]) / np.median(np.diff(time)))) + 1
    grid = np.linspace(time[0], time[-1], max(m, 2))
    step = grid[1] - grid[0]
    even = np.stack([np.interp(grid, time, y) for y in values.T], axis=1)
    ends = np.gradient(even, step, axis=0)
    n = max(round(half / step), 1)
    if len(grid) < 2 * n + 1:
        return grid, ends
    lags = np.arange(-n, n + 1)
    inner = np.stack([np.convolve(y, -lags, "same") for y in even.T], axis=1) / (step * (lags @ lags))
    inner[:n], inner[-n:] = ends[:n], ends[-n:]
    return grid, inner


def vertex(time: Array, y: Array, i: int) -> float:
    """Time of the parabola's vertex through the samples around a maximum [s].

    Args:
        time: `(n,)` [s].
        y: `(n,)` a curve, in any unit.
        i: The sample of its maximum.
    """
    if not 0 < i < len(y) - 1:
        return float(time[i])
    before, after = time[i - 1] - time[i], time[i + 1] - time[i]
    left, right = (y[i - 1] - y[i]) / before, (y[i + 1] - y[i]) / after
    bend = (right - left) / (after - before)
    if bend >= 0:  # a plateau
        return float(time[i])
    return float(time[i] + min(max((before - left / bend) / 2, before / 2), after / 2))

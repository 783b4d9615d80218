"""A second walk laid over a first: on the same clock, from the same place, in the same direction."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.heading import mean_heading
from exo_pin.gait.rigid_poses import about


def aligned(gait: Gait, other: Gait) -> Gait:
    """Another gait sampled on a gait's clock.

    Two cycles are laid over each other from left heel strike to left heel strike, whatever their durations.
    Recordings run side by side from their starts; the shorter one waits at its end. The other pelvis starts
    where the gait's does and heads the same way, wherever in its laboratory it was recorded.
    """
    n = len(gait)
    if gait.periodic and other.periodic:
        fitted = other.slowed(gait.duration / other.duration).resampled(n)
        shift = round(n * (_strike(gait) - _strike(other)))
        base = None if fitted.base is None else _beside(gait, np.roll(fitted.base, shift, axis=0))
        return Gait(
            gait.time, np.roll(fitted.q, shift, axis=0), base=base, periodic=True, source=other.source
        )
    step = gait.duration / (n if gait.periodic else n - 1)
    even = other.resampled(max(round(other.duration / step) + 1, 2))
    rows = np.minimum(np.arange(n), len(even) - 1)
    base = None if even.base is None else _beside(gait, even.base[rows])
    return Gait(gait.time, even.q[rows], base=base, source=other.source)


def alignment_note(gait: Gait, other: Gait) -> str:
    """How `aligned` lays another gait over the first, in one sentence."""
    if gait.periodic and other.periodic:
        return "The ghost's cycle is laid over the walk's, from left heel strike to left heel strike."
    return "The ghost starts together with the walk, whatever its phase, and waits at its end."


def _strike(gait: Gait) -> float:
    """Phase of the first left heel strike, 0 to 1; 0 where the gait has none."""
    times = [event.time for event in gait.events if (event.side, event.kind) == ("left", "heel_strike")]
    return (times[0] - float(gait.time[0])) / gait.duration if times else 0.0


def _beside(gait: Gait, base: Array) -> Array:
    """The base poses `(n, 4, 4)` turned about the vertical and shifted level to a gait's own start."""
    own = np.eye(4)[None] if gait.base is None else gait.base
    (x, y), (u, v) = mean_heading(own), mean_heading(base)
    T = np.eye(4)
    T[:3, :3] = about((0.0, 0.0, 1.0), np.arctan2(y * u - x * v, x * u + y * v))
    T[:2, 3] = own[0, :2, 3] - T[:2, :2] @ base[0, :2, 3]
    return np.asarray(T @ base)

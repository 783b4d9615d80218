"""Long recordings with fewer samples for the page, and the largest error that this makes between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.gait import Gait

MOST_SHOWN = 200_000
"""Samples that a page holds: some 40 MB."""


@dataclass(frozen=True, eq=False)
class Decimated:
    """A recording with fewer samples.

    Attributes:
        gait: The recording at some of its samples.
        rows: Which of them.
        note: How far the rest is off, in a sentence; empty if all are there.
    """

    gait: Gait
    rows: Index | slice
    note: str


def decimated(gait: Gait, most: int = MOST_SHOWN) -> Decimated:
    """A recording with at most so many samples, evenly chosen, its last one among them.

    Args:
        gait: The walk; a cycle that repeats keeps all.
        most: Number of samples, at least 2.
    """
    n = len(gait)
    if gait.periodic or n <= most:
        return Decimated(gait, slice(None), "")
    rows = np.unique(np.linspace(0, n - 1, most).round().astype(int))
    base = None if gait.base is None else gait.base[rows]
    less = replace(gait, time=gait.time[rows], q=gait.q[rows], base=base)
    off = f"{np.degrees(_largest_error(gait.time, gait.q, rows)):.2f} degrees"
    if gait.base is not None:
        off += f" and the pelvis {1e3 * _largest_error(gait.time, gait.base[:, :3, 3], rows):.1f} mm"
    note = f"The page shows {len(rows)} of {n} samples; between them the angles are at most {off} off."
    return Decimated(less, rows, note)


def _largest_error(time: Array, values: Array, rows: Index) -> float:
    """Of the samples `(n, m)` from straight lines between some of their rows."""
    kept = time[rows]
    return max(float(np.abs(np.interp(time, kept, x[rows]) - x).max()) for x in values.T)

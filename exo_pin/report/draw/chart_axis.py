"""Axes of charts: round ticks, their labels, and the range that is shown."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike


def ticks(low: float, high: float, count: int = 5) -> list[float]:
    """Round numbers: 1, 2 or 5 times a power of ten.

    Args:
        low: Lower end of the axis.
        high: Upper end of the axis.
        count: About how many.
    """
    raw = (high - low) / max(count, 1)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * k for k in (1, 2, 5, 10) if power * k >= raw * 0.72)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def extent(values: list[ArrayLike], least: float, *, pad: float = 0.06) -> tuple[float, float]:
    """Lower and upper end of an axis for some values; 0 and 1 where none is finite.

    Args:
        values: Arrays of any shape; NaN and infinity do not count.
        least: Smallest extent of the axis.
        pad: Room at either end, as a share of the extent.
    """
    flat = np.concatenate([np.ravel(np.asarray(v, dtype=float)) for v in values] or [np.zeros(0)])
    flat = flat[np.isfinite(flat)]
    if not len(flat):
        return 0.0, 1.0
    low, high = float(flat.min()), float(flat.max())
    span = max(high - low, least, 1e-9 * max(abs(low), abs(high)), 1e-12)
    middle = (low + high) / 2
    return middle - span * (0.5 + pad), middle + span * (0.5 + pad)


def label(value: float, all_of_them: list[float]) -> str:
    """A tick's number with the decimals that its neighbours need."""
    step = all_of_them[1] - all_of_them[0] if len(all_of_them) > 1 else 1.0
    if step < 1e-4:
        return f"{value + 0.0:.0e}"
    digits = max(0, -math.floor(math.log10(step) + 1e-9))
    return f"{round(value, digits) + 0.0:.{digits}f}"

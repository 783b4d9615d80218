"""Starts: where an iteration begins again after it got stuck."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from exo_pin.arrays import Array


def starts(middle: Array, lower: Array, upper: Array, count: int) -> Iterator[Array]:
    """The middle of the joint ranges, then a low-discrepancy sequence over them (Roberts 2018, R_d).

    Always the same, so that an answer does not depend on what was solved before. Unlimited joints stay where
    `middle` has them.
    """
    bounded = np.isfinite(lower) & np.isfinite(upper)
    low, span = lower[bounded], (upper - lower)[bounded]
    root = 2.0
    for _ in range(40):  # the positive root of x**(d + 1) = x + 1
        root = (1.0 + root) ** (1.0 / (len(span) + 1))
    pace = root ** -np.arange(1.0, len(span) + 1.0)
    for i in range(count):
        q = middle.copy()
        q[bounded] = low + ((0.5 + i * pace) % 1.0) * span
        yield q

"""The step of a damped least-squares iteration inside a box: a small QP by an active set."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array

_ROUNDS = 30  # each round fixes or frees joints; a leg of six needs two or three


def box_step(A: Array, g: Array, lower: Array, upper: Array) -> Array:
    """The step x that minimises x.A.x / 2 - g.x subject to lower <= x <= upper.

    A is symmetric positive definite (m, m) and the box contains zero. A joint that would leave the box is
    held on its bound and the others are solved again; a held joint that the remaining force pulls inwards is
    set free (active set, Nocedal and Wright, Numerical Optimization, section 16.7).

    Returns:
        The step (m,), exactly within the box.
    """
    x: Array = np.linalg.solve(A, g).astype(float)
    if ((x >= lower) & (x <= upper)).all():
        return x
    held = np.zeros(len(g), dtype=bool)
    x[:] = 0.0
    for _ in range(_ROUNDS):
        free = ~held
        wish = x.copy()
        if free.any():
            rest = g[free] - A[np.ix_(free, held)] @ x[held]
            wish[free] = np.linalg.solve(A[np.ix_(free, free)], rest)
        share = _way(x, wish, lower, upper)
        x = np.minimum(np.maximum(x + share * (wish - x), lower), upper)
        if share < 1.0:
            held |= free & (((x <= lower) & (wish < x)) | ((x >= upper) & (wish > x)))
            continue
        pull = g - A @ x
        wrong = held & np.where(x >= upper, pull < 0.0, pull > 0.0) & (upper > lower)
        if not wrong.any():
            return x
        held[np.argmax(np.where(wrong, np.abs(pull), -1.0))] = False
    return x


def _way(x: Array, wish: Array, lower: Array, upper: Array) -> float:
    """The share of the way from x to the wish that stays within the box, at most 1."""
    d = wish - x
    with np.errstate(divide="ignore", invalid="ignore"):
        room = np.where(d > 0, (upper - x) / d, np.where(d < 0, (lower - x) / d, np.inf))
    return float(min(1.0, room.min()))

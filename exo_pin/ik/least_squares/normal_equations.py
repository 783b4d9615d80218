"""Small damped normal equations for many samples at once, within joint limits.

Arrays carry the samples on their last axis: J (k, 6, m), A (6, 6, m), g (6, m). The factorisation is
L D L^T without pivoting, safe because the damping makes every A positive definite.
"""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array, Mask

_ROUNDING = 1e-12  # of a pivot against its diagonal
_ROUNDS = 30  # rounds of fixing and freeing joints; what is unfinished is cut to the box and damped next


def normal(J: Array, e: Array) -> tuple[Array, Array]:
    """J^T J (6, 6, m) and J^T e (6, m)."""
    size = J.shape[1]
    A = np.empty((size, size, J.shape[2]))
    for i in range(size):
        for j in range(i + 1):
            A[i, j] = A[j, i] = _dots(J[:, i], J[:, j])
    return A, np.stack([_dots(J[:, i], e) for i in range(size)])


def solved(A: Array, g: Array) -> Array:
    """X of A x = g, A symmetric and positive definite; A is used up."""
    size = len(g)
    x = g.copy()
    for j in range(size - 1):
        ratio = A[j + 1 :, j] / A[j, j]
        for i in range(j + 1, size):
            A[i, j + 1 : i + 1] -= ratio[i - j - 1] * A[j + 1 : i + 1, j]
        x[j + 1 :] -= ratio * x[j]
    for j in range(size - 1, -1, -1):
        for i in range(j + 1, size):
            x[j] -= A[i, j] * x[i]
        x[j] /= A[j, j]
    return x


def definite(A: Array) -> Mask:
    """Which of the symmetric matrices (k, k, m) are positive definite by more than rounding (m,)."""
    size = len(A)
    B, least = A.copy(), _ROUNDING * A[range(size), range(size)]
    good = np.ones(A.shape[2], dtype=bool)
    with np.errstate(all="ignore"):  # what is not definite may run into anything
        for j in range(size):
            good &= B[j, j] > least[j]
            ratio = B[j + 1 :, j] / B[j, j]
            B[j + 1 :, j + 1 :] -= ratio[:, None] * B[j, j + 1 :]
    return good


def box_steps(A: Array, g: Array, lower: Array, upper: Array) -> Array:
    """Steps (6, m) that minimise x.A.x / 2 - g.x within lower <= x <= upper, sample by sample.

    The same active set as `boxstep.box_step`; only the samples whose free step leaves the box take part.
    """
    x = solved(A.copy(), g)
    out = ((x < lower) | (x > upper)).any(axis=0)
    if out.any():
        few = np.flatnonzero(out)
        x[:, few] = _inside(A[:, :, few], g[:, few], lower[:, few], upper[:, few])
    return x


def _inside(A: Array, g: Array, lower: Array, upper: Array) -> Array:
    x = np.zeros_like(g)
    held = np.zeros(g.shape, dtype=bool)
    busy = np.ones(g.shape[1], dtype=bool)
    for _ in range(_ROUNDS):
        wish = np.where(held, x, _held_solution(A, g, x, held))
        d = wish - x
        with np.errstate(divide="ignore", invalid="ignore"):
            room = np.where(d > 0, (upper - x) / d, np.where(d < 0, (lower - x) / d, np.inf))
        share = np.minimum(room.min(axis=0), 1.0)
        x = np.where(busy, np.minimum(np.maximum(x + share * d, lower), upper), x)
        held |= ((x <= lower) & (wish < x)) | ((x >= upper) & (wish > x))
        pull = g - _times(A, x)
        wrong = held & np.where(x >= upper, pull < 0.0, pull > 0.0) & (upper > lower) & (share == 1.0)
        busy = (share < 1.0) | wrong.any(axis=0)
        if not busy.any():
            break
        worst = np.argmax(np.where(wrong, np.abs(pull), -1.0), axis=0)
        loose = np.flatnonzero(wrong.any(axis=0))
        held[worst[loose], loose] = False
    return x


def _held_solution(A: Array, g: Array, x: Array, held: Mask) -> Array:
    """The minimiser over the free joints, the held ones where they are."""
    free = ~held
    rest = np.where(held, x, g - _times(A, np.where(held, x, 0.0)))
    B = A * (free[:, None] & free[None, :])
    for j in range(len(g)):
        B[j, j] += held[j]
    return solved(B, rest)


def _times(A: Array, x: Array) -> Array:
    return np.stack([_dots(A[i], x) for i in range(len(x))])


def _dots(a: Array, b: Array) -> Array:
    total = a[0] * b[0]
    for i in range(1, len(a)):
        total += a[i] * b[i]
    return np.asarray(total)

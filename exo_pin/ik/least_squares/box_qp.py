"""The step of an iteration: a small convex quadratic program (QP) within joint limits.

Minimise x.A.x / 2 - b.x over lower <= x <= upper, where A is the damped Hessian of half the cost, b the
negative gradient and the box what the joint limits leave. Arrays may carry many samples on a last axis:
A (J, J, m) and b (J, m), or (J, J) and (J,) for one.
"""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array, Mask

_ROUNDING = 1e-12  # of a pivot against its diagonal
_ROUNDS = 30  # rounds of the active set; a leg of six needs two or three


def normal_equations(J: Array, e: Array) -> tuple[Array, Array]:
    """J^T J (nv, nv, m) and J^T e (nv, m) of Jacobians (k, nv, m) and residuals (k, m)."""
    size = J.shape[1]
    A = np.empty((size, size, J.shape[2]))
    for i in range(size):
        for j in range(i + 1):
            A[i, j] = A[j, i] = _dots(J[:, i], J[:, j])
    return A, np.stack([_dots(J[:, i], e) for i in range(size)])


def convex_hessian(gauss_newton: Array, second_order: Array, damping: Array | float, free: Mask) -> Array:
    """The damped Hessian over the free joints where it is positive definite, elsewhere Gauss-Newton's.

    A joint that is pressed against its limit is left where it is (projected Newton, Bertsekas 1982): a
    negative curvature there must not spoil the steps of the others.

    Args:
        gauss_newton: The positive semidefinite part of the Hessian (J, J, m) or (J, J).
        second_order: The other part, of the same shape.
        damping: Added to the diagonal (m,) or a number.
        free: The joints that move (J, m) or (J,); the others get a row of the identity.
    """
    span = np.arange(len(free))
    block = free[:, None] & free
    plain = np.where(block, gauss_newton, 0.0)
    plain[span, span] += np.where(free, damping, 1.0)
    whole = plain + np.where(block, second_order, 0.0)
    return np.where(definite(whole), whole, plain)


def newton_step(
    b: Array, gauss_newton: Array, second_order: Array, damping: Array | float, lower: Array, upper: Array
) -> Array:
    """The damped Newton step of many samples, or of one, within the box.

    Args:
        b: Negative gradients (J, m) or (J,).
        gauss_newton: The positive semidefinite part of the Hessian (J, J, m) or (J, J).
        second_order: The other part, of the same shape.
        damping: Added to the diagonal (m,) or a number.
        lower: Lower ends of the box, not above zero, of the shape of b.
        upper: Upper ends of the box, not below zero.
    """
    free = free_joints(b, lower, upper)
    A = convex_hessian(gauss_newton, second_order, damping, free)
    return box_step(A, np.where(free, b, 0.0), lower, upper)


def free_joints(b: Array, lower: Array, upper: Array) -> Mask:
    """The joints (J, m) or (J,) that are not pressed against a limit.

    Args:
        b: Negative gradients (J, m) or (J,); at a limit, that of a free joint points inwards.
        lower: Lower ends of the box, not above zero, of the shape of b.
        upper: Upper ends of the box, not below zero.
    """
    return np.asarray(((lower < 0.0) | (b > 0.0)) & ((upper > 0.0) | (b < 0.0)))


def definite(A: Array) -> Mask:
    """Which of the symmetric matrices (k, k, m) are positive definite by more than rounding (m,)."""
    if A.ndim == 2:
        return np.asarray(_cholesky_exists(A))
    size = len(A)
    B, least = A.copy(), _ROUNDING * A[range(size), range(size)]
    good = np.ones(A.shape[2:], dtype=bool)
    with np.errstate(all="ignore"):  # what is not definite may run into anything
        for j in range(size):
            good &= B[j, j] > least[j]
            ratio = B[j + 1 :, j] / B[j, j]
            B[j + 1 :, j + 1 :] -= ratio[:, None] * B[j, j + 1 :]
    return good


def _cholesky_exists(A: Array) -> bool:
    try:
        np.linalg.cholesky(A)
    except np.linalg.LinAlgError:
        return False
    return True


def box_step(A: Array, b: Array, lower: Array, upper: Array) -> Array:
    """The step x that minimises x.A.x / 2 - b.x subject to lower <= x <= upper.

    Only the samples whose free step leaves the box go through the active set.

    Args:
        A: Symmetric positive definite matrices (J, J, m) or (J, J).
        b: Right-hand sides (J, m) or (J,).
        lower: Lower ends of the box, not above zero, of the shape of b.
        upper: Upper ends of the box, not below zero.

    Returns:
        The steps, of the shape of b, exactly within the box.
    """
    x = _solution(A, b)
    out = (x < lower) | (x > upper)
    if not np.count_nonzero(out):
        return x
    if b.ndim == 1:
        return _active_set(A, b, lower, upper)
    few = np.flatnonzero(out.any(axis=0))
    x[:, few] = _active_set(A[:, :, few], b[:, few], lower[:, few], upper[:, few])
    return x


def _active_set(A: Array, b: Array, lower: Array, upper: Array) -> Array:
    """The step by an active set (Nocedal and Wright, Numerical Optimization, section 16.5).

    A joint that would leave the box is held on its bound and the others are solved again; of the held joints
    whose gradient points inwards, the one with the largest is set free.
    """
    x, held = np.zeros_like(b), np.zeros(b.shape, dtype=bool)
    joints = np.arange(len(b)).reshape(-1, *[1] * (b.ndim - 1))
    busy = np.ones(b.shape[1:], dtype=bool)
    for _ in range(_ROUNDS):
        minimiser = np.where(held, x, _held_solution(A, b, x, held))
        length = _step_length(x, minimiser - x, lower, upper)
        x = np.where(busy, np.minimum(np.maximum(x + length * (minimiser - x), lower), upper), x)
        held |= ((x <= lower) & (minimiser < x)) | ((x >= upper) & (minimiser > x))
        full = length == 1.0
        if not full.any():
            continue
        descent = b - _times(A, x)
        inward = held & np.where(x >= upper, descent < 0.0, descent > 0.0) & (upper > lower) & full
        busy = ~full | inward.any(axis=0)
        if not busy.any():
            break
        worst = np.argmax(np.where(inward, np.abs(descent), -1.0), axis=0)
        held &= ~(inward & (joints == worst))
    return x


def _step_length(x: Array, d: Array, lower: Array, upper: Array) -> Array:
    """The largest step length along d from x that stays within the box, at most 1: (m,), or a number."""
    room = np.full(d.shape, np.inf)
    np.divide(np.where(d > 0.0, upper, lower) - x, d, out=room, where=d != 0.0)
    return np.asarray(np.minimum(room.min(axis=0), 1.0))


def _held_solution(A: Array, b: Array, x: Array, held: Mask) -> Array:
    """The minimiser over the free joints, the held ones where they are."""
    free = ~held
    rest = np.where(held, x, b - _times(A, np.where(held, x, 0.0)))
    B = A * (free[:, None] & free)
    span = np.arange(len(b))
    B[span, span] += held
    return _solution(B, rest)


def _solution(A: Array, b: Array) -> Array:
    """X of A x = b, A symmetric and positive definite: by LAPACK for one sample, which costs 10 us.

    For many, L D L^T over all samples at once, without pivoting: damping makes every A positive definite.
    """
    if b.ndim == 1:
        return np.asarray(np.linalg.solve(A, b))
    size, A, x = len(b), A.copy(), b.copy()
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


def _times(A: Array, x: Array) -> Array:
    if x.ndim == 1:
        return np.asarray(A @ x)
    return np.stack([_dots(A[i], x) for i in range(len(x))])


def _dots(a: Array, b: Array) -> Array:
    total = a[0] * b[0]
    for i in range(1, len(a)):
        total += a[i] * b[i]
    return np.asarray(total)

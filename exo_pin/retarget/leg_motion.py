"""Motion of a leg that cannot do all of a walk: the ankle first, then no jumps, then the foot's attitude.

All samples are solved together by Levenberg-Marquardt steps, joint limits kept by projection (two-metric
projection, Bertsekas 1982): least squares of the ankle's place, the foot's attitude with a small weight, and
what joints turn between two samples beyond a bound.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.ik.least_squares.rotation_vector import rotation_vector
from exo_pin.robot import SubtreeArrays

ANKLE_FIRST = (3e-3, 3e-4)
"""Weights of a radian of attitude against metres of the ankle, one solution the start of the next: with the
last an ankle within reach is off by some 1e-7 m."""

BALANCED = (0.1,)
"""The weight where the ankle cannot be placed: a degree of the foot counts as 1.7 mm, so that no leg twists
for the sake of millimetres."""

_STEP = 10.0
"""Weight of a radian beyond the largest step against metres of the ankle."""

_MOST_STEPS = 100
_SLOW, _PATIENCE = 1e-5, 3  # the search ends after so many steps with so small a relative decrease
_ZERO = 1e-22  # a cost that is rounding alone


@dataclass(frozen=True, eq=False)
class LegTask:
    """What a leg is to do.

    Attributes:
        arrays: The joints of the leg's chain, zero as it stands, and the foot that they carry.
        drive: What each joint of the chain moves by, over the motion of the k free joints (K, k).
        lower: Lower limits of the free joints (k,) [rad].
        upper: Upper limits of the free joints (k,) [rad].
        ankle: The ankle's place as the leg stands (3,) [m].
        places: The ankle's goals (n, 3) [m].
        attitudes: Goals of the foot's rotation from where it stands (n, 3, 3).
        largest_step: What a joint may turn between two samples [rad].
        periodic: Whether the first sample follows the last one.
    """

    arrays: SubtreeArrays
    drive: Array
    lower: Array
    upper: Array
    ankle: Array
    places: Array
    attitudes: Array
    largest_step: float
    periodic: bool


def solve(task: LegTask, start: Array, weights: tuple[float, ...]) -> Array:
    """Values (n, k) of the free joints [rad].

    Args:
        task: The leg and its goals.
        start: Where to start (n, k) [rad].
        weights: Of a radian of attitude against metres of the ankle, one after the other.
    """
    q = np.clip(start, task.lower, task.upper)
    for attitude in weights:
        q = _solved(task, q, attitude)
    return q


def _solved(task: LegTask, q: Array, attitude: float) -> Array:
    """Values (n, k) with a weight of the attitude."""
    damping, slow = 1e-6, 0
    cost, gradient, blocks, across = _normal(task, q, attitude)
    for _ in range(_MOST_STEPS):
        free = ~(((q <= task.lower) & (gradient > 0)) | ((q >= task.upper) & (gradient < 0)))
        tried = np.clip(q - _step(gradient, blocks, across, free, damping), task.lower, task.upper)
        trial = _normal(task, tried, attitude)
        if trial[0] < cost:
            slow = slow + 1 if cost - trial[0] <= _SLOW * cost else 0
            q, (cost, gradient, blocks, across) = tried, trial
            damping = max(damping / 10, 1e-12)
            if slow == _PATIENCE or cost < _ZERO:
                break
        else:
            damping *= 10
            if damping > 1e3:
                break
    return q


def _normal(task: LegTask, q: Array, attitude: float) -> tuple[float, Array, Array, Array]:
    """Cost, gradient (n, k), diagonal blocks (n, k, k) and the diagonals beside them (n - 1, k)."""
    residual, jacobian = _residual(task, q, attitude)
    gradient = np.einsum("nij,ni->nj", jacobian, residual)
    blocks = np.einsum("nij,nil->njl", jacobian, jacobian)
    cost = 0.5 * float((residual**2).sum())
    across = np.zeros((len(q) - 1, q.shape[1]))
    diagonal = np.einsum("nkk->nk", blocks)  # a view
    step = np.diff(q, axis=0)
    over = np.sign(step) * np.maximum(np.abs(step) - task.largest_step, 0.0) * _STEP
    steep = np.where(over != 0, _STEP**2, 0.0)
    cost += 0.5 * float((over**2).sum())
    gradient[1:] += _STEP * over
    gradient[:-1] -= _STEP * over
    diagonal[1:] += steep
    diagonal[:-1] += steep
    across -= steep
    if task.periodic:  # the corner block would not be banded: twice its diagonal bounds it from above
        last = q[0] - q[-1]
        over = np.sign(last) * np.maximum(np.abs(last) - task.largest_step, 0.0) * _STEP
        steep = np.where(over != 0, 2 * _STEP**2, 0.0)
        cost += 0.5 * float((over**2).sum())
        gradient[0] += _STEP * over
        gradient[-1] -= _STEP * over
        diagonal[0] += steep
        diagonal[-1] += steep
    return cost, gradient, blocks, across


def _residual(task: LegTask, q: Array, attitude: float) -> tuple[Array, Array]:
    """Weighted errors (n, 6) of place and attitude, and their derivatives (n, 6, k)."""
    pose = task.arrays.pose(task.drive @ q.T)
    R, p = pose.R[0].transpose(2, 0, 1), pose.p[0].T
    ankle = R @ task.ankle + p
    turned = rotation_vector(task.attitudes.transpose(1, 2, 0), pose.R[0]).T
    axes, points = pose.axes.transpose(2, 1, 0), pose.points.transpose(2, 1, 0)  # (n, K, 3)
    moved = np.cross(axes, ankle[:, None] - points)
    residual = np.concatenate([ankle - task.places, attitude * turned], axis=1)
    full = np.concatenate([moved, attitude * axes], axis=2)  # (n, K, 6)
    return residual, np.einsum("nkc,kj->ncj", full, task.drive)


def _step(gradient: Array, blocks: Array, across: Array, free: Mask, damping: float) -> Array:
    """The step (n, k) of the joints that are free, from the banded normal equations."""
    from scipy.linalg import solveh_banded

    n, k = gradient.shape
    mask = free[:, :, None] & free[:, None, :]
    band = np.zeros((k + 1, n * k))  # of the upper triangle, its diagonal in the last row
    inner = np.where(mask, blocks, 0.0)
    for d in range(k):
        rows = np.arange(k - d)
        diagonal = inner[:, rows, rows + d]
        band[k - d].reshape(n, k)[:, d:] = diagonal
    band[k].reshape(n, k)[...] += np.where(free, damping, 1.0)
    both = free[1:] & free[:-1]
    band[0].reshape(n, k)[1:] = np.where(both, across, 0.0)
    right = np.where(free, gradient, 0.0).reshape(-1)
    return np.asarray(solveh_banded(band, right, check_finite=False)).reshape(n, k)

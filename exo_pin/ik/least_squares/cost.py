"""Cost, gradient and Hessian of the targets of a subtree, for many samples at once.

Points on one rigid frame enter only through sums, however many they are: their weight W, centre c, and the
moments B = sum w^2 d e^T and D = sum w^2 d d^T of lever arms d = x - c and errors e. With l_j the velocity of
c and a_j the angular velocity that joint j causes, f = 1/2 sum w^2 |e|^2 has

    gradient      = -l_j . sum w^2 e - a_j . sum w^2 d x e
    Gauss-Newton  = W l_i . l_j + a_i . (tr D - D) a_j
    second order  = -a_i . (l_j x sum w^2 e + (B - tr B) a_j),   joint i carrying joint j

and its Hessian is Gauss-Newton + second order. A rotation that is missed by the rotation vector t adds
-t . a_j to the gradient, a_i . a_j to Gauss-Newton, and -k (t x a_i) . (t x a_j) - t . (a_i x a_j) / 2 to the
second order, with k from the inverse Jacobian of the rotation vector (`rotation_vector.curvature_factor`).
The second order vanishes where targets are met; at a compromise it does not, and without it the steps of an
iteration only creep (Nocedal and Wright, Numerical Optimization, section 10.3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.arrays import Array, Index
from exo_pin.ik.least_squares.kernel import Evaluation
from exo_pin.ik.least_squares.rotation_vector import curvature_factor, rotation_vector
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal
from exo_pin.robot import SubtreeArrays
from exo_pin.robot.subtree_arrays import SubtreePose, times


class WeightedTarget(NamedTuple):
    """The target of one frame in the axes of the world at q = 0, m samples on the last axis.

    Attributes:
        local: Points on the frame (3, k) [m].
        p: Where they shall be (3, k, m) [m].
        weight: Squared weights of the points (k, m).
        R: Rotation since q = 0 that the frame shall have (3, 3, m), or None.
        rotation_weight: Squared weight of the rotation.
    """

    local: Array
    p: Array
    weight: Array
    R: Array | None
    rotation_weight: float

    def only(self, samples: Index) -> WeightedTarget:
        """Some of the samples."""
        R = None if self.R is None else self.R[..., samples]
        return self._replace(p=self.p[..., samples], weight=self.weight[..., samples], R=R)


class _Sums(NamedTuple):
    """Cost (m,), errors (2, F, m), gradient (J, m), both parts of the Hessian (J, J, m), added up."""

    cost: Array
    errors: Array
    gradient: Array
    gauss_newton: Array
    second_order: Array


def weighted_targets(arrays: SubtreeArrays, goals: list[Goal], settings: Dls) -> list[WeightedTarget]:
    """The goals of a subtree with all weights multiplied in.

    Args:
        arrays: The joints.
        goals: One for each frame of the subtree.
        settings: Weights of position and rotation.
    """
    out = []
    for goal, T in zip(goals, arrays.frames, strict=True):
        R = None if goal.R is None else np.ascontiguousarray(goal.R.transpose(1, 2, 0))
        out.append(
            WeightedTarget(
                local=T[:3, :3] @ goal.local.T + T[:3, 3:],
                p=np.ascontiguousarray(goal.p.transpose(2, 1, 0)),
                weight=np.ascontiguousarray((settings.position_weight * goal.weight).T ** 2),
                R=None if R is None else np.einsum("abm,cb->acm", R, T[:3, :3]),
                rotation_weight=(settings.rotation_weight * goal.rotation_weight) ** 2,
            )
        )
    return out


def evaluate(arrays: SubtreeArrays, targets: list[WeightedTarget], q: Array) -> Evaluation:
    """The sum of squared weighted errors, with the gradient and the Hessian of its half.

    Args:
        arrays: The joints.
        targets: One for each frame, m samples.
        q: Configurations (J, m).

    Returns:
        The cost, and as its model the gradient (J, m), the Gauss-Newton part (J, J, m) and the second-order
        part (J, J, m) of the Hessian.
    """
    pose = arrays.pose(q)
    count, m = q.shape
    sums = _Sums(
        np.zeros(m),
        np.full((2, len(targets), m), np.nan),
        np.zeros((count, m)),
        np.zeros((count, count, m)),
        np.zeros((count, count, m)),
    )
    for f, target in enumerate(targets):
        own = np.flatnonzero(arrays.moves[f])
        angular = pose.axes[:, own] * arrays.revolute[own, None]
        _add_points(sums, arrays, pose, target, f, own, angular)
        if target.R is not None:
            _add_rotation(sums, pose.R[f], target, f, own, angular)
    model = sums.gradient, sums.gauss_newton, mirrored(sums.second_order)
    return Evaluation(sums.cost, sums.errors, model)


def points_second_order(linear: Array, angular: Array, force: Array, B: Array) -> Array:
    """The second order of weighted points on one frame (J, J), or (J, J, m); see `mirrored`.

    Args:
        linear: Velocity of a reference point of the frame that each joint causes (3, J) or (3, J, m).
        angular: Angular velocity of the frame that each joint causes, of the same shape.
        force: Sum of the squared weights times the errors (3,) or (3, m).
        B: Moments of the lever arms from the reference point with them (3, 3) or (3, 3, m).
    """
    return _dots(angular, _cross(force, linear) - _times(B, angular) + np.trace(B) * angular)


def rotation_second_order(angular: Array, t: Array, angle: npt.ArrayLike) -> Array:
    """The second order of a rotation missed by a rotation vector (J, J), or (J, J, m); see `mirrored`.

    Args:
        angular: Angular velocity of the frame that each joint causes (3, J) or (3, J, m).
        t: Rotation vector (3,) or (3, m).
        angle: Its length, a number or (m,) [rad].
    """
    across = _cross(t, angular)
    return 0.5 * _dots(angular, across) - curvature_factor(angle) * _dots(across, across)


def mirrored(A: Array) -> Array:
    """The half above the diagonal of matrices (J, J, ...) on both sides: there, joint i carries joint j."""
    row = np.arange(len(A))
    upper = row[:, None] <= row
    return np.where(upper.reshape(*upper.shape, *[1] * (A.ndim - 2)), A, A.swapaxes(0, 1))


def _add_points(
    sums: _Sums,
    arrays: SubtreeArrays,
    pose: SubtreePose,
    target: WeightedTarget,
    f: int,
    own: Index,
    angular: Array,
) -> None:
    x = np.einsum("abm,bk->akm", pose.R[f], target.local) + pose.p[f][:, None]
    e = target.p - x
    distance = np.sqrt((e * e).sum(axis=0))
    sums.errors[0, f] = np.where(target.weight > 0.0, distance, 0.0).max(axis=0)
    weighted = target.weight * e
    sums.cost[:] += (weighted * e).sum(axis=(0, 1))
    W, force = target.weight.sum(axis=0), weighted.sum(axis=1)
    centre = (target.weight * x).sum(axis=1) / np.where(W > 0.0, W, 1.0)
    d = x - centre[:, None]
    B = (d[:, None] * weighted).sum(axis=2)
    D = (d[:, None] * (target.weight * d)).sum(axis=2)
    torque = np.stack([B[1, 2] - B[2, 1], B[2, 0] - B[0, 2], B[0, 1] - B[1, 0]])
    linear = np.where(
        arrays.revolute[own, None], _cross(angular, centre[:, None] - pose.points[:, own]), pose.axes[:, own]
    )
    sums.gradient[own] -= (linear * force[:, None]).sum(axis=0) + (angular * torque[:, None]).sum(axis=0)
    square = np.ix_(own, own)
    inertia = np.trace(D) * angular - times(D, angular)
    sums.gauss_newton[square] += _dots(W * linear, linear) + _dots(angular, inertia)
    sums.second_order[square] += points_second_order(linear, angular, force, B)


def _add_rotation(sums: _Sums, R: Array, target: WeightedTarget, f: int, own: Index, angular: Array) -> None:
    assert target.R is not None
    t = rotation_vector([list(row) for row in R], [list(row) for row in target.R])
    angle = np.sqrt((t * t).sum(axis=0))
    sums.errors[1, f] = angle
    weight = target.rotation_weight
    sums.cost[:] += weight * angle**2
    sums.gradient[own] -= weight * (angular * t[:, None]).sum(axis=0)
    square = np.ix_(own, own)
    sums.gauss_newton[square] += weight * _dots(angular, angular)
    sums.second_order[square] += weight * rotation_second_order(angular, t, angle)


def _cross(v: Array, b: Array) -> Array:
    """Cross products: (3,) x (3, J) for one sample; for many, (3, m) or (3, J, m) x (3, J, m)."""
    if b.ndim == 2:
        return np.asarray(pin.skew(v) @ b)
    return np.stack([v[1] * b[2] - v[2] * b[1], v[2] * b[0] - v[0] * b[2], v[0] * b[1] - v[1] * b[0]])


def _times(A: Array, b: Array) -> Array:
    return np.asarray(A @ b) if b.ndim == 2 else times(A, b)


def _dots(a: Array, b: Array) -> Array:
    """Every a with every b: (3, J), (3, J) -> (J, J), or (3, J, m), (3, J, m) -> (J, J, m)."""
    if a.ndim == 2:
        return np.asarray(a.T @ b)
    return np.asarray(a[0, :, None] * b[0] + a[1, :, None] * b[1] + a[2, :, None] * b[2])

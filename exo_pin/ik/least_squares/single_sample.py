"""The cost of one sample on any subtree, on Pinocchio: floating bases and all kinds of joints.

For samples that start from the answer of the one before, and for a control loop. The kernel holds one sample,
so that n is 1 in the shapes of its arguments.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Index
from exo_pin.ik.least_squares.box_qp import box_step, newton_step
from exo_pin.ik.least_squares.cost import mirrored, points_second_order, rotation_second_order
from exo_pin.ik.least_squares.kernel import Evaluation, Schedule, spread_point
from exo_pin.ik.targets import Goal
from exo_pin.robot import Subtree

_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
_SKEW = np.array([pin.skew(axis).ravel() for axis in np.eye(3)])
"""Takes vectors (m, 3) to their cross-product matrices (m, 9)."""
_FLOOR = 1e-13  # of the damping: it keeps the equations definite at a singular pose
_SHORT = 1e-10  # a step this short changes nothing any more [rad, m]
_ROUNDED = 1e-8  # the next quadratic step is below rounding
_EXACT = Schedule(untaken=_SHORT)
_COMPROMISE = Schedule(untaken=_SHORT, rounded=_ROUNDED)
_NOISY = Schedule(untaken=1e-7, to_minimum=True)
_NOISY_COMPROMISE = Schedule(untaken=1e-7, rounded=_ROUNDED, to_minimum=True)


@dataclass(frozen=True, eq=False)
class SampleKernel:
    """A subtree and the targets of one sample.

    Attributes:
        subtree: The joints.
        data: Pinocchio's data of the subtree's model.
        goals: One for each frame of the subtree.
        k: Which of the goals' samples it is.
        position_weight: Weight of a position error [1/m].
        rotation_weight: Weight of a rotation error [1/rad].
        compromise: The targets cannot all be met, so that Newton steps with the whole Hessian are the shorter
            way; the base is fixed.
        damping: What leaving `start` costs [m/rad].
        start: The configuration (nq,) that it is costly to leave, moved into the limits.
    """

    subtree: Subtree
    data: Any
    goals: list[Goal]
    k: int
    position_weight: float = 1.0
    rotation_weight: float = 1.0
    compromise: bool = False
    damping: float = 0.0
    start: Array | None = None

    @property
    def schedule(self) -> Schedule:
        """The numbers of the iteration; with noise it goes on to the minimum, where steps may be longer."""
        if self.damping:
            return _NOISY_COMPROMISE if self.compromise else _NOISY
        return _COMPROMISE if self.compromise else _EXACT

    def only(self, samples: Index) -> SampleKernel:
        """The same: there is one sample."""
        return self

    def inside(self, q: Array) -> Array:
        """The configuration (nq, 1) moved into the limits."""
        return np.minimum(np.maximum(q, self.subtree.lower[:, None]), self.subtree.upper[:, None])

    def evaluate(self, q: Array) -> Evaluation:
        """The cost; its model: residual, Jacobian, the second order of a compromise, the way to `start`."""
        at = q[:, 0]
        e, J, errors = self._residual(at)
        cost, model = e @ e, [e[:, None], J[..., None]]
        if self.compromise:
            model.append(self._second_order()[..., None])
        if self.damping and self.start is not None:
            away = self.subtree.difference(at, self.inside(self.start[:, None])[:, 0])
            cost = cost + self.damping**2 * (away @ away)
            model.append(away[:, None])
        return Evaluation(np.array([cost]), errors[..., None], tuple(model))

    def step(self, q: Array, now: Evaluation, damping: Array) -> Array:
        """The damped step (nv, 1) within the limits.

        Args:
            q: The configuration (nq, 1).
            now: The cost there.
            damping: Added to the diagonal of the Hessian (1,).
        """
        e, J, *more = (x[..., 0] for x in now.model)
        A, b, box = J.T @ J, J.T @ e, self.subtree.box(q[:, 0])
        added = damping[0] + self.damping**2 + _FLOOR
        if self.damping:
            b += self.damping**2 * more[-1]
        if self.compromise:
            return newton_step(b, A, more[0], added, *box)[:, None]
        A.reshape(-1)[:: len(A) + 1] += added
        return box_step(A, b, *box)[:, None]

    def moved(self, q: Array, step: Array) -> Array:
        """The configuration (nq, 1) after a step, rounding kept inside the limits."""
        return self.subtree.moved(q[:, 0], step[:, 0])[:, None]

    def restart(self, i: int, q: Array) -> Array:
        """The middle of the joint ranges, then all over them."""
        lower, upper = self.subtree.lower[:, None], self.subtree.upper[:, None]
        return spread_point(i, lower, upper, self.subtree.middle[:, None])

    def _residual(self, q: Array) -> tuple[Array, Array, Array]:
        """Weighted error (k,), its Jacobian (k, nv), distances and angles (2, F)."""
        model, data, k = self.subtree.model, self.data, self.k
        pin.computeJointJacobians(model, data, q)
        parts, jacobians, errors = [], [], np.full((2, len(self.goals)), np.nan)
        for f, (index, goal) in enumerate(zip(self.subtree.ids, self.goals, strict=True)):
            M = pin.updateFramePlacement(model, data, index)
            J = pin.getFrameJacobian(model, data, index, _AXES).reshape(6, -1)  # one joint: (6,)
            e, J_points, errors[0, f] = _points(goal, k, M, J)
            parts.append(self.position_weight * e)
            jacobians.append(self.position_weight * J_points)
            if goal.R is not None:
                t, weight = pin.log3(goal.R[k] @ M.rotation.T), self.rotation_weight * goal.rotation_weight
                errors[1, f] = np.sqrt(t @ t)
                parts.append(weight * t)
                jacobians.append(weight * J[3:])
        return np.concatenate(parts), np.concatenate(jacobians), errors

    def _second_order(self) -> Array:
        """The second order (nv, nv) where `_residual` was evaluated last."""
        model, data, k = self.subtree.model, self.data, self.k
        H = np.zeros((model.nv, model.nv))
        for index, goal in zip(self.subtree.ids, self.goals, strict=True):
            M, J = data.oMf[index], pin.getFrameJacobian(model, data, index, _AXES).reshape(6, -1)
            arms = goal.local @ M.rotation.T
            squared = (self.position_weight * goal.weight[k]) ** 2
            forces = squared[:, None] * (goal.p[k] - M.translation - arms)
            H += points_second_order(J[:3], J[3:], forces.sum(axis=0), arms.T @ forces)
            if goal.R is not None:
                t, weight = pin.log3(goal.R[k] @ M.rotation.T), self.rotation_weight * goal.rotation_weight
                H += weight**2 * rotation_second_order(J[3:], t, np.sqrt(t @ t))
        return mirrored(H)


def _points(goal: Goal, k: int, M: Any, J: Array) -> tuple[Array, Array, float]:
    """Weighted error (3m,) of the m points of a frame at M, its Jacobian (3m, nv), the largest distance."""
    if len(goal.local) == 1 and not goal.local.any():  # a pose or a position: the frame's own origin
        e, weight = goal.p[k, 0] - M.translation, goal.weight[k, 0]
        return weight * e, weight * J[:3], float(np.sqrt(e @ e)) if weight else 0.0
    arms, weight = goal.local @ M.rotation.T, goal.weight[k]
    e = goal.p[k] - M.translation - arms
    distance = np.sqrt(np.einsum("ij,ij->i", e, e))
    J_points = J[:3] - (arms @ _SKEW).reshape(-1, 3, 3) @ J[3:]  # a rotation w moves an arm's end by w x arm
    J_points *= weight[:, None, None]
    worst = float((distance * (weight > 0)).max())
    return (weight[:, None] * e).ravel(), J_points.reshape(-1, J.shape[1]), worst

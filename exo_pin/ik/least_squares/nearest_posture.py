"""The nearest posture of a leg to one target pose: projected Newton steps on Pinocchio, for a control loop.

The cost is that of `leg_kernel`: squared distance plus squared angle. Each step solves

    (J^T J + damping I) x = J^T e,    lower <= q + x <= upper

where joints pressed against a limit are held there (projected Newton, Bertsekas 1982, SIAM J Control Optim
20(2):221-246) and the damping is a multiple of the cost (Sugihara 2011). A step of one sample costs some
50 us, a quarter of what the iteration for many samples (`driver`) costs with one.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import dist
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.robot.leg_axes import LEG_JOINTS, LegAxes
from exo_pin.robot.subtree import frame_index

_LOCAL = pin.ReferenceFrame.LOCAL
_dot, _solve = np.dot, np.linalg.solve  # found once: an inner loop
_FLOOR = 1e-13  # of the damping: it keeps the equations definite at a singular pose
_LESS, _MORE = 0.25, 16.0  # factors of the damping after a step that lowered the cost, or did not
_GAIN = 1e-5  # of the cost: a second step that promises less is not worth its time; the next sample goes on
_ROUNDS = 4  # of a step: in each, the joints that would leave their limits are held
_DIAGONAL = slice(None, None, LEG_JOINTS + 1)


class NearestPosture:
    """The nearest posture of one leg within its limits, followed from sample to sample."""

    def __init__(
        self, leg: LegAxes, *, tolerance: float, max_iterations: int, weights: Sequence[float] = (1.0, 1.0)
    ) -> None:
        """Prepare Pinocchio's model of the leg alone.

        Args:
            leg: The leg.
            tolerance: A target is met, and the iteration ends, below this error [m, rad].
            max_iterations: Steps for one sample.
            weights: Of a position error [1/m] and of a rotation error [1/rad].
        """
        self._weights = None if set(weights) == {1.0} else np.repeat(weights, 3)
        self._leg, self._met, self._max_iterations = leg, tolerance**2, max_iterations
        self._lower, self._upper = leg.lower, leg.upper
        self._model = bare_legs([leg])
        self._data, self._tip = self._model.createData(), frame_index(self._model, leg.frame)

    def of_two_starts(self, q: Array, seed: Array, target: Any, *, promising: bool) -> Array:
        """The posture (6,) followed from q; that from a second start where q leads to a worse minimum.

        A minimum is left only for a start that lies nearer to the target already, or reaches it: others, that
        differ little, would take turns from sample to sample.

        Args:
            q: Where the leg is (6,) [rad].
            seed: The second start (6,) [rad].
            target: Target pose of the leg's frame (Pinocchio's SE3), the robot at its own placement.
            promising: Whether the second start may reach the target although its own cost is higher.
        """
        there = self._evaluate(seed, target)[0]
        if there <= self._met:
            return seed
        posture, cost = self.from_start(q, target)
        nearer = there < cost
        if nearer or (promising and cost > self._met and self._within_reach(target)):
            other, least = self.from_start(seed, target)
            return other if nearer or least <= self._met else posture
        return posture

    def between(self, before: Array, after: Array, targets: Sequence[Any]) -> Array:
        """Postures (m, 6) of a stretch followed from both ends, joined where the largest step is least.

        Args:
            before: Angles (6,) of the sample before the stretch [rad].
            after: Angles (6,) of the sample after it [rad].
            targets: m target poses (SE3), one after another.
        """
        there, back = [before], [after]
        for target in targets:
            there.append(self.from_start(there[-1], target)[0])
        for target in reversed(targets):
            back.append(self.from_start(back[-1], target)[0])
        F, B = np.array(there), np.array(back[::-1])  # F[k + 1] and B[k] answer target k
        rise = np.maximum.accumulate(np.append(0.0, _largest_steps(F)))  # of F up to k
        fall = np.maximum.accumulate(np.append(_largest_steps(B), 0.0)[::-1])[::-1]  # of B from k on
        k = int(np.argmin(np.maximum(np.maximum(rise, fall), np.abs(B - F).max(axis=1))))
        return np.concatenate([F[1 : k + 1], B[k:-1]])

    def _within_reach(self, target: Any) -> bool:
        """Whether the leg is long enough for the target, or may be."""
        ankle = target.act(self._leg.ankle_in_frame)
        return dist(ankle, self._leg.hip) < self._leg.reach + self._leg.reach_error

    def from_start(self, q: Array, target: Any) -> tuple[Array, float]:
        """The posture (6,) that a start leads to in a few steps, and its cost, never above the start's.

        Args:
            q: The start (6,) [rad]; it is moved into the limits.
            target: Target pose of the leg's frame (Pinocchio's SE3), the robot at its own placement.
        """
        q = np.minimum(np.maximum(q, self._lower), self._upper)
        cost, e, J = self._evaluate(q, target)
        factor = 1.0
        for k in range(self._max_iterations):
            if cost <= self._met:
                break
            A, b = _dot(J.T, J), _dot(e, J)
            A.reshape(-1)[_DIAGONAL] += factor * cost + _FLOOR
            x = _bounded_step(A, b, (self._lower - q).tolist(), (self._upper - q).tolist())
            if k and _dot(b, x) <= _GAIN * cost:
                break
            trial = np.minimum(np.maximum(q + x, self._lower), self._upper)  # rounding stays inside
            there = self._evaluate(trial, target)
            if there[0] < cost:
                q, (cost, e, J) = trial, there
                factor *= _LESS
            else:
                factor *= _MORE
        return q, cost

    def _evaluate(self, q: Array, target: Any) -> tuple[float, Array, Array]:
        """Cost, error (6,) and Jacobian (6, 6), linear then angular, in the axes of the leg's frame."""
        pin.computeJointJacobians(self._model, self._data, q)
        apart = pin.updateFramePlacement(self._model, self._data, self._tip).actInv(target)
        e = np.empty(LEG_JOINTS)
        e[:3], e[3:] = apart.translation, pin.log3(apart.rotation)
        J = pin.getFrameJacobian(self._model, self._data, self._tip, _LOCAL)
        if self._weights is not None:
            e *= self._weights
            J = self._weights[:, None] * J
        return float(_dot(e, e)), e, J


def bare_legs(legs: Sequence[LegAxes]) -> Any:
    """Pinocchio's model of nothing but the legs' joints and tips: half the cost of the whole robot's."""
    model = pin.Model()
    for own in legs:
        parent, before = 0, np.zeros(3)
        for j in range(LEG_JOINTS):
            place = pin.SE3(np.eye(3), own.points[j] - before)
            joint = pin.JointModelRevoluteUnaligned(own.axes[j])
            parent, before = model.addJoint(parent, joint, place, f"{own.frame}_{j}"), own.points[j]
        tip = pin.SE3(own.tip[:3, :3], own.tip[:3, 3] - before)
        model.addFrame(pin.Frame(own.frame, parent, tip, pin.FrameType.BODY))
    return model


def _largest_steps(q: Array) -> Array:
    """The largest change of an angle between each sample and the next (m - 1,)."""
    return np.asarray(np.abs(np.diff(q, axis=0)).max(axis=1))


def _bounded_step(A: Array, b: Array, low: list[float], high: list[float]) -> Array:
    """A step within the box that lowers x.A.x / 2 - b.x; joints held on a bound get a row of the identity.

    Args:
        A: Symmetric positive definite matrix (6, 6); it is changed.
        b: Negative gradient (6,).
        low: Lower ends of the box (6), not above zero.
        high: Upper ends of the box (6), not below zero.
    """
    right = b.copy()
    descent = b.tolist()
    x = [low[j] if descent[j] < 0.0 else high[j] for j in range(LEG_JOINTS)]
    _hold([j for j in range(LEG_JOINTS) if x[j] == 0.0], x, A, right)
    for _ in range(_ROUNDS):
        x = _solve(A, right).tolist()
        out = [j for j in range(LEG_JOINTS) if not low[j] <= x[j] <= high[j]]
        if not out:
            break
        x = [min(max(x[j], low[j]), high[j]) for j in range(LEG_JOINTS)]
        _hold(out, x, A, right)
    return np.array(x)


def _hold(joints: list[int], x: list[float], A: Array, right: Array) -> None:
    """Take joints (at x) out of the equations A x = right."""
    for j in joints:
        if x[j]:
            right -= x[j] * A[j]
        A[j] = 0.0
        A[:, j] = 0.0
        A[j, j], right[j] = 1.0, x[j]

"""The best motion of a subtree whose joints have limited velocities: all samples in one problem.

The least sum of squared errors over the whole motion, every joint within its limits and moving no further
from sample to sample than its step limit. What exceeds a step limit costs its square, more and more so, until
hardly anything is left of it (penalty method, Nocedal and Wright, Numerical Optimization, section 17.1). Each
step is a damped Newton step, projected on the joint limits (Bertsekas 1982). Its equations couple only
neighbouring samples, hence are banded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from exo_pin.arrays import Array, Index, Mask
from exo_pin.ik.least_squares.box_qp import convex_hessian, free_joints
from exo_pin.ik.least_squares.cost import WeightedTarget, evaluate, weighted_targets
from exo_pin.ik.least_squares.driver import minimise
from exo_pin.ik.least_squares.kernel import Evaluation, Schedule
from exo_pin.ik.problem import problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Target
from exo_pin.robot import Robot, SubtreeArrays

_PENALTIES = (30.0, 3e4)
"""Of a squared excess [m^2/rad^2], one after the other; the last leaves about 1e-5 rad."""
_FEW = 40  # samples that are solved without a coarser motion first
_ROUNDS = 10  # Newton steps within a quadratic model
_SHORT = 1e-6  # a step this short changes nothing any more [rad, m]
_SETTINGS = Dls(max_iterations=60)


def velocity_limited(
    robot: Robot, targets: Mapping[str, Target], start: Array, limits: Array, *, base: Array
) -> Array:
    """The motion that `start` leads to.

    Args:
        robot: A robot of revolute and prismatic joints, its base given.
        targets: As in `exo_pin.ik.track`, n samples.
        start: Configurations (n, nq).
        limits: How far each joint may move between neighbouring samples (n - 1, nq) [rad, m]; (n, nq) closes
            the cycle: the last row is from the last sample to the first.
        base: T_world_pelvis (n, 4, 4).

    Returns:
        Configurations (n, nq); `start` itself for a subtree that keeps its step limits there.
    """
    task, q = problem(robot, targets, start, base), np.array(start)
    lower, upper = robot.lower[:, None], robot.upper[:, None]
    for subtree in task.subtrees:
        arrays, columns = subtree.arrays, subtree.columns
        assert arrays is not None  # as the docstring says
        weighted = weighted_targets(arrays, task.goals_of(subtree), _SETTINGS)
        motion = _Motion(arrays, weighted, lower[columns], upper[columns], limits[:, columns].T)
        if motion.excess(q[:, columns].T).any():
            q[:, columns] = motion.best(q[:, columns].T).T
    return q


@dataclass(frozen=True, eq=False)
class _Motion:
    """The cost of a motion of n samples: to the iteration it is a single sample of J n coordinates.

    Attributes:
        arrays: The joints.
        targets: One for each frame, n samples.
        lower: Lower limits (J, 1).
        upper: Upper limits (J, 1).
        limits: Step limits (J, n - 1), or (J, n) for a closed cycle.
        penalty: What the square of an excess costs [m^2/rad^2].
    """

    arrays: SubtreeArrays
    targets: list[WeightedTarget]
    lower: Array
    upper: Array
    limits: Array
    penalty: float = _PENALTIES[-1]

    schedule: ClassVar[Schedule] = Schedule(
        damping=1e-3, least=1e-9, relative=False, to_minimum=True, untaken=_SHORT, decline=1e-6
    )

    def best(self, q: Array) -> Array:
        """Where the configurations (J, n) lead as the penalty rises.

        Every other sample is solved first: an excess spreads from neighbour to neighbour, and fine motions
        would take many steps.
        """
        q, fine = np.clip(q, self.lower, self.upper), q.shape[1] > _FEW
        if fine:
            q = self._between(self._coarser().best(q[:, ::2]), q)
        for penalty in _PENALTIES[-1:] if fine else _PENALTIES:
            q = minimise(replace(self, penalty=penalty), q.reshape(-1, 1), _SETTINGS).q.reshape(q.shape)
        return q

    def excess(self, q: Array) -> Array:
        """By how much each move between neighbours exceeds its limit, with its sign (J, n - 1 or n)."""
        move = np.roll(q, -1, axis=1)[:, : self.limits.shape[1]] - q[:, : self.limits.shape[1]]
        return np.asarray(move - np.clip(move, -self.limits, self.limits))

    def only(self, samples: Index) -> _Motion:
        """The same: there is one motion."""
        return self

    def inside(self, q: Array) -> Array:
        """Coordinates (J n, 1) moved into the limits."""
        return np.clip(self._joints(q), self.lower, self.upper).reshape(-1, 1)

    def evaluate(self, q: Array) -> Evaluation:
        """The cost; its model: gradient (J, n, 1) and Hessian (J, J, n, 1) of all errors, and the excess."""
        x = self._joints(q)
        now, excess = evaluate(self.arrays, self.targets, x), self.excess(x)
        cost = float(now.cost.sum() + self.penalty * (excess * excess).sum())
        model = tuple(part[..., None] for part in (*now.model, excess))
        return Evaluation(np.array([cost]), np.full((2, 1, 1), np.nan), model)

    def step(self, q: Array, now: Evaluation, damping: Array) -> Array:
        """The damped Newton step (J n, 1) of all samples together, cut at the joint limits.

        Args:
            q: Coordinates (J n, 1).
            now: The cost there.
            damping: Added to the diagonal of the Hessian (1,).
        """
        gradient, gauss_newton, second_order, excess = (part[..., 0] for part in now.model)
        at = self._joints(q)
        b = self.penalty * _balance(excess, at.shape[1]) - gradient
        free = free_joints(b, self.lower - at, self.upper - at)
        A = convex_hessian(gauss_newton, second_order, np.full(at.shape[1], damping[0]), free)
        place, band = _banded(A)
        x = np.zeros_like(at)
        for _ in range(_ROUNDS):  # the quadratic model with its kinks, by Newton steps of its own
            over = self.excess(at + x)
            b = -gradient - np.einsum("ijm,jm->im", A, x) + self.penalty * _balance(over, at.shape[1])
            stiff = self.penalty * (over != 0.0)
            more = _coupled_step(place, band, np.where(free, b, 0.0), stiff, free)
            x = np.clip(at + x + more, self.lower, self.upper) - at
            if np.abs(more).max() < _SHORT:
                break
        return np.asarray(x.reshape(-1, 1))

    def moved(self, q: Array, step: Array) -> Array:
        """The coordinates (J n, 1) after a step, rounding kept inside the limits."""
        return self.inside(q + step)

    def _joints(self, q: Array) -> Array:
        """Coordinates (J n, 1) as configurations (J, n)."""
        return q.reshape(len(self.lower), -1)

    def _coarser(self) -> _Motion:
        """Every other sample, from the first."""
        n, moves = self.targets[0].p.shape[-1], self.limits.shape[1]
        stay = np.arange(0, n, 2)
        count = len(stay) - (moves < n)
        summed = np.add.reduceat(self.limits, np.arange(0, moves, 2), axis=1)[:, :count]
        return replace(self, targets=[target.only(stay) for target in self.targets], limits=summed)

    def _between(self, coarse: Array, q: Array) -> Array:
        """The coarse samples and the middles between them; an odd one at an open end stays as it was."""
        q = q.copy()
        q[:, ::2] = coarse
        beyond = np.roll(coarse, -1, axis=1) if self.limits.shape[1] == q.shape[1] else coarse[:, 1:]
        count = min(beyond.shape[1], q.shape[1] // 2)
        q[:, 1 : 2 * count : 2] = 0.5 * (coarse[:, :count] + beyond[:, :count])
        return q


def _balance(excess: Array, n: int) -> Array:
    """What the excesses of its moves do to each sample (J, n): it is drawn towards its neighbours."""
    whole = np.zeros((len(excess), n))
    whole[:, : excess.shape[1]] = excess
    return np.asarray(whole - np.roll(whole, 1, axis=1))


def _banded(A: Array) -> tuple[Index, Array]:
    """Where each sample stands in the equations of all (m,), and the blocks A (J, J, m) as a lower band.

    Samples are numbered from both ends inwards, so that a closed cycle has a band of two blocks as well.
    """
    size, n = A.shape[1:]
    place = np.empty(n, dtype=np.int64)
    place[: (n + 1) // 2], place[(n + 1) // 2 :] = np.arange(0, n, 2), np.arange(1, n, 2)[::-1]
    band = np.zeros((2 * size + 1, size * n))  # band[i - j, j] = H[i, j]
    for i in range(size):
        for j in range(i + 1):
            band[i - j, size * place + j] = A[i, j]
    return place, band


def _coupled_step(place: Index, band: Array, g: Array, stiff: Array, free: Mask) -> Array:
    """X (J, m) of the equations of all samples, with springs `stiff` between free neighbours added."""
    from scipy.linalg import solveh_banded

    size, n = g.shape
    joint, a = np.nonzero(stiff)
    b = (a + 1) % n
    spring, at, bt = stiff[joint, a], size * place[a] + joint, size * place[b] + joint
    whole = band.copy()
    np.add.at(whole[0], at, spring * free[joint, a])
    np.add.at(whole[0], bt, spring * free[joint, b])
    both = free[joint, a] & free[joint, b]
    np.subtract.at(whole, (np.abs(at - bt), np.minimum(at, bt)), spring * both)
    right = np.empty((n, size))
    right[place] = g.T
    x = solveh_banded(whole, right.ravel(), lower=True, overwrite_ab=True, check_finite=False)
    return np.asarray(x.reshape(n, size)[place].T)

"""The best motion of a subtree whose joints have limited speeds: all samples in one problem.

The least sum of squared errors over the whole motion, every joint within its limits and moving no further
from sample to sample than its pace. An excess over the pace costs its square, more and more so, until hardly
anything is left of it (penalty method, Nocedal and Wright, Numerical Optimization, section 17.1); each step
is a damped Newton step with the second derivatives of `pull`, projected on the joint limits (Bertsekas 1982).
Its equations couple only neighbouring samples, hence are banded.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from exo_pin.arrays import Array, Index, Mask
from exo_pin.ik.least_squares.cost import Aim, Pull, aims, pull
from exo_pin.ik.least_squares.subtree_kernel import SETTLED, curvature
from exo_pin.ik.problem import problem
from exo_pin.ik.targets import Target
from exo_pin.robot import Robot, SubtreeArrays

_PRICES = (30.0, 3e4)
"""What the square of an excess costs [m^2/rad^2], one after the other; the last leaves about 1e-5 rad."""
_FEW = 40  # samples that are settled without a coarser motion first
_ROUNDS = 10  # Newton steps within a quadratic model
_STEPS = 60  # Newton steps for each price
_STILL = 1e-6  # a step this small changes nothing any more [rad, m]
_WEAK = 1e-6  # nor does such a share of the cost
_DAMPING, _CALMER, _STRONGER = 1e-3, 0.25, 4.0
_FLOOR = 1e-9  # keeps the equations definite where joints are redundant [m^2/rad^2]


def paced(robot: Robot, targets: Mapping[str, Target], start: Array, pace: Array, *, base: Array) -> Array:
    """The motion that `start` leads to.

    Args:
        robot: A robot of plain turns and slides, its base given.
        targets: As in `exo_pin.ik.track`, n samples.
        start: Configurations (n, nq).
        pace: How far each joint may move between neighbouring samples (n - 1, nq); (n, nq) closes the cycle:
            the last row is from the last sample to the first.
        base: T_world_pelvis (n, 4, 4).

    Returns:
        Configurations (n, nq); `start` itself for a subtree that keeps the pace there.
    """
    task, q = problem(robot, targets, start, base), np.array(start)
    lower, upper = robot.lower[:, None], robot.upper[:, None]
    for subtree in task.subtrees:
        joints = subtree.arrays
        assert joints is not None  # as the docstring asks
        aimed = aims(joints, task.goals_of(subtree), slice(0, task.n), SETTLED)
        motion = _Motion(
            joints, aimed, lower[subtree.columns], upper[subtree.columns], pace[:, subtree.columns].T
        )
        if motion.excess(q[:, subtree.columns].T).any():
            q[:, subtree.columns] = motion.settled(q[:, subtree.columns].T).T
    return q


@dataclass(frozen=True, eq=False)
class _Motion:
    """A subtree over time: its joints, what they aim at, their limits (J, 1) and paces (J, n - 1 or n)."""

    joints: SubtreeArrays
    aimed: list[Aim]
    lower: Array
    upper: Array
    pace: Array

    def settled(self, q: Array) -> Array:
        """Where the configurations (J, n) lead as the price of an excess rises.

        Every other sample is settled first: an excess spreads from neighbour to neighbour, and fine motions
        would take many steps.
        """
        q, fine = np.clip(q, self.lower, self.upper), q.shape[1] > _FEW
        if fine:
            q = self._between(self._coarser().settled(q[:, ::2]), q)
        for price in _PRICES[-1:] if fine else _PRICES:
            q = self._descended(q, price)
        return q

    def excess(self, q: Array) -> Array:
        """By how much each move between neighbours exceeds the pace, with its sign (J, n - 1 or n)."""
        move = _moves(q, self.pace.shape[1])
        return np.asarray(move - np.clip(move, -self.pace, self.pace))

    def _coarser(self) -> _Motion:
        """Every other sample, from the first."""
        n, moves = self.aimed[0].p.shape[-1], self.pace.shape[1]
        stay = np.arange(0, n, 2)
        count = len(stay) - (moves < n)
        summed = np.add.reduceat(self.pace, np.arange(0, moves, 2), axis=1)[:, :count]
        return replace(self, aimed=[aim.only(stay) for aim in self.aimed], pace=summed)

    def _between(self, coarse: Array, q: Array) -> Array:
        """The coarse samples and the middles between them; an odd one at an open end stays as it was."""
        q = q.copy()
        q[:, ::2] = coarse
        beyond = np.roll(coarse, -1, axis=1) if self.pace.shape[1] == q.shape[1] else coarse[:, 1:]
        count = min(beyond.shape[1], q.shape[1] // 2)
        q[:, 1 : 2 * count : 2] = 0.5 * (coarse[:, :count] + beyond[:, :count])
        return q

    def _descended(self, q: Array, price: float) -> Array:
        now, excess = pull(self.joints, self.aimed, q), self.excess(q)
        cost, factor = _total(now, excess, price), _DAMPING
        for _ in range(_STEPS):
            x = self._step(q, now, excess, price, factor)
            if np.abs(x).max() < _STILL:
                break
            trial = q + x
            there, over = pull(self.joints, self.aimed, trial), self.excess(trial)
            cost_there = _total(there, over, price)
            if cost_there < cost:
                done = cost - cost_there < _WEAK * cost
                q, now, excess, cost = trial, there, over, cost_there
                factor = max(factor * _CALMER, _FLOOR)
                if done:
                    break
            else:
                factor *= _STRONGER
        return q

    def _step(self, q: Array, now: Pull, excess: Array, price: float, factor: float) -> Array:
        """The damped Newton step of all samples together, cut at the joint limits (J, n)."""
        slope = now.slope + price * _pulled(excess, q.shape[1])
        free = ((q > self.lower) | (slope > 0.0)) & ((q < self.upper) | (slope < 0.0))
        A, x = curvature(now, np.full(q.shape[1], factor), free), np.zeros_like(q)
        place, band = _banded(A)
        for _ in range(_ROUNDS):  # the quadratic model with its kinks, by Newton steps of its own
            over = self.excess(q + x)
            down = now.slope - np.einsum("ijm,jm->im", A, x) + price * _pulled(over, q.shape[1])
            more = _coupled(place, band, np.where(free, down, 0.0), price * (over != 0.0), free)
            x = np.clip(q + x + more, self.lower, self.upper) - q
            if np.abs(more).max() < _STILL:
                break
        return np.asarray(x)


def _total(now: Pull, excess: Array, price: float) -> float:
    return float(now.cost.sum() + price * (excess * excess).sum())


def _moves(q: Array, count: int) -> Array:
    """From each sample to the next; with as many moves as samples, from the last to the first too."""
    return np.asarray(np.roll(q, -1, axis=1)[:, :count] - q[:, :count])


def _pulled(excess: Array, n: int) -> Array:
    """What the excesses of its moves do to each sample (J, n): towards its neighbours."""
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


def _coupled(place: Index, band: Array, g: Array, stiff: Array, free: Mask) -> Array:
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

"""Damped least squares for any subtree of turning and sliding joints, all samples at once.

For devices with fewer joints, whose feet cannot be everywhere: the answer is a compromise, and near a
compromise the Gauss-Newton steps of `dls` only creep. Each step here takes the whole second derivative
(`pull`), so that it converges quadratically; where that is not definite, Gauss-Newton's. Damping and limits
are those of `dls`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array, Index, Mask
from exo_pin.ik.least_squares import normal_equations
from exo_pin.ik.least_squares.cost import Aim, Pull, aims, pull
from exo_pin.ik.least_squares.restarts import starts
from exo_pin.ik.least_squares.sequential import reachable
from exo_pin.ik.problem import SOLVED_BY, Problem, SolutionBuffer, problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import CHUNK, Goal, Target
from exo_pin.robot import Robot, Subtree, SubtreeArrays

SETTLED = Dls(tolerance=1e-10)
"""Settings of a compromise: no target is expected to be met."""
_FLOOR = 1e-12  # keeps the equations definite where a joint moves nothing
_STUCK = 1e-11  # a step this small changes nothing any more [rad, m]
_ROUNDED = 1e-8  # the next quadratic step is below rounding: a cost that does not fall is at its least
_CALMER, _STRONGER = 0.25, 4.0


@dataclass(eq=False)
class Answers:
    """For m samples: configurations (J, m), errors (2, F, m), costs (m,), steps (m,)."""

    q: Array
    errors: Array
    cost: Array
    steps: Index

    def reached(self, tolerance: float) -> Mask:
        """Which samples meet all that is asked within the tolerance (m,)."""
        return np.asarray(np.nanmax(self.errors, axis=(0, 1)) <= tolerance)

    def take(self, where: Index, other: Answers, good: Mask) -> None:
        """Replace samples by the other's good ones, adding up the steps."""
        self.steps[where] += other.steps
        for name in ("q", "errors", "cost"):
            getattr(self, name)[..., where[good]] = getattr(other, name)[..., good]


def settle(
    robot: Robot,
    targets: Mapping[str, Target],
    seed: Array,
    lower: Array,
    upper: Array,
    *,
    base: Array,
    settings: Dls = SETTLED,
) -> Array:
    """The compromise that each sample's seed leads to, within limits of each sample's own.

    Args:
        robot: A robot of plain turns and slides, its base given.
        targets: As in `exo_pin.ik.track`.
        seed: Where each sample starts (n, nq).
        lower: Lower limits (n, nq); a joint between equal limits stands there.
        upper: Upper limits (n, nq).
        base: T_world_pelvis (n, 4, 4).
        settings: Tolerance, weights and number of steps; there are no restarts.

    Returns:
        Configurations (n, nq).
    """
    task, q = problem(robot, targets, seed, base), np.clip(seed, lower, upper)
    for subtree in task.subtrees:
        joints = subtree.arrays
        assert joints is not None  # as the docstring asks
        limits = lower[:, subtree.columns].T, upper[:, subtree.columns].T
        q[:, subtree.columns] = descend(
            joints, task.goals_of(subtree), seed[:, subtree.columns].T, *limits, settings
        ).q.T
    return q


def together(
    task: Problem, subtree: Subtree, joints: SubtreeArrays, settings: Dls, buffer: SolutionBuffer
) -> None:
    """Write the answers for one subtree, every sample from its own seed."""
    goals, places = task.goals_of(subtree), task.places_of(subtree)
    seed = np.broadcast_to(task.seed, (task.n, task.robot.nq))[:, subtree.columns].T
    out = descend(joints, goals, seed, subtree.lower, subtree.upper, settings)
    near = reachable(task, subtree, buffer)
    for start in starts(subtree.middle, subtree.lower, subtree.upper, settings.restarts):
        stuck = np.flatnonzero(near & ~out.reached(settings.tolerance))
        if not len(stuck):
            break
        some = [goal.only(stuck) for goal in goals]
        again = descend(
            joints, some, np.tile(start[:, None], len(stuck)), subtree.lower, subtree.upper, settings
        )
        out.take(stuck, again, again.reached(settings.tolerance))
    buffer.q[:, subtree.columns] = out.q.T
    buffer.errors[:, :, places] = out.errors.swapaxes(1, 2)
    buffer.steps[:] += out.steps
    buffer.solver[:] = SOLVED_BY.index("dls")


def descend(
    arrays: SubtreeArrays, goals: list[Goal], seed: Array, lower: Array, upper: Array, settings: Dls
) -> Answers:
    """The compromise that each seed leads to.

    Args:
        arrays: The joints.
        goals: One per frame of the subtree, n samples.
        seed: Where each sample starts (J, n).
        lower: Lower limits (J,), or (J, n); equal limits hold a joint.
        upper: Upper limits.
        settings: Tolerance, weights and number of steps.
    """
    low, high = (np.broadcast_to(np.reshape(x, (len(seed), -1)), seed.shape) for x in (lower, upper))
    count = seed.shape[1]
    out = Answers(
        np.clip(seed, low, high),
        np.full((2, len(goals), count), np.nan),
        np.zeros(count),
        np.zeros(count, dtype=np.int64),
    )
    for a in range(0, count, CHUNK):
        part = slice(a, min(a + CHUNK, count))
        pool = _Pool.of(arrays, aims(arrays, goals, part, settings), out, part, low, high)
        while len(pool.who):
            pool.step(arrays, settings)
            ended = pool.ended(settings)
            if 4 * ended.sum() >= len(ended):
                pool.leave(out, ended)
    return out


@dataclass(eq=False)
class _Pool:
    """Samples under way: who they are, what they aim at, where they stand, factor of the damping."""

    who: Index
    aimed: list[Aim]
    low: Array
    high: Array
    q: Array
    now: Pull
    factor: Array
    steps: Index

    @classmethod
    def of(
        cls, arrays: SubtreeArrays, aimed: list[Aim], out: Answers, part: slice, low: Array, high: Array
    ) -> _Pool:
        """Samples at their seeds."""
        who, q = np.arange(out.q.shape[1])[part], out.q[:, part]
        now = pull(arrays, aimed, q)
        return cls(who, aimed, low[:, part], high[:, part], q, now, np.ones(len(who)), np.zeros_like(who))

    def ended(self, settings: Dls) -> Mask:
        """Which samples have arrived, do not move any more, or have used up their steps."""
        arrived = np.nanmax(self.now.errors, axis=(0, 1)) <= settings.tolerance
        return np.asarray(arrived | (self.factor == np.inf) | (self.steps >= settings.max_iterations))

    def leave(self, out: Answers, ended: Mask) -> None:
        """Hand over the samples that have ended."""
        who = self.who[ended]
        out.q[:, who], out.errors[..., who] = self.q[:, ended], self.now.errors[..., ended]
        out.cost[who], out.steps[who] = self.now.cost[ended], self.steps[ended]
        stay = np.flatnonzero(~ended)
        for name in ("who", "low", "high", "q", "factor", "steps"):
            setattr(self, name, getattr(self, name)[..., stay])
        self.now, self.aimed = self.now.only(stay), [aim.only(stay) for aim in self.aimed]

    def step(self, arrays: SubtreeArrays, settings: Dls) -> None:
        """One damped step of every sample; a step that does not help is taken back and damped more."""
        damping = np.minimum(self.factor, 1e30) * self.now.cost + _FLOOR
        slope = self.now.slope
        free = ((self.q > self.low) | (slope > 0.0)) & ((self.q < self.high) | (slope < 0.0))
        A = curvature(self.now, damping, free & (self.low < self.high))
        x = normal_equations.box_steps(A, np.where(free, slope, 0.0), self.low - self.q, self.high - self.q)
        trial = np.minimum(np.maximum(self.q + x, self.low), self.high)
        then = pull(arrays, self.aimed, trial)
        better = then.cost < self.now.cost
        self.steps += ~self.ended(settings)
        if better.all():
            self.q, self.now = trial, then
        else:
            self.q, self.now = np.where(better, trial, self.q), self.now.where(better, then)
        self.factor *= np.where(better, _CALMER, _STRONGER)
        size = np.abs(x).max(axis=0)
        self.factor[(size < _STUCK) | ((size < _ROUNDED) & ~better)] = np.inf


def curvature(now: Pull, damping: Array, free: Mask) -> Array:
    """The damped second derivative (J, J, m) over the free joints; where it is indefinite, Gauss-Newton's.

    A joint that is pressed against its limit is left where it is (projected Newton, Bertsekas 1982): what
    bends the cost the wrong way there must not spoil the steps of the others.
    """
    span = np.arange(len(now.slope))
    block = free[:, None] & free
    plain = np.where(block, now.normal, 0.0)
    plain[span, span] += np.where(free, damping, 1.0)
    whole = plain + np.where(block, now.rest, 0.0)
    return np.where(normal_equations.definite(whole), whole, plain)

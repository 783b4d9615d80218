"""Levenberg-Marquardt iteration with restarts: the one loop that minimises every cost of this room.

A kernel computes a cost, its derivatives and the step within its limits; the loop accepts or rejects the
step, sets the damping and ends the iteration (Marquardt 1963; Nocedal and Wright, Numerical Optimization,
section 10.3). A step that does not lower the cost is taken back and the next one damped more; after a step
that does, the next one is damped less. The damping follows the residual (Sugihara 2011,
"Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method", IEEE T-RO 27(5)): it vanishes
at the target, so that convergence is quadratic, and stays where the target is out of reach, so that the step
remains bounded near singular poses (Nakamura and Hanafusa 1986).

The samples iterate together in a pool, which they leave when they have ended.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from exo_pin.arrays import Array, Index, Mask
from exo_pin.ik.least_squares.kernel import Evaluation, Kernel, RestartableKernel
from exo_pin.ik.settings import Dls

_LESS, _MORE = 0.25, 4.0  # factors of the damping after a step that lowered the cost, or did not
_MOST = 1e30  # damping factor of a sample that has ended: it stands still until it leaves
_POOL = 6000  # samples that iterate at once: what stays in a core's cache
_NEAR = 1e-6  # cost of a sample that creeps towards a target within its reach, a straight knee for example
_LEAVING = 4  # samples leave the pool when this fraction of it has ended, one in so many


QUICK = 50
"""Steps in which a start reaches a target that it can reach; without one the steps only creep."""


@dataclass(eq=False)
class Minimum:
    """Where the iterations of n samples ended.

    Attributes:
        q: Configurations (nq, n).
        errors: Distance [m] and angle [rad] of each frame (2, F, n); NaN where the rotation is free.
        cost: Costs (n,).
        steps: Steps spent (n,).
    """

    q: Array
    errors: Array
    cost: Array
    steps: Index

    def reached(self, tolerance: float) -> Mask:
        """Which samples meet all their targets within the tolerance (n,)."""
        return _largest(self.errors) <= tolerance

    def put(self, where: Index, other: Minimum) -> None:
        """Replace some samples by those of another result."""
        self.q[:, where], self.errors[..., where] = other.q, other.errors
        self.cost[where], self.steps[where] = other.cost, other.steps

    def only(self, samples: Index | Mask) -> Minimum:
        """Some of the samples."""
        return Minimum(self.q[:, samples], self.errors[..., samples], self.cost[samples], self.steps[samples])


def minimise_with_restarts(
    kernel: RestartableKernel,
    seed: Array,
    settings: Dls,
    *,
    retry: Mask,
    starts: Iterable[int] | None = None,
    first: Minimum | None = None,
) -> Minimum:
    """The minimum that each seed leads to; from other starts where that got stuck short of its targets.

    The answer of another start counts only where it meets the targets, so that a sample out of reach stays
    near its seed.

    Args:
        kernel: The cost of n samples.
        seed: Where each sample starts (nq, n).
        settings: Tolerance, number of steps and of restarts.
        retry: The samples (n,) whose targets another start may reach.
        starts: Numbers of the restarts; all if left out.
        first: Where the seeds have led to, if that is known.
    """
    out = minimise(kernel, seed, settings) if first is None else first
    for i in range(settings.restarts) if starts is None else starts:
        stuck = np.flatnonzero(retry & ~out.reached(settings.tolerance))
        if not len(stuck):
            break
        again = minimise(kernel.only(stuck), kernel.restart(i, out.q[:, stuck]), settings)
        again.steps += out.steps[stuck]
        out.steps[stuck] = again.steps
        good = again.reached(settings.tolerance)
        out.put(stuck[good], again.only(good))
    return out


def quick_minimum(
    kernel: RestartableKernel, seed: Array, settings: Dls, retry: Mask, starts: Iterable[int] | None = None
) -> Minimum:
    """`minimise_with_restarts` in few steps where the targets are far, in all of them where they are near.

    Args:
        kernel: The cost of n samples.
        seed: Where each sample starts (nq, n).
        settings: Tolerance, number of steps and of restarts.
        retry: The samples (n,) whose targets another start may reach.
        starts: Numbers of the restarts; all if left out.
    """
    out = minimise(kernel, seed, quick(settings))
    left = ~out.reached(settings.tolerance)
    for near, chosen in ((True, settings), (False, quick(settings))):
        part = np.flatnonzero(left & ((out.cost < _NEAR) == near))
        if len(part):
            own, known = kernel.only(part), None if near else out.only(part)
            again = minimise_with_restarts(
                own, seed[:, part], chosen, retry=retry[part], starts=starts, first=known
            )
            out.put(part, again)
    return out


def quick(settings: Dls, *, after_steps: bool = False) -> Dls:
    """The settings with few steps; `after_steps`: of those that are left after quick steps."""
    left = settings.max_iterations - (QUICK if after_steps else 0)
    return replace(settings, max_iterations=min(left, QUICK))


def minimise(kernel: Kernel, seed: Array, settings: Dls) -> Minimum:
    """The minimum that each seed leads to.

    Args:
        kernel: The cost of n samples.
        seed: Where each sample starts (nq, n); it is moved into the limits.
        settings: Tolerance and number of steps.
    """
    n = seed.shape[1]
    pool, out, begun = _Pool.of(kernel, seed, slice(0, _POOL)), None, _POOL
    while True:
        ended = pool.ended(settings)
        leaving = np.count_nonzero(ended)
        if _LEAVING * leaving < len(ended):
            pool.step(ended)
            continue
        if leaving == n:  # all samples at once: nothing to collect
            return pool.minimum()
        out = pool.blank(n) if out is None else out
        pool.leave(out, ended)
        if begun < n and len(pool.who) <= _POOL // 2:
            more = slice(begun, begun + _POOL - len(pool.who))
            pool.join(_Pool.of(kernel, seed, more), kernel)
            begun = more.stop
        if not len(pool.who):
            return out


@dataclass(eq=False)
class _Pool:
    """Samples under way: their numbers, configurations, costs, damping factors and steps spent."""

    kernel: Kernel
    who: Index
    q: Array
    now: Evaluation
    factor: Array
    steps: Index

    @classmethod
    def of(cls, kernel: Kernel, seed: Array, part: slice) -> _Pool:
        """Samples at their seeds.

        Args:
            kernel: The cost of all samples.
            seed: Where they start (nq, n).
            part: Which of them enter.
        """
        who = np.arange(seed.shape[1])[part]
        if len(who) < seed.shape[1]:
            kernel, seed = kernel.only(who), seed[:, part]
        q = kernel.inside(seed)
        factor = np.full(len(who), kernel.schedule.damping)
        return cls(kernel, who, q, kernel.evaluate(q), factor, np.zeros(len(who), dtype=np.int64))

    def ended(self, settings: Dls) -> Mask:
        """Which samples have arrived, do not move any more, or have used up their steps."""
        ended = (self.factor == np.inf) | (self.steps >= settings.max_iterations)
        if not self.kernel.schedule.to_minimum:
            ended |= _largest(self.now.errors) <= settings.tolerance
        return np.asarray(ended)

    def step(self, ended: Mask) -> None:
        """One damped step of every sample; a step that does not help is taken back and damped more."""
        kernel, schedule, now = self.kernel, self.kernel.schedule, self.now
        damping = np.minimum(self.factor, _MOST)
        x = kernel.step(self.q, now, damping * now.cost if schedule.relative else damping)
        self.steps += ~ended if np.count_nonzero(ended) else 1
        size = np.maximum.reduce(np.abs(x))
        untaken = size < schedule.untaken
        if np.count_nonzero(untaken) == len(size):
            self.factor[:] = np.inf
            return
        trial = kernel.moved(self.q, x)
        there = kernel.evaluate(trial)
        better = (there.cost < now.cost) & ~untaken
        last = untaken | (size < _chosen(better, schedule.last, schedule.rounded))
        if schedule.decline:
            last |= better & (now.cost - there.cost < schedule.decline * now.cost)
        self._accept(better, trial, there)
        self.factor *= _chosen(better, _LESS, _MORE)
        if schedule.least:
            np.maximum(self.factor, schedule.least, out=self.factor)
        if np.count_nonzero(last):
            self.factor[last] = np.inf

    def _accept(self, better: Mask, trial: Array, there: Evaluation) -> None:
        """Move the samples whose step lowered the cost."""
        count = np.count_nonzero(better)  # a fifth of what `all` and `any` cost for a single sample
        if count == len(better):
            self.q, self.now = trial, there
        elif count:
            self.q, self.now = np.where(better, trial, self.q), self.now.where(better, there)

    def minimum(self) -> Minimum:
        """The pool itself as the result."""
        return Minimum(self.q, self.now.errors, self.now.cost, self.steps)

    def blank(self, n: int) -> Minimum:
        """Room for the results of n samples."""
        q, errors = np.empty((len(self.q), n)), np.empty((*self.now.errors.shape[:-1], n))
        return Minimum(q, errors, np.empty(n), np.empty(n, dtype=np.int64))

    def leave(self, out: Minimum, ended: Mask) -> None:
        """Hand over the samples that have ended."""
        out.put(self.who[ended], self.minimum().only(ended))
        stay = np.flatnonzero(~ended)
        self.kernel, self.now = self.kernel.only(stay), self.now.only(stay)
        self.who, self.q = self.who[stay], self.q[:, stay]
        self.factor, self.steps = self.factor[stay], self.steps[stay]

    def join(self, other: _Pool, kernel: Kernel) -> None:
        """Take further samples in; `kernel` is the cost of all samples."""
        self.who = np.append(self.who, other.who)
        self.kernel, self.now = kernel.only(self.who), self.now.joined(other.now)
        self.q = np.append(self.q, other.q, axis=1)
        self.factor, self.steps = np.append(self.factor, other.factor), np.append(self.steps, other.steps)


def _chosen(better: Mask, yes: float, no: float) -> Array | float:
    """One of two numbers for each sample (m,); for a single one without the cost of an array."""
    if len(better) == 1:
        return yes if better[0] else no
    return np.where(better, yes, no)


def _largest(errors: Array) -> Array:
    """The largest error of each sample (m,); the NaN of a free rotation does not count."""
    return np.asarray(np.fmax.reduce(errors.reshape(-1, errors.shape[-1])))

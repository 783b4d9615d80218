"""The best motion of a subtree whose joints have limited velocities and accelerations: all samples at once.

The least sum of squared errors over the whole motion, every joint within its range and within its largest
speed and acceleration, between the samples too. Solved by a primal-dual interior-point method (Nocedal and
Wright, Numerical Optimization, section 19.3) with damped Newton steps; its equations couple only neighbouring
samples, hence are banded. A cycle is judged by its Fourier series, which may exceed a little what its pieces
keep: its limits are then tightened by that much, and it is solved again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.least_squares.box_qp import convex_hessian
from exo_pin.ik.least_squares.cost import WeightedTarget, evaluate, weighted_targets
from exo_pin.ik.least_squares.kernel import Evaluation
from exo_pin.ik.least_squares.limit_rows import CycleRows, LocalRows
from exo_pin.ik.least_squares.rate_rows import Clock
from exo_pin.ik.problem import problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Target
from exo_pin.robot import Robot, SubtreeArrays

_SETTINGS = Dls()
_FULL = 1500  # unknowns of a cycle that are solved with its Fourier series itself
_NO_LIMIT = 1e6  # stands for an infinite limit [rad/s, rad/s^2, m/s^2]
_INSIDE = 0.02  # a motion starts this share of a joint's range inside it
_SMOOTHINGS = (0, 1, 2, 4, 8, 16, 32, 64, 128, 256)  # passes over a start that jumps
_GOOD_START = 0.8  # share of the movement that a start may keep
_ROUNDS = 10  # times that a cycle's limits are tightened
_SPARE = 0.998  # what the tightening aims at
_STEPS = 120  # of the interior-point method
_GAP = 1e-8  # duality gap against the cost at which it ends
_LEAST_GAP = 1e-16  # the same where nothing is missed [m^2]
_DAMPING = 1e-9  # on the diagonal of the Hessian [m^2/rad^2]
_BOUNDARY = 0.99  # share of the way to the nearest limit that a step may go
_ARMIJO = 1e-4  # share of the expected decrease that a step must reach
_LONG = 0.8  # a step that goes this share of its way lets the barrier fall faster
_ROUNDING = 1e-14  # of the merit
_HALVINGS = 30


@dataclass(frozen=True, eq=False)
class RateLimits:
    """The largest rates of a robot's joints.

    Attributes:
        clock: The times of the samples.
        velocity: Largest speeds (J,) [rad/s, m/s].
        acceleration: Largest accelerations (J,) [rad/s^2, m/s^2]; infinite where there is no limit.
    """

    clock: Clock
    velocity: Array
    acceleration: Array

    def use(self, q: Array) -> Array:
        """Largest share of the limits (2, J) that a motion q (n, J) uses; above 1: more than there is."""
        speed, acceleration = self.clock.largest_rates(q)
        return np.stack([speed / self.velocity, acceleration / self.acceleration])


def rate_limited(
    robot: Robot, targets: Mapping[str, Target], start: Array, limits: RateLimits, *, base: Array
) -> Array:
    """The motion that `start` leads to.

    Args:
        robot: A robot of revolute and prismatic joints, its base given.
        targets: As in `exo_pin.ik.track`, n samples.
        start: Configurations (n, nq).
        limits: Of the robot's joints, on the clock of the samples.
        base: T_world_pelvis (n, 4, 4).

    Returns:
        Configurations (n, nq); `start` itself for a subtree that keeps its limits there.
    """
    task, q = problem(robot, targets, start, base), np.array(start)
    for subtree in task.subtrees:
        arrays, columns = subtree.arrays, subtree.columns
        assert arrays is not None  # as the docstring says
        mine = replace(limits, velocity=limits.velocity[columns], acceleration=limits.acceleration[columns])
        if (mine.use(q[:, columns]) > 1.0).any():
            weighted = weighted_targets(arrays, task.goals_of(subtree), _SETTINGS)
            whole = _Motion(arrays, weighted, mine, robot.lower[columns], robot.upper[columns])
            q[:, columns] = whole.best(q[:, columns])
    return q


@dataclass(frozen=True, eq=False)
class _Motion:
    """The motion of one subtree of J joints through n samples.

    Attributes:
        arrays: The joints.
        targets: One for each frame, n samples.
        limits: Of these joints.
        lower: Lower ends of the ranges (J,).
        upper: Upper ends of the ranges (J,).
    """

    arrays: SubtreeArrays
    targets: list[WeightedTarget]
    limits: RateLimits
    lower: Array
    upper: Array

    def best(self, q: Array) -> Array:
        """Where configurations (n, J) lead; tightened until the finely sampled motion keeps the limits."""
        share = np.full((2, len(self.lower)), _SPARE)
        for _ in range(_ROUNDS):
            barrier = self._barrier(share)
            q = barrier.minimum(self._inside(q, barrier))
            use = self.limits.use(q)
            if (use <= 1.0).all():
                return q
            share = share * np.minimum(_SPARE / np.maximum(use, _SPARE), 1.0)
        mean = q.mean(axis=0)
        return np.asarray(mean + (q - mean) / use.max())

    def _barrier(self, share: Array) -> _Barrier:
        clock = self.limits.clock
        limits = share * np.minimum([self.limits.velocity, self.limits.acceleration], _NO_LIMIT)
        whole = clock.period is not None and len(self.lower) * len(clock.time) <= _FULL
        rows = (CycleRows if whole else LocalRows).of(clock, *limits)
        return _Barrier(self.arrays, self.targets, rows, self.lower[:, None], self.upper[:, None])

    def _inside(self, q: Array, barrier: _Barrier) -> Array:
        """A motion (J, n) strictly within all limits: smoothed, and drawn towards its mean, if need be."""
        x, best = q.T, (0.0, np.array(q.T))
        room = _INSIDE * (self.upper - self.lower)
        for passes in _SMOOTHINGS:
            y = _smoothed(x, passes, closed=self.limits.clock.period is not None)
            centre = np.clip(y.mean(axis=1), self.lower + room, self.upper - room)[:, None]
            share = _BOUNDARY * min(1.0, barrier.largest_share(centre, y - centre))
            if share > best[0]:
                best = share, centre + share * (y - centre)
            if share >= _GOOD_START:
                break
        return best[1]


@dataclass(frozen=True, eq=False)
class _Point:
    """A motion (J, n), its distances from all limits, and its cost with the derivatives."""

    x: Array
    slack: Array
    now: Evaluation

    @property
    def cost(self) -> float:
        """Sum of the squared errors [m^2]."""
        return float(self.now.cost.sum())

    def merit(self, mu: float) -> float:
        """Half the cost, and the barrier."""
        return 0.5 * self.cost - mu * float(np.log(self.slack).sum())


@dataclass(frozen=True, eq=False)
class _Barrier:
    """The interior-point problem: half the squared errors over motions x (J, n) within linear limits.

    Attributes:
        arrays: The joints.
        targets: One for each frame, n samples.
        rows: Rates over their limits.
        lower: Lower ends of the ranges (J, 1).
        upper: Upper ends of the ranges (J, 1).
    """

    arrays: SubtreeArrays
    targets: list[WeightedTarget]
    rows: LocalRows | CycleRows
    lower: Array
    upper: Array

    def largest_share(self, centre: Array, away: Array) -> float:
        """Largest factor on a movement about a centre (J, 1) that keeps all limits."""
        ratios = [
            1.0 / max(float(np.abs(self.rows.rates(away)).max()), 1e-12),
            float(((self.upper - centre) / np.maximum(away, 1e-12)).min()),
            float(((centre - self.lower) / np.maximum(-away, 1e-12)).min()),
        ]
        return min(ratios)

    def minimum(self, x: Array) -> Array:
        """The minimum (n, J) that a motion (J, n) strictly within the limits leads to."""
        here = self._point(x)
        mu = max(0.1 * here.cost, _LEAST_GAP) / here.slack.size
        multiplier, every = mu / here.slack, np.ones(x.shape, dtype=bool)
        for _ in range(_STEPS):
            gradient, gauss_newton, second_order = here.now.model
            hessian = convex_hessian(gauss_newton, second_order, _DAMPING, every)
            pull = self._pushed(mu / here.slack) - gradient
            step = self._step(hessian, multiplier / here.slack, pull)
            change = self._change(step)
            growth = mu / here.slack - multiplier * (1.0 + change / here.slack)
            taken, here = self._searched(here, step, change, mu, float((pull * step).sum()))
            multiplier = multiplier + min(1.0, _BOUNDARY * _room(multiplier, growth)) * growth
            gap = float((multiplier * here.slack).sum())
            if gap <= max(_GAP * here.cost, _LEAST_GAP) or not taken:
                break
            mu = (0.1 if taken > _LONG else 0.5) * gap / here.slack.size
        return np.asarray(here.x.T)

    def _point(self, x: Array) -> _Point:
        return _Point(x, self._slack(x), evaluate(self.arrays, self.targets, x))

    def _searched(
        self, here: _Point, step: Array, change: Array, mu: float, expected: float
    ) -> tuple[float, _Point]:
        """The part of a step that lowers cost and barrier enough (Armijo's rule), and where it leads.

        Args:
            here: Where it starts.
            step: The step (J, n).
            change: What it does to the slacks.
            mu: Weight of the barrier [m^2].
            expected: Decrease of cost and barrier by their slope there.
        """
        share = min(1.0, _BOUNDARY * _room(here.slack, change))
        merit = here.merit(mu)
        for _ in range(_HALVINGS):
            there = self._point(here.x + share * step)
            inside = bool((there.slack > 0.0).all())
            if inside and there.merit(mu) <= merit - _ARMIJO * share * expected + _ROUNDING * abs(merit):
                return share, there
            share *= 0.5
        return 0.0, here

    def _slack(self, x: Array) -> Array:
        """Distances from every limit, one after the other."""
        rates = self.rows.rates(x)
        parts = (1.0 - rates, 1.0 + rates, self.upper - x, x - self.lower)
        return np.concatenate([part.ravel() for part in parts])

    def _change(self, step: Array) -> Array:
        """What a step does to the slacks."""
        rates = self.rows.rates(step)
        return np.concatenate([part.ravel() for part in (-rates, rates, -step, step)])

    def _split(self, values: Array) -> list[Array]:
        """Values of the slacks, of each kind by joint."""
        size = len(self.lower) * self.targets[0].p.shape[-1]
        rates = len(values) // 2 - size
        parts = np.split(values, [rates, 2 * rates, 2 * rates + size])
        return [part.reshape(len(self.lower), -1) for part in parts]

    def _pushed(self, force: Array) -> Array:
        """The transpose of `_change`: forces on the slacks as forces on the samples (J, n)."""
        above, below, high, low = self._split(force)
        return np.asarray(low - high + self.rows.forces(below - above))

    def _step(self, hessian: Array, stiffness: Array, pull: Array) -> Array:
        """The Newton step (J, n)."""
        above, below, high, low = self._split(stiffness)
        diagonal = np.arange(len(hessian))
        hessian[diagonal, diagonal] += high + low
        return self.rows.solution(hessian, above + below, pull)


def _room(values: Array, change: Array) -> float:
    """How many times a change fits until a positive value is zero."""
    shrinking = change < 0.0
    return float((values[shrinking] / -change[shrinking]).min(initial=np.inf))


def _smoothed(x: Array, passes: int, *, closed: bool) -> Array:
    """Samples (J, n) after passes of the weights 1, 2, 1."""
    for _ in range(passes):
        around = np.pad(x, ((0, 0), (1, 1)), mode="wrap" if closed else "edge")
        x = 0.25 * around[:, :-2] + 0.5 * x + 0.25 * around[:, 2:]
    return x

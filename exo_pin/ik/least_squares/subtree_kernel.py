"""The cost of any subtree of revolute and prismatic joints, all samples at once.

For devices with fewer joints, whose feet cannot be everywhere: the answer is a compromise, and near a
compromise Gauss-Newton steps only creep. Each step takes the whole Hessian (Newton's method), so that it
converges quadratically.

Step limits: the compromise with the least error may cease to be one from a sample to the next (the fold of a
local minimum), and the next best jumps, however slowly the target moves. So a joint whose target is missed
moves at most `_SPEED_RATIO` times as fast as it would have to if it followed the target alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.ik.least_squares.box_qp import newton_step
from exo_pin.ik.least_squares.cost import WeightedTarget, evaluate, weighted_targets
from exo_pin.ik.least_squares.kernel import Evaluation, Schedule, spread_point
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal
from exo_pin.robot import Subtree, SubtreeArrays

_FLOOR = 1e-12  # of the damping: it keeps the equations definite where a joint moves nothing
_SHORT = 1e-11  # a step this short changes nothing any more [rad, m]
_ROUNDED = 1e-8  # the next quadratic step is below rounding
_SPEED_RATIO = 2.0  # room for joints that share the work; with 1, compromises near a straight knee come late
_SHORTEST_ARM = 0.05  # [m] of a lever arm: a joint that hardly moves its frame has nothing to follow


@dataclass(frozen=True, eq=False)
class SubtreeKernel:
    """A subtree and the targets of n samples.

    Attributes:
        arrays: The joints.
        targets: One for each frame, n samples.
        lower: Lower limits (J, 1), or (J, n) where each sample has its own; equal limits hold a joint.
        upper: Upper limits, of the same shape.
    """

    arrays: SubtreeArrays
    targets: list[WeightedTarget]
    lower: Array
    upper: Array

    schedule: ClassVar[Schedule] = Schedule(last=_SHORT, rounded=_ROUNDED)

    @classmethod
    def of(cls, subtree: Subtree, goals: list[Goal], settings: Dls) -> SubtreeKernel:
        """The cost of a subtree within its limits.

        Args:
            subtree: Revolute and prismatic joints, without a floating base.
            goals: One for each frame, n samples.
            settings: The weights.
        """
        arrays = subtree.arrays
        assert arrays is not None  # as the docstring says
        targets = weighted_targets(arrays, goals, settings)
        return cls(arrays, targets, subtree.lower[:, None], subtree.upper[:, None])

    def only(self, samples: Index) -> SubtreeKernel:
        """Some of the samples."""
        lower, upper = (
            limit[:, samples] if limit.shape[1] > 1 else limit for limit in (self.lower, self.upper)
        )
        return SubtreeKernel(self.arrays, [target.only(samples) for target in self.targets], lower, upper)

    def inside(self, q: Array) -> Array:
        """Configurations (J, n) moved into the limits."""
        return np.minimum(np.maximum(q, self.lower), self.upper)

    def evaluate(self, q: Array) -> Evaluation:
        """The cost with its gradient and Hessian (`cost.evaluate`)."""
        return evaluate(self.arrays, self.targets, q)

    def step(self, q: Array, now: Evaluation, damping: Array) -> Array:
        """The damped Newton step (J, n) within the limits.

        Args:
            q: Configurations (J, n).
            now: The cost there.
            damping: Added to the diagonal of the Hessian (n,).
        """
        gradient, gauss_newton, second_order = now.model
        hessian = gauss_newton, second_order
        return newton_step(-gradient, *hessian, damping + _FLOOR, self.lower - q, self.upper - q)

    def moved(self, q: Array, step: Array) -> Array:
        """The configurations (J, n) after a step, rounding kept inside the limits."""
        return self.inside(q + step)

    def restart(self, i: int, q: Array) -> Array:
        """The middle of the joint ranges, then all over them."""
        start = spread_point(i, self.lower, self.upper, np.zeros(self.lower.shape))
        return np.array(np.broadcast_to(start, q.shape))


def step_limits(arrays: SubtreeArrays, goals: list[Goal]) -> Array:
    """The largest move of each joint to each sample from the one before (n, J) [rad], prismatic [m].

    It is `_SPEED_RATIO` times what the target's largest move so far requires of the joint: the path of its
    points over the lever arm, and the angle that it turns; of a prismatic joint, the path. The first sample
    has none before it: infinite.

    Args:
        arrays: The joints.
        goals: One for each frame, n samples.
    """
    most = np.zeros((len(goals[0].p), len(arrays.axes)))
    for f, goal in enumerate(goals):
        centre = arrays.frames[f, :3, :3] @ goal.local.mean(axis=0) + arrays.frames[f, :3, 3]
        arms = np.linalg.norm(np.cross(arrays.axes, centre - arrays.points), axis=1)
        arms = np.where(arrays.revolute, np.maximum(arms, _SHORTEST_ARM), 1.0)
        need = _paths(goal)[:, None] / arms + _angles(goal)[:, None] * arrays.revolute
        np.maximum(most, np.where(arrays.moves[f], need, 0.0), out=most)
    most = _SPEED_RATIO * np.maximum.accumulate(most, axis=0)
    most[0] = np.inf
    return most


def _paths(goal: Goal) -> Array:
    """How far the points move to each sample from the one before (n,) [m], those seen in both."""
    path = np.linalg.norm(np.diff(goal.p, axis=0), axis=2)
    seen = (goal.weight[1:] > 0.0) & (goal.weight[:-1] > 0.0)
    return np.append(0.0, np.where(seen, path, 0.0).max(axis=1))


def _angles(goal: Goal) -> Array:
    """How far the target turns to each sample from the one before (n,) [rad]."""
    if goal.R is None:
        return np.zeros(len(goal.p))
    chord = np.linalg.norm(np.diff(goal.R, axis=0), axis=(1, 2))
    return np.append(0.0, 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0)))

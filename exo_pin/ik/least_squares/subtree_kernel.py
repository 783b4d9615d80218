"""The cost of any subtree of revolute and prismatic joints, all samples at once.

For devices with fewer joints, whose feet cannot be everywhere: the answer is a compromise, and near a
compromise Gauss-Newton steps only creep. Each step takes the whole Hessian (Newton's method), so that it
converges quadratically.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.ik.least_squares.box_qp import newton_step
from exo_pin.ik.least_squares.cost import WeightedTarget, evaluate
from exo_pin.ik.least_squares.kernel import Evaluation, Schedule, spread_point
from exo_pin.robot import SubtreeArrays

_FLOOR = 1e-12  # of the damping: it keeps the equations definite where a joint moves nothing
_SHORT = 1e-11  # a step this short changes nothing any more [rad, m]
_ROUNDED = 1e-8  # the next quadratic step is below rounding


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

"""The cost of a leg of six revolute joints under full poses, component by component.

For legs whose axes are calibrated and hence have no closed form, for samples that a closed form could not
answer, and for seeds of one's own. Six equations for six joints: Gauss-Newton steps suffice.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.ik.least_squares.box_qp import box_step, normal_equations
from exo_pin.ik.least_squares.kernel import Evaluation, Schedule, spread_point
from exo_pin.ik.least_squares.rotation_vector import rotation_vector
from exo_pin.robot import LegAxes
from exo_pin.robot.leg_forward import Matrix, Number, components, pose_and_jacobian

_KNEE = 3  # row of the knee among the six joints
_KNEE_OFFSETS = (0.1, -0.1)  # [rad] restarts that leave the saddle of the cost at the straight leg
_FLOOR = 1e-15  # of the damping: it keeps the equations definite at a singular pose
_SHORT = 1e-11  # a step this short changes nothing any more [rad]


@dataclass(frozen=True, eq=False)
class LegKernel:
    """A leg and target poses of n samples.

    Attributes:
        leg: The leg.
        R: Target rotations, `R[i][j]` an array (n,).
        p: Target positions, `p[i]` an array (n,) [m].
        position_weight: Weight of a position error [1/m].
        rotation_weight: Weight of a rotation error [1/rad].
    """

    leg: LegAxes
    R: Matrix
    p: list[Number]
    position_weight: float = 1.0
    rotation_weight: float = 1.0

    schedule: ClassVar[Schedule] = Schedule(last=_SHORT, rounded=_SHORT)

    @classmethod
    def of(
        cls, leg: LegAxes, R: Array, p: Array, *, position_weight: float, rotation_weight: float
    ) -> LegKernel:
        """The cost of poses.

        Args:
            leg: The leg.
            R: Target rotations (n, 3, 3).
            p: Target positions (n, 3) [m].
            position_weight: Weight of a position error [1/m].
            rotation_weight: Weight of a rotation error [1/rad].
        """
        return cls(leg, *components(R, p), position_weight, rotation_weight)

    def only(self, samples: Index) -> LegKernel:
        """Some of the samples."""
        R: Matrix = [[np.asarray(x)[samples] for x in row] for row in self.R]
        return replace(self, R=R, p=[np.asarray(x)[samples] for x in self.p])

    def inside(self, q: Array) -> Array:
        """Angles (6, n) moved into the limits; the middle of the range for NaN."""
        low, high = self.leg.lower[:, None], self.leg.upper[:, None]
        return np.clip(np.where(np.isnan(q), 0.5 * (low + high), q), low, high)

    def evaluate(self, q: Array) -> Evaluation:
        """The sum of squared weighted errors; its model: residual (6, n) and Jacobian (6, 6, n)."""
        tip, J = pose_and_jacobian(self.leg, q)
        e = np.empty((6, q.shape[1]))
        for i in range(3):
            np.subtract(self.p[i], tip.p[i], out=e[i])
        e[3:] = rotation_vector(tip.R, self.R)
        errors = np.sqrt(np.stack([_squares(e[:3]), _squares(e[3:])]))
        for rows, weight in ((slice(3), self.position_weight), (slice(3, 6), self.rotation_weight)):
            if weight != 1.0:
                e[rows] *= weight
                J[rows] *= weight
        return Evaluation(_squares(e), errors[:, None], (e, J))

    def step(self, q: Array, now: Evaluation, damping: Array) -> Array:
        """The damped Gauss-Newton step (6, n) within the limits.

        Args:
            q: Angles (6, n).
            now: The cost there.
            damping: Added to the diagonal of the Hessian (n,).
        """
        e, J = now.model
        A, b = normal_equations(J, e)
        A[range(6), range(6)] += damping + _FLOOR
        return box_step(A, b, self.leg.lower[:, None] - q, self.leg.upper[:, None] - q)

    def moved(self, q: Array, step: Array) -> Array:
        """The angles (6, n) after a step, rounding kept inside the limits."""
        return np.minimum(np.maximum(q + step, self.leg.lower[:, None]), self.leg.upper[:, None])

    def restart(self, i: int, q: Array) -> Array:
        """The knee bent a little to either side of where samples got stuck, then all over the ranges."""
        if i < len(_KNEE_OFFSETS):
            return np.asarray(q + _KNEE_OFFSETS[i] * (np.arange(6) == _KNEE)[:, None])
        limits = self.leg.lower[:, None], self.leg.upper[:, None]
        return np.tile(spread_point(i - len(_KNEE_OFFSETS), *limits, np.zeros((6, 1))), q.shape[1])


def _squares(e: Array) -> Array:
    total = e[0] * e[0]
    for row in e[1:]:
        total += row * row
    return np.asarray(total)

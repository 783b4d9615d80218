"""What a cost offers to the iteration: its value, its derivatives, its limits and its schedule.

Samples are independent of each other and stand on the last axis of every array.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol, Self

import numpy as np

from exo_pin.arrays import Array, Index, Mask


class Evaluation(NamedTuple):
    """The cost of m samples at their configurations.

    Attributes:
        cost: What is minimised (m,).
        errors: Distance [m] and angle [rad] of each frame from its target (2, F, m); NaN where the target
            leaves the rotation free.
        model: What the kernel needs for a step: arrays with the samples on the last axis.
    """

    cost: Array
    errors: Array
    model: tuple[Array, ...]

    def only(self, samples: Index) -> Evaluation:
        """Some of the samples."""
        return Evaluation(
            self.cost[samples], self.errors[..., samples], tuple(x[..., samples] for x in self.model)
        )

    def where(self, better: Mask, other: Evaluation) -> Evaluation:
        """The other's samples where they are better."""
        return Evaluation(
            np.where(better, other.cost, self.cost),
            np.where(better, other.errors, self.errors),
            tuple(np.where(better, new, old) for old, new in zip(self.model, other.model, strict=True)),
        )

    def joined(self, other: Evaluation) -> Evaluation:
        """Both one after the other."""
        return Evaluation(
            np.append(self.cost, other.cost),
            np.append(self.errors, other.errors, axis=-1),
            tuple(np.append(x, y, axis=-1) for x, y in zip(self.model, other.model, strict=True)),
        )


@dataclass(frozen=True, kw_only=True)
class Schedule:
    """The numbers of an iteration that depend on the kernel; lengths of steps in [rad], prismatic [m].

    Attributes:
        damping: Damping factor of the first step.
        least: The damping factor never falls below this.
        relative: Whether the damping is the damping factor times the cost; else the factor itself.
        to_minimum: Whether the iteration goes on where all targets are met already.
        untaken: A step shorter than this is not taken any more.
        last: A step shorter than this is the last.
        rounded: A step shorter than this is the last if it does not lower the cost: what is left is
            below the rounding of the cost.
        decline: A step that lowers the cost by less than this share of it is the last.
    """

    damping: float = 1.0
    least: float = 0.0
    relative: bool = True
    to_minimum: bool = False
    untaken: float = 0.0
    last: float = 0.0
    rounded: float = 0.0
    decline: float = 0.0


class Kernel(Protocol):
    """A cost of n samples, its derivatives and its limits."""

    @property
    def schedule(self) -> Schedule:
        """The numbers of its iteration."""

    def only(self, samples: Index) -> Self:
        """The cost of some of the samples."""

    def inside(self, q: Array) -> Array:
        """Configurations (nq, n) moved into the limits."""

    def evaluate(self, q: Array) -> Evaluation:
        """The cost at the configurations (nq, n)."""

    def step(self, q: Array, now: Evaluation, damping: Array) -> Array:
        """The damped step (nv, n) from q, within the limits.

        Args:
            q: Configurations (nq, n).
            now: The cost there.
            damping: What to add to the diagonal of the Hessian (n,).
        """

    def moved(self, q: Array, step: Array) -> Array:
        """The configurations (nq, n) after a step (nv, n) from q, within the limits."""


class RestartableKernel(Kernel, Protocol):
    """A kernel whose samples may start again elsewhere."""

    def restart(self, i: int, q: Array) -> Array:
        """Where samples that got stuck at q (nq, n) start for the i-th time again (nq, n), i = 0, 1, ..."""


def spread_point(i: int, lower: Array, upper: Array, unlimited: Array) -> Array:
    """Restart i: the middle of the joint ranges, then a low-discrepancy sequence (Roberts 2018, R_d).

    It is always the same, so that an answer does not depend on what was solved before.

    Args:
        i: Number of the restart, from 0.
        lower: Lower limits (nq, n).
        upper: Upper limits (nq, n).
        unlimited: The configurations (nq, n) of the joints that lack a limit.
    """
    bounded = (np.isfinite(lower) & np.isfinite(upper)).all(axis=1)
    low, span = lower[bounded], (upper - lower)[bounded]
    root = 2.0
    for _ in range(40):  # the positive root of x**(d + 1) = x + 1
        root = (1.0 + root) ** (1.0 / (len(span) + 1))
    stride = root ** -np.arange(1.0, len(span) + 1.0)
    q = unlimited.copy()
    q[bounded] = low + ((0.5 + i * stride) % 1.0)[:, None] * span
    return q

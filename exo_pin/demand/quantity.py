"""One required quantity against one limit: positions against a range, or a peak against its largest size."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exo_pin.arguments import names, real
from exo_pin.arrays import Array, Mask, as_floats
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot
from exo_pin.robot.model import LIMIT_TOLERANCE
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class RangeDemand:
    """The positions of one joint against its range.

    Attributes:
        required: Positions (n,) [rad; of a prismatic joint m].
        available: Lower and upper limit, in the same unit.
    """

    required: Array
    available: tuple[float, float]

    __repr__ = short_repr

    @property
    def lowest(self) -> float:
        """The smallest position."""
        return float(self.required.min())

    @property
    def highest(self) -> float:
        """The largest position."""
        return float(self.required.max())

    @property
    def outside(self) -> Mask:
        """Samples (n,) outside the range; a position that is not a number counts as outside."""
        lower, upper = self.available
        return np.asarray(
            ~((self.required >= lower - LIMIT_TOLERANCE) & (self.required <= upper + LIMIT_TOLERANCE))
        )

    @property
    def samples_outside(self) -> int:
        """Number of samples outside the range."""
        return int(self.outside.sum())

    @property
    def samples_at_limit(self) -> int:
        """Number of samples on a limit or beyond it."""
        lower, upper = self.available
        at_limit = (self.required - lower <= LIMIT_TOLERANCE) | (upper - self.required <= LIMIT_TOLERANCE)
        return int(at_limit.sum())

    @property
    def margin(self) -> float:
        """Smallest distance from a limit; negative: the largest excess beyond it."""
        lower, upper = self.available
        return min(self.lowest - lower, upper - self.highest)

    @property
    def worst(self) -> float:
        """The position that comes closest to a limit, or lies furthest beyond it."""
        lower, upper = self.available
        return float(self.required[np.maximum(self.required - upper, lower - self.required).argmax()])

    @property
    def use(self) -> float:
        """Largest share of the way from mid-range to a limit; 1: on it. NaN where the limits coincide."""
        lower, upper = self.available
        if upper == lower:
            return math.nan
        return float(np.abs(2 * self.required - lower - upper).max() / (upper - lower))


@dataclass(frozen=True, eq=False)
class PeakDemand:
    """A signed quantity of one joint against the largest size that it may have.

    Attributes:
        required: Values (n,), for example speeds [rad/s]; NaN where unknown.
        available: The limit of their size, in the same unit; infinite where there is none.
    """

    required: Array
    available: float

    __repr__ = short_repr

    @property
    def peak(self) -> float:
        """Largest size; NaN where no value is known."""
        known = self.required[~np.isnan(self.required)]
        return float(np.abs(known).max()) if known.size else math.nan

    @property
    def use(self) -> float:
        """Share of the limit that is used; above 1: more than is available."""
        if self.available:
            return self.peak / self.available
        return math.inf if self.peak > LIMIT_TOLERANCE else 0.0

    @property
    def exceeded(self) -> Mask:
        """Samples (n,) that require more than is available; unknown values do not count."""
        return np.asarray(np.abs(np.nan_to_num(self.required)) > self.available + LIMIT_TOLERANCE)


def range_demands(robot: Robot, q: npt.ArrayLike) -> dict[str, RangeDemand]:
    """The range that configurations (n, nq) require of every joint of a robot, by joint.

    Raises:
        DescriptionError: The shape of q does not fit, or a number is not finite.
    """
    angles = robot.angles(real("q", q, ("n", robot.nq)))
    limits = zip(robot.lower.tolist(), robot.upper.tolist(), strict=True)
    return {
        joint: RangeDemand(angles[:, j], pair)
        for j, (joint, pair) in enumerate(zip(robot.joints, limits, strict=True))
    }


def peak_demands(
    joints: Sequence[str], required: Array, available: npt.ArrayLike | float
) -> dict[str, PeakDemand]:
    """Peaks of a quantity against its limits, by joint.

    Args:
        joints: Names (J,).
        required: Values (n, J), NaN where unknown.
        available: Limits (J,), or one limit for all, in the same unit; infinite where there is none.

    Raises:
        DescriptionError: A shape does not fit, or a value is no number.
    """
    joints = names("joints", joints)
    required = real("required", required, ("n", len(joints)), gaps=True)
    most = _limits(available)
    if most.shape not in ((), (len(joints),)):
        raise DescriptionError(f"available has shape {most.shape}; () or ({len(joints)},) is accepted")
    limits = np.broadcast_to(most, (len(joints),)).tolist()
    return {
        joint: PeakDemand(required[:, j], limit)
        for j, (joint, limit) in enumerate(zip(joints, limits, strict=True))
    }


def _limits(available: npt.ArrayLike) -> Array:
    """Limits as numbers, infinite ones among them."""
    try:
        limits = as_floats(available)
    except (TypeError, ValueError):
        raise DescriptionError("available is not an array of real numbers") from None
    if np.isnan(limits).any() or (limits < 0.0).any():
        raise DescriptionError("available holds NaN or a negative number; limits from 0 on are accepted")
    return limits

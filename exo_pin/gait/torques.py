"""Joint torques over time: data of a walk, computed or measured elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy import JOINTS
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.frozen_fields import set_fields
from exo_pin.gait.validation import check_time, frozen

_LARGEST_TORQUE = 3000.0
"""No joint of a leg bears more [N m]; a larger number is nearly always N mm taken for N m."""


@dataclass(frozen=True, eq=False, repr=False)
class Torques:
    """Torques of the joints over time, in the order of `JOINTS`.

    The sign is the joint's: a positive torque drives the joint the way its name says (`knee_flexion`: it
    bends the knee), so torque times joint velocity is the power that the joint gives. These are the torques
    of muscles or actuators ("internal moments"); a load's moment about the joint is their negative.

    Attributes:
        time: `(n,)` strictly increasing [s], on the clock of the walk that they belong to.
        tau: `(n, 12)` [N m]; NaN where the torque of a joint is not known.
        source: Where the numbers come from, in words.
        remarks: What reading the file corrected or left out, a plain sentence each.

    Raises:
        GaitError: If shapes, time or torques are unusable; the message says which and where.
    """

    time: Array
    tau: Array
    source: str = field(default="", kw_only=True)
    remarks: tuple[str, ...] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        set_fields(self, time=frozen(self.time, "time"), tau=frozen(self.tau, "tau"), source=str(self.source))
        check_time(self.time, periodic=False)
        _check(self.tau, len(self.time))

    def __repr__(self) -> str:
        return (
            f"<Torques {len(self.time)} samples, {self.time[0]:.3f} .. {self.time[-1]:.3f} s, "
            f"{len(self.joints)} joints, source={self.source!r}>"
        )

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints with torques."""
        return tuple(name for k, name in enumerate(JOINTS) if np.isfinite(self.tau[:, k]).any())

    def at(self, time: ArrayLike) -> Array:
        """Torques `(m, 12)` at times `(m,)`, linear between samples; NaN outside them [N m].

        Raises:
            GaitError: None of the times lies within the samples: the two clocks differ; or one is not finite.
        """
        times = real("time", time, ("m",), error=GaitError)
        if not len(times):
            return np.empty((0, len(JOINTS)))
        rounding = 1e-6 + 1e-3 * float(np.diff(self.time).min())  # files round their times
        inside = (times >= self.time[0] - rounding) & (times <= self.time[-1] + rounding)
        if not inside.any():
            raise GaitError(
                f"the torques reach from {self.time[0]:g} to {self.time[-1]:g} s, "
                f"the walk from {times[0]:g} to {times[-1]:g} s; they must share a clock"
            )
        rows = np.column_stack([np.interp(times, self.time, column) for column in self.tau.T])
        rows[~inside] = np.nan
        return rows


def _check(tau: Array, n: int) -> None:
    """Raises `GaitError` unless `tau` is `(n, 12)`, plausible, and somewhere known."""
    if tau.shape != (n, len(JOINTS)):
        raise GaitError(
            f"tau has shape {tau.shape}, expected ({n}, {len(JOINTS)}): a row per time, columns as JOINTS"
        )
    if np.isnan(tau).all():
        raise GaitError("tau holds no torque: every one is NaN")
    bad = np.abs(tau) > _LARGEST_TORQUE
    if bad.any():
        row, k = np.argwhere(bad)[0]
        raise GaitError(f"torque of {JOINTS[k]} in row {row} is {tau[row, k]:g} N m: N mm given as N m?")

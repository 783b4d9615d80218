"""Results of inverse kinematics: `Solution` for one sample, `Track` for many."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from exo_pin.arrays import Array, Index, Mask, to_host
from exo_pin.gait import Gait
from exo_pin.html_summary import table
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

_AT_LIMIT = 1e-9
"""A joint this close to its limit lies on it [rad]: rounding only."""


@dataclass(frozen=True, eq=False)
class Track:
    """Joint angles for n samples, and how well they meet the targets.

    Attributes:
        frames: Names of the target frames (F of them).
        q: Configurations (n, nq), always within the joint limits [rad].
        position_error: Distance of each frame from its target (n, F) [m], of the q that is returned.
        rotation_error: Angle between each frame and its target (n, F) [rad]; NaN for targets without one.
        iterations: Steps spent on each sample (n,); 0 for the closed form.
        converged: (n,) True where all errors are within the tolerance.
        reach_slack: How far each target is inside the leg's reach (n, F) [m]; negative: out of reach by that
            much; NaN for frames that no leg carries.
        solver: Index into `solvers` of what answered each sample (n,).
        solvers: Names of the solvers.
        lower: Lower limit of each entry of q (nq,).
        upper: Upper limit of each entry of q (nq,).
    """

    frames: tuple[str, ...]
    q: Array
    position_error: Array
    rotation_error: Array
    iterations: Index
    converged: Mask
    reach_slack: Array
    solver: npt.NDArray[np.int8]
    solvers: tuple[str, ...]
    lower: Array
    upper: Array

    __repr__ = short_repr

    def __post_init__(self) -> None:
        for values in vars(self).values():
            if isinstance(values, np.ndarray):
                values.flags.writeable = False

    def __len__(self) -> int:
        return len(self.q)

    def _repr_html_(self) -> str:
        """How well the targets are met, for notebooks."""
        facts: dict[str, object] = {"samples": len(self), "converged": int(np.sum(self.converged))}
        for k, frame in enumerate(self.frames):
            facts[f"{frame}, largest error [mm]"] = float(
                1e3 * np.max(self.position_error[:, k], initial=0.0)
            )
        return table(facts)

    def to_gait(self, robot: Robot, like: Gait) -> Gait:
        """The joint angles as a gait, as `Robot.to_gait` has them.

        Args:
            robot: The robot that was solved.
            like: Gives time, events and, for a held pelvis, the base.

        Raises:
            DescriptionError: The number of samples differs.
        """
        return robot.to_gait(self.q, like)

    @cached_property
    def active_limits(self) -> Mask:
        """Which joints lie on a limit (n, nq)."""
        return (self.q - self.lower <= _AT_LIMIT) | (self.upper - self.q <= _AT_LIMIT)

    @property
    def answered_by(self) -> list[str]:
        """Name of the solver that answered each sample."""
        return [self.solvers[k] for k in to_host(self.solver)]

    def __getitem__(self, k: int) -> Solution:
        """One sample."""
        return Solution(
            frames=self.frames,
            q=self.q[k],
            position_error=self.position_error[k],
            rotation_error=self.rotation_error[k],
            iterations=int(self.iterations[k]),
            converged=bool(self.converged[k]),
            active_limits=self.active_limits[k],
            reach_slack=self.reach_slack[k],
            solver=self.solvers[int(self.solver[k])],
        )


@dataclass(frozen=True, eq=False)
class Solution:
    """Joint angles for one sample; attributes as in `Track`, without the first axis.

    Attributes:
        frames: Names of the target frames.
        q: Configuration (nq,) [rad].
        position_error: (F,) [m].
        rotation_error: (F,) [rad].
        iterations: Steps spent.
        converged: Whether all errors are within the tolerance.
        active_limits: (nq,) joints on a limit.
        reach_slack: (F,) [m].
        solver: Name of the solver that answered.
    """

    frames: tuple[str, ...]
    q: Array
    position_error: Array
    rotation_error: Array
    iterations: int
    converged: bool
    active_limits: Mask
    reach_slack: Array
    solver: str

    __repr__ = short_repr

"""The sheet that solvers write their answers on, limb by limb."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exo_pin.arrays import Array, Index
from exo_pin.ik.problem import Problem
from exo_pin.ik.result import Track

SOLVED_BY = ("closed_form", "dls")
"""What may have answered a sample; the later one counts where legs differ."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """Answers in the making.

    Attributes:
        q: Configurations (n, nq).
        errors: Distance and angle of each frame (2, n, F).
        steps: Steps spent on each sample (n,).
        solver: Index into `SOLVED_BY` (n,).
        slack: Room up to the end of reach (n, F) [m]; NaN where there is none to speak of.
    """

    q: Array
    errors: Array
    steps: Index
    solver: npt.NDArray[np.int8]
    slack: Array

    @classmethod
    def blank(cls, task: Problem) -> Sheet:
        """An empty sheet for a problem."""
        n = task.n
        q = np.empty((n, task.robot.nq))
        q[:] = task.rest
        errors = np.full((2, n, len(task.frames)), np.nan)
        room = np.full((n, len(task.frames)), np.nan)
        return cls(q, errors, np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int8), room)

    def track(self, task: Problem, tolerance: float) -> Track:
        """The finished answer."""
        lower, upper = np.full(task.robot.nq, -np.inf), np.full(task.robot.nq, np.inf)
        joints = slice(task.robot.nq - len(task.robot.joints), None)
        lower[joints], upper[joints] = task.robot.lower, task.robot.upper
        asked = np.array([goal.R is not None for goal in task.goals])
        converged = (self.errors[0] <= tolerance).all(axis=1)
        converged &= (self.errors[1][:, asked] <= tolerance).all(axis=1)
        return Track(
            frames=task.frames,
            q=self.q,
            position_error=self.errors[0],
            rotation_error=self.errors[1],
            iterations=self.steps,
            converged=converged,
            reach_slack=self.slack,
            solver=self.solver,
            solvers=SOLVED_BY,
            lower=lower,
            upper=upper,
        )

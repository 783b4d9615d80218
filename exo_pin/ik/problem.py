"""What every solver takes and fills: the checked problem, and the solution buffer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exo_pin.arguments import real
from exo_pin.arrays import Array, Index, beside, filled, to_host
from exo_pin.errors import DescriptionError
from exo_pin.ik.result import Track
from exo_pin.ik.targets import Goal, Target, check, pose_array
from exo_pin.robot import LegAxes, Robot, Subtree
from exo_pin.robot.floating_base import FREE, base_coordinates

SOLVED_BY = ("closed_form", "dls")
"""Names of the solvers; the later one counts where legs differ."""


@dataclass(frozen=True, eq=False)
class Problem:
    """A checked problem, what every solver takes.

    Attributes:
        robot: The robot.
        goals: One per target frame, in the axes of the robot at its own placement.
        n: Number of samples.
        subtrees: The joints that are solved for, one subtree for each group of frames that share joints.
        rest: Configuration (nq,) or (n, nq) of the joints that move no target (and of a held floating base).
        seed: Where an iteration starts (nq,), or one for each sample (n, nq).
    """

    robot: Robot
    goals: tuple[Goal, ...]
    n: int
    subtrees: tuple[Subtree, ...]
    rest: Array
    seed: Array

    @property
    def frames(self) -> tuple[str, ...]:
        """Names of the target frames."""
        return tuple(goal.frame for goal in self.goals)

    def goals_of(self, subtree: Subtree) -> list[Goal]:
        """The goals of a subtree, in the order of its frames."""
        return [self.goals[f] for f in self.places_of(subtree)]

    def places_of(self, subtree: Subtree) -> list[int]:
        """Where the subtree's frames stand among the target frames."""
        return [self.frames.index(name) for name in subtree.frames]

    def leg_of(self, subtree: Subtree) -> LegAxes | None:
        """The leg of a subtree whose one target is the full pose of a frame on a leg; None for others."""
        goals = self.goals_of(subtree)
        full = goals[0].R is not None and bool((goals[0].weight > 0.0).all())
        single = len(goals) == 1 and full and not subtree.floating
        return self.robot.leg(goals[0].frame) if single else None


@dataclass(frozen=True, eq=False)
class SolutionBuffer:
    """What the solvers fill in, subtree by subtree.

    Attributes:
        q: Configurations (n, nq).
        errors: Distance and angle of each frame (2, n, F).
        steps: Steps spent on each sample (n,).
        solver: Index into `SOLVED_BY` (n,).
        slack: How far each target is inside the leg's reach (n, F) [m]; NaN for frames that no leg carries.
    """

    q: Array
    errors: Array
    steps: Index
    solver: npt.NDArray[np.int8]
    slack: Array

    @classmethod
    def blank(cls, task: Problem) -> SolutionBuffer:
        """Unused joints at rest, everything else empty."""
        n, like = task.n, task.goals[0].p
        q = np.empty((n, task.robot.nq), like=like)
        q[:] = beside(task.rest, like)
        errors = filled((2, n, len(task.frames)), np.nan, like=like)
        room = filled((n, len(task.frames)), np.nan, like=like)
        steps, solver = np.zeros(n, dtype=np.int64, like=like), np.zeros(n, dtype=np.int8, like=like)
        return cls(q, errors, steps, solver, room)

    def missed(self, f: int, tolerance: float) -> Index:
        """The samples in which target f is not met within the tolerance, or has no answer yet (m,)."""
        return to_host(np.flatnonzero(~(self.errors[:, :, f] <= tolerance).all(axis=0)))

    def track(self, task: Problem, tolerance: float) -> Track:
        """The finished answer."""
        lower, upper = np.full(task.robot.nq, -np.inf), np.full(task.robot.nq, np.inf)
        joints = slice(task.robot.nq - len(task.robot.joints), None)
        lower[joints], upper[joints] = task.robot.lower, task.robot.upper
        turned = [f for f, goal in enumerate(task.goals) if goal.R is not None]
        converged = (self.errors[0] <= tolerance).all(axis=1)
        converged &= (self.errors[1][:, turned] <= tolerance).all(axis=1)
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
            lower=beside(lower, self.q),
            upper=beside(upper, self.q),
        )


def problem(
    robot: Robot, targets: Mapping[str, Target], q0: npt.ArrayLike | None, base: npt.ArrayLike | None
) -> Problem:
    """Check everything that `track` is given.

    Args:
        robot: The robot.
        targets: By name of the frame, n samples.
        q0: Seed (nq,), or one for each sample (n, nq); mid-range if left out.
        base: T_world_pelvis (4, 4) or (n, 4, 4); the robot's own placement if left out.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: Shapes, numbers or poses are wrong; the message names frame and sample.
    """
    held = None if base is None else _base(base)
    carry: Array | None = None if held is None else beside(robot.placement, held) @ np.linalg.inv(held)
    goals, n = check(robot, targets, carry)
    base_moves = robot.base == "floating" and held is None
    groups = robot.subtrees(tuple(goal.frame for goal in goals), base_moves=base_moves)
    rest, seed = _start(robot, q0, n, groups)
    if robot.base == "floating" and held is not None:
        rest = np.broadcast_to(rest, (n, robot.nq)).copy()
        rest[:, :FREE] = np.atleast_2d(base_coordinates(to_host(held)))
    return Problem(robot, tuple(goals), n, groups, rest, seed)


def _base(base: npt.ArrayLike) -> Array:
    T = real("base", base)
    if T.shape != (4, 4):
        return pose_array("base", T)
    one: Array = pose_array("base", T[None])[0]
    return one


def _start(
    robot: Robot, q0: npt.ArrayLike | None, n: int, groups: tuple[Subtree, ...]
) -> tuple[Array, Array]:
    """Configuration of the joints that move no target, and seed: mid-range where there is no q0."""
    if q0 is not None:
        q = to_host(real("q0", q0))
        if q.shape not in ((robot.nq,), (n, robot.nq)):
            raise DescriptionError(f"q0 has shape {q.shape}; ({robot.nq},) or ({n}, {robot.nq}) is accepted")
        q = robot.unit_quaternion(q)
        return q, q
    rest = robot.neutral
    joints = rest[robot.nq - len(robot.joints) :]
    joints[:] = np.clip(joints, robot.lower, robot.upper)
    seed = rest.copy()
    for subtree in groups:
        middle = subtree.middle
        if subtree.floating:
            middle[:FREE] = rest[:FREE]
        seed[subtree.columns] = middle
    return rest, seed

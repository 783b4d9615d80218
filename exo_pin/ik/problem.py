"""A problem: robot, goals and seeds, checked once, the same for every solver."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.ik.targets import Goal, Target, check, pose_array
from exo_pin.robot import Robot, Subtree


@dataclass(frozen=True, eq=False)
class Problem:
    """What a solver gets.

    Attributes:
        robot: The robot.
        goals: One per target frame, seen from the robot at its own placement.
        n: Number of samples.
        subtrees: The joints that are solved for, one subtree for each group of frames that share joints.
        rest: Configuration (nq,) or (n, nq) that unused joints keep (and a held floating base).
        seed: Start (nq,), or one per sample (n, nq).
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
        """The goals of one subtree, in the order of its frames."""
        return [self.goals[f] for f in self.places_of(subtree)]

    def places_of(self, subtree: Subtree) -> list[int]:
        """Where the subtree's frames stand among the target frames."""
        return [self.frames.index(name) for name in subtree.frames]


def problem(
    robot: Robot, targets: Mapping[str, Target], q0: npt.ArrayLike | None, base: npt.ArrayLike | None
) -> Problem:
    """Check everything that `track` was given.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: Shapes, numbers or poses are wrong; the message names frame and sample.
    """
    held = None if base is None else _base(base)
    carry: Array | None = None if held is None else np.asarray(robot.placement @ np.linalg.inv(held))
    goals, n = check(robot, targets, carry)
    base_moves = robot.base == "floating" and held is None
    groups = robot.subtrees(tuple(goal.frame for goal in goals), base_moves=base_moves)
    rest, seed = _start(robot, q0, n, groups)
    if robot.base == "floating" and held is not None:
        rest = np.broadcast_to(rest, (n, robot.nq)).copy()
        rest[:, :7] = [pin.SE3ToXYZQUAT(pin.SE3(T)) for T in np.broadcast_to(held, (n, 4, 4))]
    return Problem(robot, tuple(goals), n, groups, rest, seed)


def _base(base: npt.ArrayLike) -> Array:
    T = np.asarray(base, dtype=float)
    if T.shape == (4, 4):
        return np.asarray(pose_array("base", T[None])[0])
    return pose_array("base", T)


def _start(
    robot: Robot, q0: npt.ArrayLike | None, n: int, groups: tuple[Subtree, ...]
) -> tuple[Array, Array]:
    """What the unused joints keep, and where the iteration starts: mid-range unless q0 says otherwise."""
    if q0 is not None:
        q = np.asarray(q0, dtype=float)
        if q.shape not in ((robot.nq,), (n, robot.nq)):
            raise DescriptionError(f"q0 has shape {q.shape}; ({robot.nq},) or ({n}, {robot.nq}) is accepted")
        if not np.isfinite(q).all():
            raise DescriptionError("q0 holds NaN or infinity")
        return q, q
    rest = robot.neutral
    joints = rest[robot.nq - len(robot.joints) :]
    joints[:] = np.clip(joints, robot.lower, robot.upper)
    seed = rest.copy()
    for subtree in groups:
        middle = subtree.middle
        if subtree.floating:
            middle[:7] = rest[:7]
        seed[subtree.columns] = middle
    return rest, seed

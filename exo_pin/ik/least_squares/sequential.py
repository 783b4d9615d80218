"""Sample after sample: damped least squares on each subtree, each sample started from the one before."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.ik.least_squares.single_sample import best_try, descend
from exo_pin.ik.least_squares.step_limit import pace
from exo_pin.ik.problem import SOLVED_BY, Problem, SolutionBuffer
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal
from exo_pin.robot import Subtree


def follow(task: Problem, subtree: Subtree, settings: Dls, buffer: SolutionBuffer) -> None:
    """Write the answers for one subtree."""
    goals, places = task.goals_of(subtree), task.places_of(subtree)
    data = subtree.model.createData()
    near, compromise = reachable(task, subtree, buffer), not (subtree.floating or enough(subtree, goals))
    own = task.seed.ndim == 2
    seed = subtree.middle if own else task.seed[subtree.columns]
    paces = _paces(subtree, goals) if compromise and settings.warm_start and not own else None
    for k in range(task.n):
        if own:
            seed = task.seed[k, subtree.columns]
        how = {"free": k == 0 and not own, "compromise": compromise}
        answer = best_try(subtree, data, seed, goals, k, settings, reachable=bool(near[k]), **how)
        if paces is not None and not answer.converged and (np.abs(answer.q - seed) > paces[k]).any():
            slow = subtree.narrowed(seed - paces[k], seed + paces[k])
            answer = descend(slow, data, seed, goals, k, settings, compromise=True)
        buffer.q[k, subtree.columns] = answer.q
        buffer.errors[:, k, places] = answer.errors
        buffer.steps[k] += answer.steps
        if settings.warm_start and not own:
            seed = answer.q
    buffer.solver[:] = SOLVED_BY.index("dls")


def reachable(task: Problem, subtree: Subtree, buffer: SolutionBuffer) -> Mask:
    """The samples (n,) that another start may bring to their targets."""
    goals, places = task.goals_of(subtree), task.places_of(subtree)
    legs = [task.robot.leg(name) for name in subtree.frames]
    error = [0.0 if leg is None else leg.reach_error for leg in legs]
    short = np.asarray((buffer.slack[:, places] < np.negative(error)).any(axis=1))
    return np.asarray(~short & enough(subtree, goals))


def enough(subtree: Subtree, goals: list[Goal]) -> bool:
    """Whether the joints are as many as the equations; with fewer, a compromise is all that can be had."""
    asked = sum(goal.local.size + (3 if goal.R is not None else 0) for goal in goals)
    return bool(subtree.model.nv >= asked)


def _paces(subtree: Subtree, goals: list[Goal]) -> Array | None:
    joints = subtree.arrays
    return None if joints is None else pace(joints, goals)

"""Sample after sample: damped least squares on each limb, each sample started from the one before."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array, Mask
from exo_pin.ik.least_squares.single_sample import best_try, descend
from exo_pin.ik.least_squares.step_limit import pace
from exo_pin.ik.problem import Problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.solution_buffer import SOLVED_BY, Sheet
from exo_pin.ik.subtree import Limb, narrowed
from exo_pin.ik.subtree_arrays import branches
from exo_pin.ik.targets import Goal
from exo_pin.robot.leg_axes import leg


def follow(task: Problem, limb: Limb, settings: Dls, sheet: Sheet) -> None:
    """Write the answers for one limb."""
    goals, places = task.goals_of(limb), task.places_of(limb)
    data = limb.model.createData()
    near, compromise = reachable(task, limb, sheet), not (limb.floats or enough(limb, goals))
    own = task.seed.ndim == 2
    seed = limb.middle if own else task.seed[limb.q]
    paces = _paces(limb, goals) if compromise and settings.warm_start and not own else None
    for k in range(task.n):
        if own:
            seed = task.seed[k, limb.q]
        how = {"free": k == 0 and not own, "compromise": compromise}
        answer = best_try(limb, data, seed, goals, k, settings, reachable=bool(near[k]), **how)
        if paces is not None and not answer.converged and (np.abs(answer.q - seed) > paces[k]).any():
            slow = narrowed(limb, seed - paces[k], seed + paces[k])
            answer = descend(slow, data, seed, goals, k, settings, compromise=True)
        sheet.q[k, limb.q] = answer.q
        sheet.errors[:, k, places] = answer.errors
        sheet.steps[k] += answer.steps
        if settings.warm_start and not own:
            seed = answer.q
    sheet.solver[:] = SOLVED_BY.index("dls")


def reachable(task: Problem, limb: Limb, sheet: Sheet) -> Mask:
    """The samples (n,) that another start may bring to their targets."""
    goals, places = task.goals_of(limb), task.places_of(limb)
    legs = [leg(task.robot, name) for name in limb.frames]
    doubt = [0.0 if chain is None else chain.doubt for chain in legs]
    short = np.asarray((sheet.slack[:, places] < np.negative(doubt)).any(axis=1))
    return np.asarray(~short & enough(limb, goals))


def enough(limb: Limb, goals: list[Goal]) -> bool:
    """Whether the joints are as many as the equations; with fewer, a compromise is all that can be had."""
    asked = sum(goal.local.size + (3 if goal.R is not None else 0) for goal in goals)
    return bool(limb.model.nv >= asked)


def _paces(limb: Limb, goals: list[Goal]) -> Array | None:
    joints = branches(limb)
    return None if joints is None else pace(joints, goals)

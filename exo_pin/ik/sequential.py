"""Sample after sample: damped least squares on each limb, each sample started from the one before."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.ik.dls import best_try
from exo_pin.ik.leg import leg
from exo_pin.ik.limb import Limb
from exo_pin.ik.problem import Problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.sheet import SOLVED_BY, Sheet


def follow(task: Problem, limb: Limb, settings: Dls, sheet: Sheet) -> None:
    """Write the answers for one limb."""
    goals, places = task.goals_of(limb), task.places_of(limb)
    data = limb.model.createData()
    near = reachable(task, limb, sheet)
    own = task.seed.ndim == 2
    seed = limb.middle if own else task.seed[limb.q]
    for k in range(task.n):
        if own:
            seed = task.seed[k, limb.q]
        free = k == 0 and not own
        answer = best_try(limb, data, seed, goals, k, settings, reachable=bool(near[k]), free=free)
        sheet.q[k, limb.q] = answer.q
        sheet.errors[:, k, places] = answer.errors
        sheet.steps[k] += answer.steps
        if settings.warm_start and not own:
            seed = answer.q
    sheet.solver[:] = SOLVED_BY.index("dls")


def reachable(task: Problem, limb: Limb, sheet: Sheet) -> npt.NDArray[np.bool_]:
    """The samples (n,) that another start may bring to their targets."""
    goals, places = task.goals_of(limb), task.places_of(limb)
    legs = [leg(task.robot, name) for name in limb.frames]
    doubt = [0.0 if chain is None else chain.doubt for chain in legs]
    short = np.asarray((sheet.slack[:, places] < np.negative(doubt)).any(axis=1))
    asked = sum(goal.local.size + (3 if goal.R is not None else 0) for goal in goals)
    enough = limb.model.nv >= asked  # fewer joints than equations: a compromise is all that can be had
    return np.asarray(~short & enough)

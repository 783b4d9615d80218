"""Sample after sample: damped least squares on each limb, each sample started from the one before."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.ik.dls import best_try
from exo_pin.ik.limb import Limb
from exo_pin.ik.problem import Problem
from exo_pin.ik.reach import slack
from exo_pin.ik.result import Track
from exo_pin.ik.settings import Dls

Array = npt.NDArray[np.float64]


def follow(task: Problem, settings: Dls) -> Track:
    """The answer of `Dls` for every sample."""
    n, frames = task.n, task.frames
    q = np.broadcast_to(task.rest, (n, task.robot.nq)).copy()
    errors = np.full((2, n, len(frames)), np.nan)
    steps = np.zeros(n, dtype=np.int64)
    converged = np.ones(n, dtype=bool)
    room = slack(task)
    for limb in task.limbs:
        _follow_limb(task, limb, settings, room, q, errors, steps, converged)
    return finished(task, q, errors, steps, converged, np.zeros(n, dtype=np.int8), ("dls",), room)


def finished(
    task: Problem,
    q: Array,
    errors: Array,
    steps: npt.NDArray[np.int64],
    converged: npt.NDArray[np.bool_],
    solver: npt.NDArray[np.int8],
    solvers: tuple[str, ...],
    room: Array,
) -> Track:
    """The answers as a `Track`; errors (2, n, F)."""
    lower, upper = np.full(task.robot.nq, -np.inf), np.full(task.robot.nq, np.inf)
    joints = slice(task.robot.nq - len(task.robot.joints), None)
    lower[joints], upper[joints] = task.robot.lower, task.robot.upper
    return Track(
        frames=task.frames,
        q=q,
        position_error=errors[0],
        rotation_error=errors[1],
        iterations=steps,
        converged=converged,
        reach_slack=room,
        solver=solver,
        solvers=solvers,
        lower=lower,
        upper=upper,
    )


def _follow_limb(
    task: Problem,
    limb: Limb,
    settings: Dls,
    room: Array,
    q: Array,
    errors: Array,
    steps: npt.NDArray[np.int64],
    converged: npt.NDArray[np.bool_],
) -> None:
    goals, places = task.goals_of(limb), task.places_of(limb)
    data = limb.model.createData()
    short = np.asarray((room[:, places] < 0.0).any(axis=1))
    own = task.seed.ndim == 2
    seed = (task.seed[0] if own and task.n else task.seed)[limb.q] if task.n else limb.middle
    for k in range(task.n):
        if own:
            seed = task.seed[k, limb.q]
        answer = best_try(limb, data, seed, goals, k, settings, reachable=not short[k])
        q[k, limb.q] = answer.q
        errors[:, k, places] = answer.errors
        steps[k] += answer.steps
        converged[k] &= answer.converged
        if settings.warm_start and not own:
            seed = answer.q

"""All samples at once: the closed form of a leg, its check, and damped least squares for what remains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.least_squares import leg_kernel
from exo_pin.ik.leg import approximate_seed as start
from exo_pin.ik.leg import closed_form, forward, scalar
from exo_pin.ik.leg.constants import IdealLeg
from exo_pin.ik.problem import Problem
from exo_pin.ik.reach import slack, slack_of
from exo_pin.ik.result import SOLVED_BY, SolutionBuffer
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import CHUNK, Goal
from exo_pin.robot.leg_axes import LegAxes

FEW = 13
"""Up to so many samples plain `math` is quicker than arrays."""
ROUNDING, ROUGH = 1e-13, 1e-6
"""Errors between these are worth a polish [m, rad]."""


def formula(task: Problem, f: int, leg: LegAxes, ideal: IdealLeg, buffer: SolutionBuffer) -> None:
    """Write the closed form's answers for the leg of target f, within limits, and their true errors."""
    goal = task.goals[f]
    assert goal.R is not None  # a leg is asked for full poses only (`solvers._limbs`)
    low, high = leg.lower[:, None], leg.upper[:, None]
    for a in range(0, task.n, CHUNK):
        part = slice(a, a + CHUNK)
        R, p = forward.components(goal.R[part], goal.p[part, 0])
        q = one_by_one(goal, leg, ideal) if task.n <= FEW else closed_form.angles(ideal, R, p)
        np.minimum(np.maximum(q, low, out=q), high, out=q)
        distance, angle = forward.errors(forward.forward(leg, q), R, p)
        if np.isnan(distance).any():  # the ankle in the hip: no direction to take angles from
            q = np.where(np.isnan(q), 0.5 * (low + high), q)
            distance, angle = forward.errors(forward.forward(leg, q), R, p)
        buffer.errors[0, part, f], buffer.errors[1, part, f] = distance, angle
        buffer.slack[part, f] = slack(leg, R, p)
        for j, column in enumerate(leg.columns):
            buffer.q[part, column] = q[j]


def one_by_one(goal: Goal, leg: LegAxes, ideal: IdealLeg) -> Array:
    """The closed form in plain `math` for a handful of samples, angles (6, n)."""
    assert goal.R is not None  # as above
    solve = scalar.formula(ideal, leg.lower, leg.upper)
    rows = np.zeros((len(goal.p), 4, 4))
    rows[:, :3, :3], rows[:, :3, 3] = goal.R, goal.p[:, 0]
    return np.array([solve(T) for T in rows.reshape(-1, 16).tolist()]).reshape(-1, 6).T.copy()


def polish(task: Problem, f: int, leg: LegAxes, buffer: SolutionBuffer) -> None:
    """Two steps more for the few answers whose limits cut off the rounding of a nearly singular pose."""
    goal, own = task.goals[f], buffer.errors[:, :, f]
    assert goal.R is not None  # as above
    rough = np.flatnonzero(((own > ROUNDING) & (own < ROUGH)).any(axis=0))
    if not len(rough):
        return
    spot, settings = np.ix_(rough, leg.columns), Dls(tolerance=ROUNDING, max_iterations=2, restarts=0)
    asked, near = (goal.R[rough], goal.p[rough, 0]), np.ones(len(rough), dtype=bool)
    better = leg_kernel.answers(leg, *asked, buffer.q[spot].T, settings, reachable=near)
    gain = better.errors.sum(axis=0) < own[:, rough].sum(axis=0)
    buffer.q[spot] = np.where(gain, better.q, buffer.q[spot].T).T
    buffer.errors[:, rough, f] = np.where(gain, better.errors, own[:, rough])


def nearly(task: Problem, f: int, leg: LegAxes, ideal: IdealLeg, buffer: SolutionBuffer) -> None:
    """Write starts for a calibrated leg from the nearest ideal one; they count as not reached yet."""
    goal = task.goals[f]
    assert goal.R is not None  # as above
    for a in range(0, task.n, CHUNK):
        part = slice(a, a + CHUNK)
        q = start.angles(leg, ideal, *forward.components(goal.R[part], goal.p[part, 0]))
        for j, column in enumerate(leg.columns):
            buffer.q[part, column] = q[j]
    buffer.errors[:, :, f] = np.inf
    buffer.slack[:, f] = slack_of(leg, goal)


def descent(
    task: Problem, f: int, leg: LegAxes, settings: Dls, buffer: SolutionBuffer, *, seed: Array | None = None
) -> None:
    """Damped least squares for the samples of target f that are not within the tolerance.

    The seed (6, n) is what stands on the buffer if left out.
    """
    goal = task.goals[f]
    assert goal.R is not None  # as above
    with np.errstate(invalid="ignore"):
        rest = np.flatnonzero(~(buffer.errors[:, :, f] <= settings.tolerance).all(axis=0))
    if not len(rest):
        return
    begin = buffer.q[np.ix_(rest, leg.columns)].T if seed is None else seed[:, rest]
    near = np.asarray(~(buffer.slack[rest, f] < -leg.doubt))
    own = weighted(settings, goal.weight[0, 0], goal.rotation_weight)
    answer = leg_kernel.answers(leg, goal.R[rest], goal.p[rest, 0], begin, own, reachable=near)
    buffer.q[np.ix_(rest, leg.columns)] = answer.q.T
    buffer.errors[:, rest, f] = answer.errors
    buffer.steps[rest] += answer.steps
    buffer.solver[rest] = SOLVED_BY.index("dls")


def weighted(settings: Dls, position: float, rotation: float) -> Dls:
    """The settings with a target's own weights multiplied in."""
    if position == rotation == 1.0:
        return settings
    return replace(
        settings,
        position_weight=settings.position_weight * position,
        rotation_weight=settings.rotation_weight * rotation,
    )

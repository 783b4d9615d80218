"""All samples of a leg: closed form, verification, approximate seeds, and least squares for the rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.least_squares import leg_kernel
from exo_pin.ik.leg import closed_form, forward
from exo_pin.ik.leg.geometry import ClosedFormGeometry
from exo_pin.ik.leg.scalar import exact_formula
from exo_pin.ik.problem import SOLVED_BY, Problem, SolutionBuffer
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import CHUNK, Goal
from exo_pin.robot import LegAxes

_FEW = 13  # up to so many samples plain `math` is quicker than arrays
_ROUNDING, _ROUGH = 1e-13, 1e-6  # errors between these are worth a refinement [m, rad]


def write_closed_form(
    task: Problem, f: int, leg: LegAxes, geometry: ClosedFormGeometry, buffer: SolutionBuffer
) -> None:
    """Write the closed form's answers within the limits, and their errors by forward kinematics.

    Args:
        task: The problem.
        f: Which target it is; it is a full pose.
        leg: The leg that carries the target's frame.
        geometry: Constants of the leg's closed form.
        buffer: Where the answers go.
    """
    goal = task.goals[f]
    assert goal.R is not None  # a leg has full poses as targets (`Problem.leg_of`)
    low, high = leg.lower[:, None], leg.upper[:, None]
    for a in range(0, task.n, CHUNK):
        part = slice(a, a + CHUNK)
        R, p = forward.components(goal.R[part], goal.p[part, 0])
        q = _one_by_one(goal, leg) if task.n <= _FEW else closed_form.angles(geometry, R, p)
        np.minimum(np.maximum(q, low, out=q), high, out=q)
        distance, angle = forward.errors(forward.pose(leg, q), R, p)
        if np.isnan(distance).any():  # the ankle in the hip: no direction to take angles from
            q = np.where(np.isnan(q), 0.5 * (low + high), q)
            distance, angle = forward.errors(forward.pose(leg, q), R, p)
        buffer.errors[0, part, f], buffer.errors[1, part, f] = distance, angle
        buffer.slack[part, f] = forward.reach_slack(leg, R, p)
        for j, column in enumerate(leg.columns):
            buffer.q[part, column] = q[j]


def refine(task: Problem, f: int, leg: LegAxes, buffer: SolutionBuffer) -> None:
    """Two steps more for the few answers whose limits cut off the rounding of a nearly singular pose.

    Args:
        task: The problem.
        f: Which target it is.
        leg: The leg that carries the target's frame.
        buffer: Holds the closed form's answers; better ones replace them.
    """
    goal, own = task.goals[f], buffer.errors[:, :, f]
    assert goal.R is not None  # as above
    rough = np.flatnonzero(((own > _ROUNDING) & (own < _ROUGH)).any(axis=0))
    if not len(rough):
        return
    spot, settings = np.ix_(rough, leg.columns), Dls(tolerance=_ROUNDING, max_iterations=2, restarts=0)
    R, p, reachable = goal.R[rough], goal.p[rough, 0], np.ones(len(rough), dtype=bool)
    better = leg_kernel.answers(leg, R, p, buffer.q[spot].T, settings, reachable=reachable)
    gain = better.errors.sum(axis=0) < own[:, rough].sum(axis=0)
    buffer.q[spot] = np.where(gain, better.q, buffer.q[spot].T).T
    buffer.errors[:, rough, f] = np.where(gain, better.errors, own[:, rough])


def write_approximate_seeds(
    task: Problem, f: int, leg: LegAxes, geometry: ClosedFormGeometry, buffer: SolutionBuffer
) -> None:
    """Write seeds for a calibrated leg from the nearest closed form; they count as not reached yet.

    Args:
        task: The problem.
        f: Which target it is.
        leg: The leg that carries the target's frame.
        geometry: Constants of the nearest closed form.
        buffer: Where the seeds go.
    """
    goal = task.goals[f]
    assert goal.R is not None  # as above
    for a in range(0, task.n, CHUNK):
        part = slice(a, a + CHUNK)
        R, p = forward.components(goal.R[part], goal.p[part, 0])
        q = closed_form.approximate_seed(leg, geometry, R, p)
        for j, column in enumerate(leg.columns):
            buffer.q[part, column] = q[j]
    buffer.errors[:, :, f] = np.inf
    buffer.slack[:, f] = reach_slack(leg, goal)


def write_least_squares(
    task: Problem, f: int, leg: LegAxes, settings: Dls, buffer: SolutionBuffer, *, seed: Array | None = None
) -> None:
    """Damped least squares for the samples that are not within the tolerance.

    Args:
        task: The problem.
        f: Which target it is.
        leg: The leg that carries the target's frame.
        settings: Tolerance, number of steps, restarts and weights.
        buffer: Where the answers go.
        seed: Where the samples start (6, n) [rad]; what the buffer holds if left out.
    """
    goal = task.goals[f]
    assert goal.R is not None  # as above
    with np.errstate(invalid="ignore"):
        rest = np.flatnonzero(~(buffer.errors[:, :, f] <= settings.tolerance).all(axis=0))
    if not len(rest):
        return
    begin = buffer.q[np.ix_(rest, leg.columns)].T if seed is None else seed[:, rest]
    reachable = np.asarray(~(buffer.slack[rest, f] < -leg.reach_error))
    own = _weighted(settings, goal)
    answer = leg_kernel.answers(leg, goal.R[rest], goal.p[rest, 0], begin, own, reachable=reachable)
    buffer.q[np.ix_(rest, leg.columns)] = answer.q.T
    buffer.errors[:, rest, f] = answer.errors
    buffer.steps[rest] += answer.steps
    buffer.solver[rest] = SOLVED_BY.index("dls")


def reach_slack(leg: LegAxes | None, goal: Goal) -> Array:
    """How far all samples are inside the leg's reach (n,) [m].

    NaN for targets without a rotation and for frames that no leg carries.
    """
    out = np.full(len(goal.p), np.nan)
    if leg is None or goal.R is None:
        return out
    for a in range(0, len(out), CHUNK):
        part = slice(a, a + CHUNK)
        out[part] = forward.reach_slack(leg, *forward.components(goal.R[part], goal.p[part, 0]))
    return out


def _one_by_one(goal: Goal, leg: LegAxes) -> Array:
    """The closed form in plain `math` for a handful of samples, angles (6, n)."""
    formula = exact_formula(leg)
    assert formula is not None  # its geometry is exact
    assert goal.R is not None  # as above
    rows = np.zeros((len(goal.p), 4, 4))
    rows[:, :3, :3], rows[:, :3, 3] = goal.R, goal.p[:, 0]
    return np.array([formula(T) for T in rows.reshape(-1, 16).tolist()]).reshape(-1, 6).T.copy()


def _weighted(settings: Dls, goal: Goal) -> Dls:
    """The settings with the target's own weights multiplied in."""
    position, rotation = goal.weight[0, 0], goal.rotation_weight
    if position == rotation == 1.0:
        return settings
    return replace(
        settings,
        position_weight=settings.position_weight * position,
        rotation_weight=settings.rotation_weight * rotation,
    )

"""All samples of a leg: closed form, verification, approximate seeds, and least squares for the rest."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array, beside, filled, to_host
from exo_pin.chunks import for_chunks
from exo_pin.ik.leg import closed_form
from exo_pin.ik.leg.geometry import ClosedFormGeometry
from exo_pin.ik.leg.scalar import exact_formula
from exo_pin.ik.problem import Problem, SolutionBuffer
from exo_pin.ik.targets import Goal
from exo_pin.robot import LegAxes
from exo_pin.robot import leg_forward as forward

_FEW = 13  # up to so many samples plain `math` is quicker than arrays


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
    rotations, positions = goal.R, goal.p
    low, high = (beside(limit[:, None], goal.p) for limit in (leg.lower, leg.upper))

    def answer(part: slice) -> None:
        R, p = forward.components(rotations[part], positions[part, 0])
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

    for_chunks(task.n, goal.p, answer)


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
    rotations, positions = goal.R, goal.p

    def seed(part: slice) -> None:
        R, p = forward.components(rotations[part], positions[part, 0])
        q = closed_form.approximate_seed(leg, geometry, R, p)
        for j, column in enumerate(leg.columns):
            buffer.q[part, column] = q[j]

    for_chunks(task.n, goal.p, seed)
    buffer.errors[:, :, f] = np.inf
    buffer.slack[:, f] = reach_slack(leg, goal)


def reach_slack(leg: LegAxes | None, goal: Goal) -> Array:
    """How far all samples are inside the leg's reach (n,) [m].

    NaN for targets without a rotation and for frames that no leg carries.
    """
    out = filled(len(goal.p), np.nan, like=goal.p)
    if leg is None or goal.R is None:
        return out
    rotations, positions = goal.R, goal.p

    def measure(part: slice) -> None:
        out[part] = forward.reach_slack(leg, *forward.components(rotations[part], positions[part, 0]))

    for_chunks(len(out), out, measure)
    return out


def _one_by_one(goal: Goal, leg: LegAxes) -> Array:
    """The closed form in plain `math` for a handful of samples, angles (6, n)."""
    formula = exact_formula(leg)
    assert formula is not None  # its geometry is exact
    assert goal.R is not None  # as above
    rows = np.zeros((len(goal.p), 4, 4))
    rows[:, :3, :3], rows[:, :3, 3] = to_host(goal.R), to_host(goal.p[:, 0])
    q = np.array([formula(T) for T in rows.reshape(-1, 16).tolist()]).reshape(-1, 6).T.copy()
    return beside(q, goal.p)

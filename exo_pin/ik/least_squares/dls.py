"""Damped least squares for the samples of a problem: all at once, or each from the answer before it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from exo_pin.arrays import Array, Index, Mask, beside, to_host
from exo_pin.ik.least_squares.cost import weighted_targets
from exo_pin.ik.least_squares.driver import Minimum, minimise, minimise_with_restarts
from exo_pin.ik.least_squares.leg_kernel import LegKernel
from exo_pin.ik.least_squares.single_sample import SampleKernel
from exo_pin.ik.least_squares.step_limit import step_limits
from exo_pin.ik.least_squares.subtree_kernel import SubtreeKernel
from exo_pin.ik.problem import SOLVED_BY, Problem, SolutionBuffer, problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal, Target
from exo_pin.robot import LegAxes, Robot, Subtree

_COMPROMISE = Dls(tolerance=1e-10)  # no target is expected to be met
_ROUNDING, _ROUGH = 1e-13, 1e-6  # errors between these are worth a refinement [m, rad]


def solve_leg(
    task: Problem, f: int, leg: LegAxes, settings: Dls, buffer: SolutionBuffer, *, seed: Array | None = None
) -> None:
    """Fill in the answers for those samples of a leg that are not within the tolerance.

    Args:
        task: The problem.
        f: Which target it is; it is a full pose.
        leg: The leg that carries the target's frame.
        settings: Tolerance, weights, number of steps and restarts.
        buffer: Where the answers go.
        seed: Where the samples start (6, n) [rad]; what the buffer holds if left out.
    """
    with np.errstate(invalid="ignore"):
        rest = to_host(np.flatnonzero(~(buffer.errors[:, :, f] <= settings.tolerance).all(axis=0)))
    if not len(rest):
        return
    spot = np.ix_(rest, leg.columns)
    begin = to_host(buffer.q[spot]).T if seed is None else seed[:, rest]
    reachable = np.asarray(~(to_host(buffer.slack[rest, f]) < -leg.reach_error))
    kernel = _leg_kernel(task.goals[f], leg, rest, settings)
    answer = minimise_with_restarts(kernel, begin, settings, retry=reachable)
    buffer.q[spot] = beside(answer.q.T, buffer.q)
    buffer.errors[:, rest, f] = beside(answer.errors[:, 0], buffer.q)
    buffer.steps[rest] += beside(answer.steps, buffer.q)
    buffer.solver[rest] = SOLVED_BY.index("dls")


def refine_leg(task: Problem, f: int, leg: LegAxes, buffer: SolutionBuffer) -> None:
    """Two steps more for the few answers whose limits cut off the rounding of a nearly singular pose.

    Args:
        task: The problem.
        f: Which target it is.
        leg: The leg that carries the target's frame.
        buffer: Holds the closed form's answers; better ones replace them.
    """
    own = buffer.errors[:, :, f]
    rough = to_host(np.flatnonzero(((own > _ROUNDING) & (own < _ROUGH)).any(axis=0)))
    if not len(rough):
        return
    spot, settings = np.ix_(rough, leg.columns), Dls(tolerance=_ROUNDING, max_iterations=2)
    begin, before = to_host(buffer.q[spot]).T, to_host(own[:, rough])
    answer = minimise(_leg_kernel(task.goals[f], leg, rough, settings), begin, settings)
    errors = answer.errors[:, 0]
    gain = errors.sum(axis=0) < before.sum(axis=0)
    buffer.q[spot] = beside(np.where(gain, answer.q, begin).T, buffer.q)
    buffer.errors[:, rough, f] = beside(np.where(gain, errors, before), buffer.q)


def solve_together(task: Problem, subtree: Subtree, settings: Dls, buffer: SolutionBuffer) -> None:
    """Fill in the answers for one subtree of revolute and prismatic joints, every sample from its own seed.

    Args:
        task: The problem.
        subtree: One of its subtrees.
        settings: Tolerance, weights, number of steps and restarts.
        buffer: It holds the targets' slack already.
    """
    arrays, places = subtree.arrays, task.places_of(subtree)
    assert arrays is not None  # as the docstring says
    seed = np.broadcast_to(task.seed, (task.n, task.robot.nq))[:, subtree.columns].T
    targets = weighted_targets(arrays, task.goals_of(subtree), settings)
    kernel = SubtreeKernel(arrays, targets, subtree.lower[:, None], subtree.upper[:, None])
    out = minimise_with_restarts(kernel, seed, settings, retry=_reachable(task, subtree, buffer))
    buffer.q[:, subtree.columns] = out.q.T
    buffer.errors[:, :, places] = out.errors.swapaxes(1, 2)
    buffer.steps[:] += out.steps
    buffer.solver[:] = SOLVED_BY.index("dls")


def solve_in_order(task: Problem, subtree: Subtree, settings: Dls, buffer: SolutionBuffer) -> None:
    """Fill in the answers for one subtree sample after sample, each from the one before if settings say so.

    Args:
        task: The problem.
        subtree: One of its subtrees.
        settings: Tolerance, weights, number of steps and restarts, warm start, damping.
        buffer: It holds the targets' slack already.
    """
    goals, places = task.goals_of(subtree), task.places_of(subtree)
    near, own = _reachable(task, subtree, buffer), task.seed.ndim == 2
    warm = settings.warm_start and not own
    compromise = not (subtree.floating or _enough(subtree, goals))
    most = step_limits(subtree.arrays, goals) if compromise and warm and subtree.arrays else None
    weights = settings.position_weight, settings.rotation_weight
    kernel = SampleKernel(subtree, subtree.model.createData(), goals, 0, *weights, compromise)
    seed = subtree.middle if own else task.seed[subtree.columns]
    for k in range(task.n):
        if own:
            seed = task.seed[k, subtree.columns]
        damping = 0.0 if k == 0 and not own else settings.damping  # the first sample has none before it
        here = replace(kernel, k=k, damping=damping, start=seed)
        retry = near[k : k + 1] & (damping == 0.0)
        answer = minimise_with_restarts(here, seed[:, None], settings, retry=retry)
        if most is not None and _jumps(answer, seed, most[k], settings.tolerance):
            limited = subtree.narrowed(seed - most[k], seed + most[k])
            slow = replace(here, subtree=limited, damping=settings.damping)
            answer = minimise(slow, seed[:, None], settings)
        buffer.q[k, subtree.columns] = answer.q[:, 0]
        buffer.errors[:, k, places] = answer.errors[..., 0]
        buffer.steps[k] += answer.steps[0]
        if warm:
            seed = answer.q[:, 0]
    buffer.solver[:] = SOLVED_BY.index("dls")


def settle(
    robot: Robot,
    targets: Mapping[str, Target],
    seed: Array,
    lower: Array,
    upper: Array,
    *,
    base: Array,
    settings: Dls = _COMPROMISE,
) -> Array:
    """The compromise that each sample's seed leads to, within limits of each sample's own.

    Args:
        robot: A robot of revolute and prismatic joints, its base given.
        targets: As in `exo_pin.ik.track`.
        seed: Where each sample starts (n, nq).
        lower: Lower limits (n, nq); a joint between equal limits stands there.
        upper: Upper limits (n, nq).
        base: T_world_pelvis (n, 4, 4).
        settings: Tolerance, weights and number of steps; there are no restarts.

    Returns:
        Configurations (n, nq).
    """
    task, q = problem(robot, targets, seed, base), np.clip(seed, lower, upper)
    for subtree in task.subtrees:
        arrays, columns = subtree.arrays, subtree.columns
        assert arrays is not None  # as the docstring says
        weighted = weighted_targets(arrays, task.goals_of(subtree), settings)
        kernel = SubtreeKernel(arrays, weighted, lower[:, columns].T, upper[:, columns].T)
        q[:, columns] = minimise(kernel, seed[:, columns].T, settings).q.T
    return q


def _leg_kernel(goal: Goal, leg: LegAxes, samples: Index, settings: Dls) -> LegKernel:
    assert goal.R is not None  # a leg has full poses as targets (`Problem.leg_of`)
    return LegKernel.of(
        leg,
        to_host(goal.R[samples]),
        to_host(goal.p[samples, 0]),
        position_weight=settings.position_weight * goal.weight[0, 0],
        rotation_weight=settings.rotation_weight * goal.rotation_weight,
    )


def _reachable(task: Problem, subtree: Subtree, buffer: SolutionBuffer) -> Mask:
    """The samples (n,) that another start may bring to their targets."""
    goals, places = task.goals_of(subtree), task.places_of(subtree)
    legs = [task.robot.leg(name) for name in subtree.frames]
    error = [0.0 if leg is None else leg.reach_error for leg in legs]
    short = np.asarray((buffer.slack[:, places] < np.negative(error)).any(axis=1))
    return np.asarray(~short & _enough(subtree, goals))


def _enough(subtree: Subtree, goals: list[Goal]) -> bool:
    """Whether the joints are as many as the equations; with fewer, a compromise is all that can be had."""
    equations = sum(goal.local.size + (3 if goal.R is not None else 0) for goal in goals)
    return bool(subtree.model.nv >= equations)


def _jumps(answer: Minimum, seed: Array, most: Array, tolerance: float) -> bool:
    """Whether a sample misses its targets and moves further from its seed (J,) than the step limit (J,)."""
    return bool(not answer.reached(tolerance)[0] and (np.abs(answer.q[:, 0] - seed) > most).any())

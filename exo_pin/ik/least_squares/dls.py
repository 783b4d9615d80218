"""Damped least squares for the samples of a problem: all at once, or each from the answer before it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Index, Mask, beside, to_host
from exo_pin.ik.least_squares.driver import (
    QUICK,
    Minimum,
    minimise,
    minimise_with_restarts,
    quick,
    quick_minimum,
)
from exo_pin.ik.least_squares.leg_kernel import LegKernel
from exo_pin.ik.least_squares.nearest_posture import NearestPosture
from exo_pin.ik.least_squares.single_sample import SampleKernel
from exo_pin.ik.least_squares.subtree_kernel import SubtreeKernel, step_limits
from exo_pin.ik.problem import SOLVED_BY, Problem, SolutionBuffer, problem
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal, Target
from exo_pin.robot import LegAxes, Robot, Subtree

_COMPROMISE = Dls(tolerance=1e-10)  # no target is expected to be met
_OUTSIDE = 0.2  # [rad] beyond a limit: more than what calibrated axes move an answer
_ROUNDING, _ROUGH = 1e-13, 1e-6  # errors between these are worth a refinement [m, rad]


def solve_leg(
    task: Problem,
    f: int,
    leg: LegAxes,
    settings: Dls,
    buffer: SolutionBuffer,
    *,
    seed: Array | None = None,
    complete: bool = False,
) -> None:
    """Look for answers to those samples of a leg that are not within the tolerance.

    Where there is none, `settle_leg` has to follow: these steps creep towards a compromise.

    Args:
        task: The problem.
        f: Which target it is; it is a full pose.
        leg: The leg that carries the target's frame.
        settings: Tolerance, weights, number of steps and restarts.
        buffer: Where the answers go.
        seed: Where the samples start (6, n) [rad]; what the buffer holds if left out.
        complete: Whether the start is near the only answer, so that there is none where it leaves the limits.
    """
    rest = buffer.missed(f, settings.tolerance)
    if not len(rest):
        return
    spot = np.ix_(rest, leg.columns)
    begin = to_host(buffer.q[spot]).T if seed is None else seed[:, rest]
    reachable = np.asarray(~(to_host(buffer.slack[rest, f]) < -leg.reach_error))
    if complete:
        outside = np.maximum(leg.lower[:, None] - begin, begin - leg.upper[:, None])
        reachable &= ~(outside.max(axis=0) > _OUTSIDE)
    kernel = _leg_kernel(task.goals[f], leg, rest, settings)
    _write(quick_minimum(kernel, begin, settings, reachable), buffer, rest, f, leg.columns)


def _write(answer: Minimum, buffer: SolutionBuffer, rest: Index, f: int, columns: Index) -> None:
    """Put the answers to some samples of a leg into the buffer.

    Args:
        answer: The answers to m samples.
        buffer: Where they go.
        rest: Numbers of the samples (m,).
        f: Which target it is.
        columns: Where the leg's joints stand in q (6,).
    """
    buffer.q[np.ix_(rest, columns)] = beside(answer.q.T, buffer.q)
    buffer.errors[:, rest, f] = beside(answer.errors[:, 0], buffer.q)
    buffer.steps[rest] += beside(answer.steps, buffer.q)
    buffer.solver[rest] = SOLVED_BY.index("dls")


def settle_leg(
    task: Problem, subtree: Subtree, settings: Dls, buffer: SolutionBuffer, *, after_steps: bool = False
) -> None:
    """Bring those samples of a leg that have no answer to the nearest posture, by Newton steps.

    Args:
        task: The problem.
        subtree: The leg's joints.
        settings: Tolerance, weights, number of steps.
        buffer: It holds where they start, and takes the postures.
        after_steps: Whether they have had quick steps already, which count.
    """
    if after_steps and settings.max_iterations <= QUICK:
        return
    settings = quick(settings, after_steps=after_steps)
    f, columns = task.places_of(subtree)[0], subtree.columns
    rest = buffer.missed(f, settings.tolerance)
    if not len(rest):
        return
    kernel = SubtreeKernel.of(subtree, [_on_host(task.goals[f].only(rest))], settings)
    begin = to_host(buffer.q[np.ix_(rest, columns)]).T
    _write(minimise(kernel, begin, settings), buffer, rest, f, columns)


def follow_leg(task: Problem, subtree: Subtree, leg: LegAxes, settings: Dls, buffer: SolutionBuffer) -> None:
    """Let the missed samples of a leg follow their neighbours where its joints would jump.

    Each was solved on its own, and of several minima neighbours may have found different ones.

    Args:
        task: The problem.
        subtree: The leg's joints.
        leg: Their axes.
        settings: Tolerance and weights.
        buffer: Holds the nearest postures.
    """
    f, arrays = task.places_of(subtree)[0], subtree.arrays
    missed = buffer.missed(f, settings.tolerance)
    if task.n < 2 or not len(missed):
        return
    assert arrays is not None  # six revolute joints
    near = np.unique(np.clip(np.concatenate([missed - 1, missed, missed + 1]), 0, task.n - 1))
    goal, spot = _on_host(task.goals[f].only(near)), np.ix_(near, subtree.columns)
    q = to_host(buffer.q[spot])
    posture, followed = _posture(goal, leg, settings), q.copy()
    for a, b in np.flatnonzero(np.diff(np.pad(np.isin(near, missed), 1))).reshape(-1, 2):
        stretch = np.arange(max(a - 1, 0), min(b + 1, len(near)))  # with the sample before and the one after
        most = step_limits(arrays, [goal.only(stretch)])
        if (np.abs(np.diff(q[stretch], axis=0)) > most[1:]).any():
            followed[a:b] = posture.between(q[stretch[0]], q[stretch[-1]], _poses(goal, range(a, b)))
    if (followed != q).any():
        buffer.q[spot] = beside(followed, buffer.q)
        settle_leg(task, subtree, settings, buffer)


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
    places = task.places_of(subtree)
    seed = np.broadcast_to(task.seed, (task.n, task.robot.nq))[:, subtree.columns].T
    kernel = SubtreeKernel.of(subtree, task.goals_of(subtree), settings)
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
    seed, missed = subtree.middle if own else task.seed[subtree.columns], 0
    for k in range(task.n):
        if own:
            seed = task.seed[k, subtree.columns]
        damping = 0.0 if k == 0 and not own else settings.damping  # the first sample has none before it
        here = replace(kernel, k=k, damping=damping, start=seed)
        retry = near[k : k + 1] & (damping == 0.0)
        answer = _sample(here, seed, settings, retry, missed if warm else 0)
        missed = 0 if answer.reached(settings.tolerance)[0] else missed + 1
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


def _sample(kernel: SampleKernel, seed: Array, settings: Dls, retry: Mask, missed: int) -> Minimum:
    """The answer to one sample; where there is none, by Newton steps, which do not creep.

    Args:
        kernel: The cost.
        seed: Where it starts (nq,).
        settings: Tolerance, number of steps and of restarts.
        retry: Whether another start may reach the targets (1,).
        missed: How many samples right before it have no answer; they and this one share the restarts.
    """
    count = settings.restarts
    starts = range(count) if not (missed and count) else [missed % count]
    if kernel.compromise or kernel.subtree.floating or kernel.damping:
        return minimise_with_restarts(kernel, seed[:, None], settings, retry=retry, starts=starts)
    out = quick_minimum(kernel, seed[:, None], settings, retry, starts)
    if out.reached(settings.tolerance)[0] or settings.max_iterations <= QUICK:
        return out
    nearest = minimise(replace(kernel, compromise=True), out.q, quick(settings, after_steps=True))
    nearest.steps += out.steps
    return nearest


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
        columns = subtree.columns
        kernel = SubtreeKernel.of(subtree, task.goals_of(subtree), settings)
        kernel = replace(kernel, lower=lower[:, columns].T, upper=upper[:, columns].T)
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


def _on_host(goal: Goal) -> Goal:
    R = None if goal.R is None else to_host(goal.R)
    return replace(goal, p=to_host(goal.p), R=R, weight=to_host(goal.weight))


def _posture(goal: Goal, leg: LegAxes, settings: Dls) -> NearestPosture:
    weights = settings.position_weight * goal.weight[0, 0], settings.rotation_weight * goal.rotation_weight
    return NearestPosture(leg, tolerance=settings.tolerance, max_iterations=QUICK, weights=weights)


def _poses(goal: Goal, samples: Iterable[int]) -> list[Any]:
    """Target poses (SE3) of a leg."""
    assert goal.R is not None  # as above
    return [pin.SE3(goal.R[k], goal.p[k, 0]) for k in samples]


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

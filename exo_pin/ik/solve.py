"""`solve` and `track`: from targets to verified joint angles, by the solver that the settings name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from exo_pin.arguments import real, table
from exo_pin.arrays import to_host
from exo_pin.errors import ConvergenceError, DescriptionError, UnknownNameError
from exo_pin.ik.least_squares import dls
from exo_pin.ik.leg import batch
from exo_pin.ik.leg.geometry import approximate_geometry, exact_geometry
from exo_pin.ik.problem import Problem, SolutionBuffer, problem
from exo_pin.ik.remote import copied_back, on_host, remote_array, stays_remote
from exo_pin.ik.result import Solution, Track
from exo_pin.ik.settings import Auto, ClosedForm, Dls, Settings
from exo_pin.ik.targets import Points, Pose, Position, Target, target_numbers
from exo_pin.robot import Robot, Subtree

Solver = Callable[[Problem, Any], Track]

_DEFAULT = Auto()


def track(
    robot: Robot,
    targets: Mapping[str, Target],
    q0: npt.ArrayLike | None = None,
    *,
    base: npt.ArrayLike | None = None,
    settings: Settings = _DEFAULT,
) -> Track:
    """Joint angles that bring frames to their targets, sample by sample.

    Args:
        robot: The robot.
        targets: By name of a frame: T_world_frame (n, 4, 4), or `Pose`, `Position`, `Points` with weights.
            CuPy's arrays are answered by CuPy's arrays: the closed form runs where they are, and samples
            that it does not solve are answered on the host and copied back.
        q0: Where to start: (nq,) for the first sample, (n, nq) for every sample its own; mid-range if left
            out. Joints that move no target keep its values (zero if left out).
        base: T_world_pelvis (4, 4) or (n, 4, 4), as in `exo_pin.kinematics.poses`; the robot's own placement
            if left out. The pelvis of a robot with a floating base is held there, or solved too if left out.
        settings: Picks the solver and its tolerances.

    Returns:
        The answers within the joint limits; a sample that misses its target is not `converged`.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: A shape, number or matrix is wrong; the message names the target and the sample.
    """
    solver, like = _solver(settings), remote_array(table("targets", targets))
    base_moves = robot.base == "floating" and base is None
    if like is None or (stays_remote(robot, targets, settings) and not base_moves):
        return solver(problem(robot, targets, q0, base), settings)
    held = None if base is None else to_host(real("base", base))
    return copied_back(solver(problem(robot, on_host(targets), q0, held), settings), like)


def solve(
    robot: Robot,
    targets: Mapping[str, Target],
    q0: npt.ArrayLike | None = None,
    *,
    base: npt.ArrayLike | None = None,
    settings: Settings = _DEFAULT,
) -> Solution:
    """Joint angles for one sample; arguments as in `track` without the axis of samples.

    Args:
        robot: The robot.
        targets: By name of a frame: T_world_frame (4, 4), or `Pose`, `Position`, `Points` with weights.
        q0: Where to start (nq,); mid-range if left out.
        base: T_world_pelvis (4, 4); the robot's own placement if left out.
        settings: Picks the solver and its tolerances.

    Raises:
        ConvergenceError: The targets were not reached; `.solution` holds the best try.
        UnknownNameError: A frame is unknown.
        DescriptionError: A shape, number or matrix is wrong.
    """
    one = {frame: _one(frame, target) for frame, target in table("targets", targets).items()}
    answer = track(robot, one, q0, base=base, settings=settings)[0]
    if not answer.converged:
        raise ConvergenceError(_miss(answer), answer)
    return answer


def _auto(task: Problem, settings: Auto) -> Track:
    """Closed form, check, and damped least squares for the rest, each subtree by the best it allows."""
    buffer, iterative = SolutionBuffer.blank(task), replace(settings.dls, tolerance=settings.tolerance)
    for subtree in task.subtrees:
        f, leg = task.places_of(subtree)[0], task.leg_of(subtree)
        exact = None if leg is None else exact_geometry(leg)
        near = None if leg is None else exact or approximate_geometry(leg)
        if leg is None or near is None:
            _iterate(task, subtree, iterative, buffer)
            continue
        if exact:
            batch.write_closed_form(task, f, leg, exact, buffer)
            dls.refine_leg(task, f, leg, buffer)
        else:
            batch.write_approximate_seeds(task, f, leg, near, buffer)
        if not (exact and exact.complete):
            dls.solve_leg(task, f, leg, iterative, buffer, complete=near.complete)
        dls.settle_leg(task, subtree, iterative, buffer)
        dls.follow_leg(task, subtree, leg, iterative, buffer)
    return buffer.track(task, settings.tolerance)


def _closed_form(task: Problem, settings: ClosedForm) -> Track:
    """The closed form, checked.

    Raises:
        DescriptionError: A target is not the full pose of a leg that has a closed form.
    """
    buffer = SolutionBuffer.blank(task)
    for subtree in task.subtrees:
        leg = task.leg_of(subtree)
        exact = None if leg is None else exact_geometry(leg)
        if leg is None or exact is None:
            raise DescriptionError(
                f"{', '.join(subtree.frames)}: no closed form; it needs the full pose of a frame on a leg of "
                "six joints whose hip axes meet, and so on (docs/ik.md). Auto() finds an answer all the same"
            )
        batch.write_closed_form(task, task.places_of(subtree)[0], leg, exact, buffer)
    return buffer.track(task, settings.tolerance)


def _least_squares(task: Problem, settings: Dls) -> Track:
    """Damped least squares alone."""
    buffer = SolutionBuffer.blank(task)
    for subtree in task.subtrees:
        _iterate(task, subtree, settings, buffer)
    return buffer.track(task, settings.tolerance)


def _iterate(task: Problem, subtree: Subtree, settings: Dls, buffer: SolutionBuffer) -> None:
    """All samples at once where they do not wait for each other, else one after the other."""
    for f in task.places_of(subtree) if not subtree.floating else ():
        goal = task.goals[f]
        buffer.slack[:, f] = batch.reach_slack(task.robot.leg(goal.frame), goal)
    apart = task.seed.ndim == 2 or not settings.warm_start
    arrays = subtree.arrays if apart and task.n > 1 and not settings.damping else None
    leg = task.leg_of(subtree)
    if arrays is None:
        dls.solve_in_order(task, subtree, settings, buffer)
    elif leg is None:
        dls.solve_together(task, subtree, settings, buffer)
    else:
        seed = np.broadcast_to(task.seed, (task.n, task.robot.nq))[:, leg.columns].T
        dls.solve_leg(task, task.places_of(subtree)[0], leg, settings, buffer, seed=seed)
        dls.settle_leg(task, subtree, settings, buffer, after_steps=True)


SOLVERS: dict[type, Solver] = {Auto: _auto, ClosedForm: _closed_form, Dls: _least_squares}
"""What answers each kind of settings."""


def _solver(settings: Settings) -> Solver:
    if type(settings) not in SOLVERS:
        raise UnknownNameError("solver", type(settings).__name__, [kind.__name__ for kind in SOLVERS])
    return SOLVERS[type(settings)]


def _one(frame: str, target: Target) -> Target:
    """The target of one sample as that of a track of one."""
    if isinstance(target, Pose):
        return replace(target, T=target_numbers(frame, target.T)[None])
    if isinstance(target, (Position, Points)):
        return replace(target, p=target_numbers(frame, target.p)[None])
    return target_numbers(frame, target)[None]


def _miss(answer: Solution) -> str:
    parts = []
    for f, name in enumerate(answer.frames):
        slack = answer.reach_slack[f]
        reach = f", {-slack * 1e3:.1f} mm out of reach" if slack < 0 else ""
        rotation = answer.rotation_error[f]
        angle = "" if np.isnan(rotation) else f" and {np.degrees(rotation):.3g} deg"
        parts.append(f"{name} misses by {answer.position_error[f] * 1e3:.3g} mm{angle}{reach}")
    return "; ".join(parts) + " (best try in .solution)"

"""`solve` and `track`: targets in, verified joint angles out; the settings object picks the solver."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from exo_pin.errors import ConvergenceError, UnknownNameError
from exo_pin.ik.problem import Problem, problem
from exo_pin.ik.result import Solution, Track
from exo_pin.ik.settings import Auto, ClosedForm, Dls, Settings
from exo_pin.ik.solvers import auto, closed, descend
from exo_pin.ik.targets import Points, Pose, Position, Target
from exo_pin.robot import Robot

Solver = Callable[[Problem, Any], Track]

SOLVERS: dict[type, Solver] = {Auto: auto, ClosedForm: closed, Dls: descend}
"""What answers each kind of settings."""

DEFAULT = Auto()


def track(
    robot: Robot,
    targets: Mapping[str, Target],
    q0: npt.ArrayLike | None = None,
    *,
    base: npt.ArrayLike | None = None,
    settings: Settings = DEFAULT,
) -> Track:
    """Joint angles that bring frames to their targets, sample by sample.

    Args:
        robot: The robot.
        targets: By name of a frame: T_world_frame (n, 4, 4), or `Pose`, `Position`, `Points` with weights.
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
    return _solver(settings)(problem(robot, targets, q0, base), settings)


def solve(
    robot: Robot,
    targets: Mapping[str, Target],
    q0: npt.ArrayLike | None = None,
    *,
    base: npt.ArrayLike | None = None,
    settings: Settings = DEFAULT,
) -> Solution:
    """Joint angles for one sample; arguments as in `track` without the axis of samples.

    Raises:
        ConvergenceError: The targets were not reached; `.solution` holds the best try.
        UnknownNameError: A frame is unknown.
        DescriptionError: A shape, number or matrix is wrong.
    """
    one = {frame: _one(target) for frame, target in targets.items()}
    answer = track(robot, one, q0, base=base, settings=settings)[0]
    if not answer.converged:
        raise ConvergenceError(_miss(answer), answer)
    return answer


def _solver(settings: Settings) -> Solver:
    if type(settings) not in SOLVERS:
        raise UnknownNameError("solver", type(settings).__name__, [kind.__name__ for kind in SOLVERS])
    return SOLVERS[type(settings)]


def _one(target: Target) -> Target:
    if isinstance(target, Pose):
        return replace(target, T=np.asarray(target.T)[None])
    if isinstance(target, (Position, Points)):
        return replace(target, p=np.asarray(target.p)[None])
    return np.asarray(target)[None]


def _miss(answer: Solution) -> str:
    parts = []
    for f, name in enumerate(answer.frames):
        slack = answer.reach_slack[f]
        reach = f", {-slack * 1e3:.1f} mm out of reach" if slack < 0 else ""
        turn = answer.rotation_error[f]
        angle = "" if np.isnan(turn) else f" and {np.degrees(turn):.3g} deg"
        parts.append(f"{name} misses by {answer.position_error[f] * 1e3:.3g} mm{angle}{reach}")
    return "; ".join(parts) + " (best try in .solution)"

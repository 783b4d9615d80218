"""Feet dragged in the live page: inverse kinematics answers where the legs get."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from exo_pin import ik
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot, load_urdf
from exo_pin.robot.floating_base import base_poses
from exo_pin.viewer.live.messages import Reached, ReachRequest

ROTATION_WEIGHT = 0.1
"""What a rotation error of 1 rad counts in metres: about what it moves the sole's points (a choice)."""

TOLERANCE = 1e-6
"""A foot this near to its target [m, rad] is there."""

_NEAREST = ik.Dls(tolerance=TOLERANCE, max_iterations=40, restarts=0)
"""For targets out of reach: from the pose at present, so that the leg does not jump; at most some 10 ms."""


def reach_solver(robot: Robot, joints: Sequence[str]) -> Callable[[ReachRequest], Reached]:
    """A function that answers a page's requests for a robot.

    The closed form answers where it can; else damped least squares give the nearest pose within the joint
    limits, nearest in metres and `ROTATION_WEIGHT` times radians.

    Args:
        robot: The robot that the page shows.
        joints: Names of its URDF's joints in the order of the page's chain.

    Returns:
        Request -> answer; a foot that is at its target within `TOLERANCE` misses by exactly 0.
    """
    own = load_urdf(robot.urdf)  # what the page shows: its root link at the origin, its locked joints locked
    columns = [own.joints.index(name) for name in joints]

    def answer(request: ReachRequest) -> Reached:
        start = own.neutral
        start[columns] = request.q
        targets = {name: _target(pose) for name, pose in request.feet.items()}
        found = _solve(own, targets, np.clip(start, own.lower, own.upper))
        errors = np.stack([found.position_error[0], found.rotation_error[0]], axis=1)
        errors[(errors <= TOLERANCE).all(axis=1)] = 0.0
        misses = {name: (far, off) for name, (far, off) in zip(found.frames, errors.tolist(), strict=True)}
        return Reached(request.id, tuple(found.q[0, columns].tolist()), misses)

    return answer


def _solve(robot: Robot, targets: dict[str, ik.Pose], start: Array) -> ik.Track:
    try:
        exact = ik.track(robot, targets, start, settings=ik.ClosedForm(tolerance=TOLERANCE))
        if exact.converged[0]:
            return exact
    except DescriptionError:  # a leg without a closed form
        pass
    return ik.track(robot, targets, start, settings=_NEAREST)


def _target(pose: tuple[float, ...]) -> ik.Pose:
    T = base_poses(np.array(pose))
    return ik.Pose(T[None], rotation_weight=ROTATION_WEIGHT)

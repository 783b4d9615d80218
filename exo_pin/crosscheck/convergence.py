"""How the error of the iterative solver falls from step to step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.arguments import count
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import angle_of
from exo_pin.kinematics import poses
from exo_pin.robot import Robot

_MOST_STEPS = 30


def errors_by_step(robot: Robot, gait: Gait, sample: int, *, tolerance: float) -> Array:
    """Larger foot error `(steps + 1,)` [m or rad] after 0, 1, 2 .. corrections, from mid-range.

    Every entry is a solution of its own with that many steps at most; the last one has converged, or is the
    30th.

    Args:
        robot: The robot.
        gait: The walk.
        sample: Row of the walk whose feet are the target.
        tolerance: Of both errors, at which the iteration ends [m or rad].

    Raises:
        DescriptionError: There is no such sample, or the tolerance is no positive number.
    """
    sample = count("sample", sample, 0, len(gait) - 1)
    row = gait.base[sample : sample + 1] if gait.base is not None and robot.base == "fixed" else None
    q = robot.from_gait(gait)[sample : sample + 1]
    feet = poses(robot, q, FEET, base=row)
    targets = {foot: feet[:, k] for k, foot in enumerate(FEET)}
    middle = robot.neutral
    middle[robot.nq - len(robot.joints) :] = 0.5 * (robot.lower + robot.upper)
    start = poses(robot, middle[None], FEET, base=row)
    turn = np.swapaxes(start[0, :, :3, :3], -1, -2) @ feet[0, :, :3, :3]
    away = np.linalg.norm(start[0, :, :3, 3] - feet[0, :, :3, 3], axis=-1)
    errors = [float(max(angle_of(turn).max(), away.max()))]
    settings = ik.Dls(tolerance=tolerance, restarts=0)
    for steps in range(1, _MOST_STEPS + 1):
        track = ik.track(robot, targets, middle, base=row, settings=replace(settings, max_iterations=steps))
        errors.append(float(max(track.position_error.max(), track.rotation_error.max())))
        if track.converged.all():
            break
    return np.array(errors)

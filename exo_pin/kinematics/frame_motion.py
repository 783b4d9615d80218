"""Velocities, accelerations and Jacobians of frames, one sample or many or along a gait, by Pinocchio.

Spatial vectors are linear first, then angular, both in world axes; the linear part is that of the frame's
origin. With configurations `base` is held still; the pelvis of a gait moves as the gait has it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.anatomy import FEET
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics.gait_motion import (
    GaitMotion,
    carried_acceleration,
    carried_spin,
    carried_turning,
    carried_velocity,
    gait_motion,
    placed,
)
from exo_pin.kinematics.motion import frame_indices, moved, positions, samples
from exo_pin.robot import Robot

_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


def velocities(
    robot: Robot,
    q: Gait | npt.ArrayLike,
    dq: npt.ArrayLike | None = None,
    frames: Sequence[str] = FEET,
    *,
    base: npt.ArrayLike | None = None,
) -> Array:
    """Velocities (..., F, 6) [m/s, rad/s] of the named frames: linear, then angular, in world axes.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait, whose own rates and moving pelvis are used.
        dq: Joint velocities (..., nv) [rad/s]; not with a gait.
        frames: Names of links, point frames or joints.
        base: T_world_pelvis as in `poses`, held still; not with a gait.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: The shape of q, dq or base does not fit, a number is not finite, or rates are given
            with a gait.
    """
    if isinstance(q, Gait):
        _refuse(dq=dq, base=base)
        walk = gait_motion(robot, q)
        still = velocities(robot, walk.q, walk.dq, frames, base=walk.base)
        points = positions(robot, walk.q, frames, base=walk.base)
        linear = carried_velocity(walk, points, still[..., :3])
        return np.concatenate([linear, carried_turning(walk, still[..., 3:])], axis=-1)
    rows, shape = samples(robot, q)
    speeds = rates(robot, dq, shape, "dq")

    def _row(data: Any, k: int, ids: list[int]) -> list[Array]:
        pin.forwardKinematics(robot.model, data, rows[k], speeds[k])
        return [pin.getFrameVelocity(robot.model, data, i, _AXES).vector for i in ids]

    return _spatial(robot, len(rows), shape, frames, base, _row)


def accelerations(
    robot: Robot,
    q: Gait | npt.ArrayLike,
    dq: npt.ArrayLike | None = None,
    ddq: npt.ArrayLike | None = None,
    frames: Sequence[str] = FEET,
    *,
    base: npt.ArrayLike | None = None,
) -> Array:
    """Accelerations (..., F, 6) [m/s^2, rad/s^2]: of the frame's origin and angular, in world axes.

    The linear part is the classical (material) one, the derivative of the origin's velocity; gravity is not
    in it.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait, whose own rates and moving pelvis are used.
        dq: Joint velocities (..., nv) [rad/s]; not with a gait.
        ddq: Joint accelerations (..., nv) [rad/s^2]; not with a gait.
        frames: Names of links, point frames or joints.
        base: T_world_pelvis as in `poses`, held still; not with a gait.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: The shape of q, dq, ddq or base does not fit, a number is not finite, or rates are
            given with a gait.
    """
    if isinstance(q, Gait):
        _refuse(dq=dq, ddq=ddq, base=base)
        return _gait_accelerations(robot, gait_motion(robot, q), frames)
    rows, shape = samples(robot, q)
    speeds, changes = rates(robot, dq, shape, "dq"), rates(robot, ddq, shape, "ddq")

    def _row(data: Any, k: int, ids: list[int]) -> list[Array]:
        pin.forwardKinematics(robot.model, data, rows[k], speeds[k], changes[k])
        return [pin.getFrameClassicalAcceleration(robot.model, data, i, _AXES).vector for i in ids]

    return _spatial(robot, len(rows), shape, frames, base, _row)


def _gait_accelerations(robot: Robot, walk: GaitMotion, frames: Sequence[str]) -> Array:
    """Of frames along a gait: about the still pelvis, and what its motion adds."""
    speed = velocities(robot, walk.q, walk.dq, frames, base=walk.base)
    still = accelerations(robot, walk.q, walk.dq, walk.ddq, frames, base=walk.base)
    points = positions(robot, walk.q, frames, base=walk.base)
    linear = carried_acceleration(walk, points, speed[..., :3], still[..., :3])
    return np.concatenate([linear, carried_spin(walk, speed[..., 3:], still[..., 3:])], axis=-1)


def _refuse(**given: npt.ArrayLike | None) -> None:
    """A gait has its own rates and pelvis."""
    for name, value in given.items():
        if value is not None:
            raise DescriptionError(f"{name} is given with a gait, which has its own; leave it out")


def jacobian(
    robot: Robot, q: Gait | npt.ArrayLike, frame: str, *, base: npt.ArrayLike | None = None
) -> Array:
    """Jacobian (..., 6, nv) of a frame: `jacobian @ dq` is its velocity as `velocities` gives it.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait.
        frame: Name of a link, point frame or joint.
        base: T_world_pelvis as in `poses`.

    Raises:
        UnknownNameError: The frame is unknown.
        DescriptionError: The shape of q or base does not fit, or a number is not finite.
    """
    q, base = placed(robot, q, base)
    index = robot.frame(frame)
    data = robot.model.createData()
    rows, shape = samples(robot, q)
    out = np.empty((len(rows), 6, robot.model.nv))
    for k, row in enumerate(rows):
        out[k] = pin.computeFrameJacobian(robot.model, data, row, index, _AXES)
    out = out.reshape(*shape, 6, robot.model.nv)
    if base is None:
        return out
    R = moved(robot, base, shape)[..., :3, :3]
    return np.concatenate([R @ out[..., :3, :], R @ out[..., 3:, :]], axis=-2)


def rates(robot: Robot, values: npt.ArrayLike | None, shape: tuple[int, ...], name: str) -> Array:
    """Joint velocities or accelerations as rows (n, nv), checked against the samples.

    Args:
        robot: The robot.
        values: (..., nv) [rad/s] or [rad/s^2].
        shape: Shape (...) of the samples of q.
        name: Name of the argument in messages.

    Raises:
        DescriptionError: The shape does not fit that of q, or a number is not finite.
    """
    if values is None:
        raise DescriptionError(
            f"{name} is missing; rates {(*shape, robot.model.nv)}, or a gait in place of q"
        )
    return real(name, values, (*shape, robot.model.nv)).reshape(-1, robot.model.nv)


def _spatial(
    robot: Robot,
    n: int,
    shape: tuple[int, ...],
    frames: Sequence[str],
    base: npt.ArrayLike | None,
    row: Callable[[Any, int, list[int]], list[Array]],
) -> Array:
    """Spatial vectors (..., F, 6) sample by sample, turned with the base."""
    ids = frame_indices(robot, frames)
    data = robot.model.createData()
    out = np.array([row(data, k, ids) for k in range(n)]).reshape(*shape, len(ids), 6)
    if base is None:
        return out
    R = moved(robot, base, shape)[..., None, :3, :3]
    turned = R @ out.reshape(*shape, len(ids), 2, 3).swapaxes(-1, -2)
    return np.asarray(turned.swapaxes(-1, -2).reshape(out.shape))

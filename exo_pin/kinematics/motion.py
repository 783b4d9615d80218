"""Poses of frames, one sample or many or along a gait, by Pinocchio or formulas on whole arrays.

`base` moves the whole robot: it is T_world_pelvis, one (4, 4) or one per sample (..., 4, 4).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.anatomy import FEET
from exo_pin.arguments import names, real
from exo_pin.arrays import Array, as_floats, beside, is_remote
from exo_pin.chunks import for_chunks
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics.gait_motion import placed
from exo_pin.kinematics.leg_poses import legs_of, write_leg_poses
from exo_pin.robot import Robot

_MANY = 200
"""From so many samples on formulas on whole arrays are quicker than Pinocchio, one sample after the other:
equal at 30 (sole corners) to 100 (feet), 12 to 20 times as quick from 6000 on."""


def poses(
    robot: Robot, q: Gait | npt.ArrayLike, frames: Sequence[str] = FEET, *, base: npt.ArrayLike | None = None
) -> Array:
    """Poses T_world_frame (..., F, 4, 4) of the named frames.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait. CuPy's arrays are answered where they live, for
            frames on legs of six joints.
        frames: Names of links, point frames or joints.
        base: T_world_pelvis (4, 4) or (..., 4, 4); the robot's own placement if left out.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: The shape of q or base does not fit, or a number is not finite.
    """
    q, base = placed(robot, q, base)
    ids = frame_indices(robot, frames)
    remote = is_remote(q)
    rows, shape = _remote_samples(robot, as_floats(q)) if remote else samples(robot, q)
    out = np.empty((len(rows), len(ids), 4, 4), like=rows)
    legs = legs_of(robot, frames) if remote or len(rows) >= _MANY else {}
    others = {k: index for k, index in enumerate(ids) if k not in legs}
    for k in others if remote else ():
        raise DescriptionError(
            f"{frames[k]}: no frame on a leg of six joints; others take an array of NumPy (`q.get()`)"
        )
    write_leg_poses(legs, rows, out)
    _write_poses(robot, rows, others, out)
    out = out.reshape(*shape, len(ids), 4, 4)
    return out if base is None else beside(moved(robot, base, shape), out)[..., None, :, :] @ out


def positions(
    robot: Robot, q: Gait | npt.ArrayLike, frames: Sequence[str] = FEET, *, base: npt.ArrayLike | None = None
) -> Array:
    """Positions (..., F, 3) [m] of the named frames' origins in the world, a quarter of the poses' memory.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait.
        frames: Names of links, point frames or joints.
        base: T_world_pelvis as in `poses`.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: The shape of q or base does not fit.
    """
    q, base = placed(robot, q, base)
    rows, shape = samples(robot, q)
    out = np.empty((len(rows), len(frame_indices(robot, frames)), 3))
    bases = None if base is None else checked_base(robot, base, shape)

    def of_chunk(part: slice) -> None:
        out[part] = poses(robot, rows[part], frames)[..., :3, 3]
        if bases is not None:
            at = bases if bases.ndim == 2 else bases.reshape(-1, 4, 4)[part]
            T = moved(robot, at, at.shape[:-2])
            out[part] = out[part] @ T[..., :3, :3].swapaxes(-1, -2) + T[..., None, :3, 3]

    for_chunks(len(rows), rows, of_chunk)
    return out.reshape(*shape, -1, 3)


def _write_poses(robot: Robot, rows: Array, frames: dict[int, int], out: Array) -> None:
    """Write poses of any frames, Pinocchio's index by the place in `out (n, F, 4, 4)`, sample by sample."""
    model, data = robot.model, robot.model.createData()
    moving = {k: index for k, index in frames.items() if model.frames[index].parentJoint}
    for n, row in enumerate(rows if moving else ()):
        pin.framesForwardKinematics(model, data, row)
        for k, index in moving.items():
            out[n, k] = data.oMf[index].homogeneous
    if moving.keys() != frames.keys():  # a pelvis that stands still
        pin.framesForwardKinematics(model, data, robot.neutral)
        for k in frames.keys() - moving.keys():
            out[:, k] = data.oMf[frames[k]].homogeneous


def _remote_samples(robot: Robot, q: Array) -> tuple[Array, tuple[int, ...]]:
    """As `samples`, left where they live."""
    shape = robot.angles(q).shape[:-1]
    return q.reshape(-1, robot.nq), shape


def attitude(robot: Robot, q: npt.ArrayLike, frame: str, *, relative_to: str) -> Array:
    """Rotation (..., 3, 3) of one link, joint or frame seen from another: R_relative_frame.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad].
        frame: Name of the frame.
        relative_to: Name of the frame that it is seen from.

    Raises:
        UnknownNameError: A frame is unknown.
        DescriptionError: The shape of q does not fit, or a number is not finite.
    """
    R = poses(robot, q, (relative_to, frame))[..., :3, :3]
    return np.asarray(np.swapaxes(R[..., 0, :, :], -1, -2) @ R[..., 1, :, :])


def samples(robot: Robot, q: npt.ArrayLike) -> tuple[Array, tuple[int, ...]]:
    """Configurations as rows (n, nq) and the shape in front, checked, their quaternions of length 1.

    Raises:
        DescriptionError: The last axis is not nq, a number is not finite, or the quaternion of a floating
            base is zero.
    """
    q = robot.configurations(q)
    shape = q.shape[:-1]
    rows = q.reshape(-1, robot.nq)
    return rows if robot.base == "fixed" else robot.unit_quaternion(rows), shape


def moved(robot: Robot, base: npt.ArrayLike, shape: tuple[int, ...]) -> Array:
    """What carries the robot from its own placement to `base`: (..., 4, 4).

    Args:
        robot: The robot.
        base: T_world_pelvis (4, 4) or (..., 4, 4).
        shape: Shape (...) of the samples of q.

    Raises:
        DescriptionError: The shape does not fit, a number is not finite, or the robot's base floats and
            stands in q already.
    """
    base = checked_base(robot, base, shape)
    T: Array = base @ beside(np.linalg.inv(robot.placement), base)
    return T


def checked_base(robot: Robot, base: npt.ArrayLike, shape: tuple[int, ...]) -> Array:
    """The argument `base` as an array (4, 4) or (..., 4, 4); arguments and errors as of `moved`."""
    if robot.base == "floating":
        raise DescriptionError("the base of a floating robot stands in q; base= is for base='fixed'")
    base = real("base", base)
    if base.shape not in ((4, 4), (*shape, 4, 4)):
        raise DescriptionError(f"base has shape {base.shape}; (4, 4) or {(*shape, 4, 4)} is accepted")
    return base


def frame_indices(robot: Robot, frames: Sequence[str]) -> list[int]:
    """Pinocchio's indices of frames by name; raises `UnknownNameError`."""
    return [robot.frame(name) for name in names("frames", frames)]

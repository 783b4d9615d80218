"""Motion of the model: pelvis poses and joint angles as Pinocchio's positions, velocities, accelerations."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from exo_pin.arguments import number, real
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import in_own_axes, nearest_pose
from exo_pin.kinematics import smoothed_curves
from exo_pin.kinematics.gait_motion import gait_motion
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr
from exo_pin.signals import CUTOFF

_ORDER = 6
"""Of both passes together."""


@dataclass(frozen=True, eq=False)
class Motion:
    """The motion of a floating robot in Pinocchio's coordinates.

    Attributes:
        q: `(n, nq)` pelvis position, quaternion, joint angles [m, rad].
        v: `(n, nv)` velocity of the pelvis in its own axes, linear first, then the joints' [m/s, rad/s].
        a: `(n, nv)` spatial acceleration of the pelvis in its own axes, then the joints' [m/s^2, rad/s^2].
        base: `(n, 4, 4)` pose of the pelvis.
        how: Filter and derivative, in words.
    """

    q: Array
    v: Array
    a: Array
    base: Array
    how: str

    __repr__ = short_repr


def motion(robot: Robot, gait: Gait, *, cutoff: float | None = CUTOFF) -> Motion:
    """Positions, velocities and accelerations of a walk.

    A recording is low-pass filtered first, angles and pelvis alike. A periodic walk is differentiated by its
    Fourier series and not filtered.

    Args:
        robot: A floating robot.
        gait: The walk, with the motion of its pelvis.
        cutoff: Low-pass of a recording [Hz]; None: no filter.

    Raises:
        DescriptionError: The cutoff is not positive.
    """
    if cutoff is not None:
        number("cutoff", cutoff, above=0.0)
    walk, how = _smoothed(gait, cutoff)
    assert walk.base is not None
    moving = gait_motion(robot, walk)
    return Motion(q=moving.q, v=moving.dq, a=moving.ddq, base=walk.base, how=how)


def in_pelvis_axes(T: Array, velocity: Array, acceleration: Array) -> tuple[Array, Array]:
    """Velocity and spatial acceleration of a frame, in its own axes, as Pinocchio's free joint has them.

    Formula and source: `exo_pin.gait.rigid_poses.in_own_axes`.

    Args:
        T: `(n, 4, 4)` poses in the world.
        velocity: `(n, 6)` of the origin, then angular, world axes [m/s, rad/s].
        acceleration: `(n, 6)` of the origin, then angular, world axes [m/s^2, rad/s^2].

    Returns:
        `(n, 6)` velocity and `(n, 6)` spatial acceleration.

    Raises:
        DescriptionError: A shape differs, or a number is not finite.
    """
    T = real("T", T, ("n", 4, 4))
    velocity = real("velocity", velocity, (len(T), 6))
    acceleration = real("acceleration", acceleration, (len(T), 6))
    return in_own_axes(T, velocity, acceleration)


def _smoothed(gait: Gait, cutoff: float | None) -> tuple[Gait, str]:
    """The walk with filtered angles and pelvis, and a sentence on how."""
    if gait.periodic:
        return gait, "Derivatives of the walk's Fourier series; not filtered."
    assert gait.base is not None
    n, joints = gait.q.shape
    curves = np.hstack([gait.q, gait.base.reshape(n, 16)])
    smooth, how = smoothed_curves(gait, curves, cutoff, order=_ORDER, what="Angles and pelvis")
    base = nearest_pose(smooth[:, joints:].reshape(n, 4, 4))
    return dataclasses.replace(gait, q=smooth[:, :joints], base=base), f"{how} Second-order differences."

"""A whole gait as motion of a robot: coordinates with their rates, and what a moving pelvis adds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import in_own_axes
from exo_pin.kinematics.joint_rates import joint_rates
from exo_pin.robot import Robot


class GaitMotion(NamedTuple):
    """Coordinates of a robot along a gait, n samples.

    Attributes:
        q: `(n, nq)` configurations [rad, m].
        dq: `(n, nv)` their rates [rad/s, m/s].
        ddq: `(n, nv)` the rates' rates [rad/s^2, m/s^2].
        base: `(n, 4, 4)` T_world_pelvis; None: the pelvis is in q, or does not move.
        velocity: `(n, 6)` of the base, linear first, world axes [m/s, rad/s]; None where `base` is None.
        acceleration: `(n, 6)` of the base [m/s^2, rad/s^2]; None where `base` is None.
    """

    q: Array
    dq: Array
    ddq: Array
    base: Array | None = None
    velocity: Array | None = None
    acceleration: Array | None = None


def gait_motion(robot: Robot, gait: Gait) -> GaitMotion:
    """The motion of a robot along a gait, differentiated as `Gait.dq` is, not filtered.

    Args:
        robot: With a fixed or a floating base.
        gait: The walk.
    """
    q, joints = robot.from_gait(gait), joint_rates(robot, gait, cutoff=None)
    if robot.base == "fixed":
        return GaitMotion(q, joints.dq, joints.ddq, gait.base, gait.base_velocity, gait.base_acceleration)
    still = np.zeros((len(gait), 6))
    velocity, acceleration = still, still
    if gait.base is not None and gait.base_velocity is not None and gait.base_acceleration is not None:
        velocity, acceleration = in_own_axes(gait.base, gait.base_velocity, gait.base_acceleration)
    return GaitMotion(q, np.hstack([velocity, joints.dq]), np.hstack([acceleration, joints.ddq]))


def placed(robot: Robot, q: Gait | ArrayLike, base: ArrayLike | None) -> tuple[ArrayLike, ArrayLike | None]:
    """Configurations and T_world_pelvis of a gait, or those that were given.

    Args:
        robot: The robot.
        q: A gait, or configurations.
        base: T_world_pelvis, if it is not the gait's own.
    """
    if not isinstance(q, Gait):
        return q, base
    return robot.from_gait(q), robot.base_of(q) if base is None else base


def carried_velocity(motion: GaitMotion, points: Array, velocity: Array) -> Array:
    """Velocities of points in the world, where those about a pelvis held still are known.

    Args:
        motion: Of the gait.
        points: `(n, F, 3)` where they are in the world [m].
        velocity: `(n, F, 3)` linear about the still pelvis, world axes [m/s].
    """
    if motion.base is None or motion.velocity is None:
        return velocity
    linear, turning = motion.velocity[:, None, :3], motion.velocity[:, None, 3:]
    arm = points - motion.base[:, None, :3, 3]
    return np.asarray(velocity + linear + np.cross(turning, arm))


def carried_acceleration(motion: GaitMotion, points: Array, velocity: Array, acceleration: Array) -> Array:
    """Accelerations likewise: with the Euler, centripetal and Coriolis terms of the turning pelvis.

    Args:
        motion: Of the gait.
        points: `(n, F, 3)` [m].
        velocity: `(n, F, 3)` about the still pelvis [m/s].
        acceleration: `(n, F, 3)` about the still pelvis [m/s^2].
    """
    if motion.base is None or motion.velocity is None or motion.acceleration is None:
        return acceleration
    turning = motion.velocity[:, None, 3:]
    linear, angular = motion.acceleration[:, None, :3], motion.acceleration[:, None, 3:]
    arm = points - motion.base[:, None, :3, 3]
    centripetal = np.cross(turning, np.cross(turning, arm))
    coriolis = 2.0 * np.cross(turning, velocity)
    return np.asarray(acceleration + linear + np.cross(angular, arm) + centripetal + coriolis)


def carried_turning(motion: GaitMotion, turning: Array) -> Array:
    """Angular velocities `(n, F, 3)` in the world, from those about the still pelvis [rad/s]."""
    return turning if motion.velocity is None else np.asarray(turning + motion.velocity[:, None, 3:])


def carried_spin(motion: GaitMotion, turning: Array, spin: Array) -> Array:
    """Angular accelerations `(n, F, 3)` in the world.

    Args:
        motion: Of the gait.
        turning: `(n, F, 3)` angular velocities about the still pelvis [rad/s].
        spin: `(n, F, 3)` angular accelerations about it [rad/s^2].
    """
    if motion.velocity is None or motion.acceleration is None:
        return spin
    return np.asarray(
        spin + motion.acceleration[:, None, 3:] + np.cross(motion.velocity[:, None, 3:], turning)
    )

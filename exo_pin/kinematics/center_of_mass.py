"""The centre of mass of wearer and device, with its velocity and acceleration."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics.frame_motion import rates
from exo_pin.kinematics.gait_motion import (
    GaitMotion,
    carried_acceleration,
    carried_velocity,
    gait_motion,
)
from exo_pin.kinematics.motion import moved, samples
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr


class CenterOfMass(NamedTuple):
    """Centre of mass in world axes.

    Attributes:
        position: (..., 3) [m].
        velocity: (..., 3) [m/s]; zero where no dq was given.
        acceleration: (..., 3) [m/s^2]; zero where neither dq nor ddq was given.
    """

    position: Array
    velocity: Array
    acceleration: Array

    def __repr__(self) -> str:
        return short_repr(self)


def center_of_mass(
    robot: Robot,
    q: Gait | npt.ArrayLike,
    dq: npt.ArrayLike | None = None,
    ddq: npt.ArrayLike | None = None,
    *,
    base: npt.ArrayLike | None = None,
) -> CenterOfMass:
    """The centre of mass of all links, wearer and device together.

    Args:
        robot: The robot.
        q: Configurations (..., nq) [rad], or a gait, whose own rates and moving pelvis are used.
        dq: Joint velocities (..., nv) [rad/s]; zero if left out.
        ddq: Joint accelerations (..., nv) [rad/s^2]; zero if left out.
        base: T_world_pelvis as in `exo_pin.kinematics.poses`.

    Raises:
        DescriptionError: A shape does not fit, a number is not finite, or no link has a mass.
    """
    if not has_mass(robot):
        raise DescriptionError(f"{robot.name} has no centre of mass: no link of its URDF has a mass")
    if isinstance(q, Gait):
        return _of_gait(robot, gait_motion(robot, q))
    rows, shape = samples(robot, q)
    still = np.zeros((*shape, robot.model.nv))
    speeds = rates(robot, still if dq is None else dq, shape, "dq")
    changes = rates(robot, still if ddq is None else ddq, shape, "ddq")
    data = robot.model.createData()
    out = np.empty((3, len(rows), 3))
    for k in range(len(rows)):
        pin.centerOfMass(robot.model, data, rows[k], speeds[k], changes[k])
        out[:, k] = data.com[0], data.vcom[0], data.acom[0]
    out = _with_root(robot, out).reshape(3, *shape, 3)
    if base is None:
        return CenterOfMass(*out)
    T = moved(robot, base, shape)
    turned = (T[..., :3, :3] @ out[..., None])[..., 0]
    turned[0] += T[..., :3, 3]
    return CenterOfMass(*turned)


def has_mass(robot: Robot) -> bool:
    """Whether any link has a mass; some URDFs state geometry alone."""
    return any(inertia.mass > 0.0 for inertia in robot.model.inertias)


def _of_gait(robot: Robot, walk: GaitMotion) -> CenterOfMass:
    """Along a gait: about the still pelvis, and what its motion adds."""
    still = center_of_mass(robot, walk.q, walk.dq, walk.ddq, base=walk.base)
    position, velocity, acceleration = (part[:, None] for part in still)
    moving = carried_velocity(walk, position, velocity)
    return CenterOfMass(
        still.position, moving[:, 0], carried_acceleration(walk, position, velocity, acceleration)[:, 0]
    )


def _with_root(robot: Robot, com: Array) -> Array:
    """Add the pelvis of a fixed robot, which Pinocchio leaves out because it never moves."""
    root = robot.model.inertias[0]
    if root.mass == 0.0:
        return com
    moving = sum(inertia.mass for inertia in robot.model.inertias[1:])
    com = com * moving / (moving + root.mass)
    com[0] += root.lever * root.mass / (moving + root.mass)
    return com

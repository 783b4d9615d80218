"""Forces that the engine computes in a step: sensors in its model for the floor and the joint stops."""

from __future__ import annotations

from typing import Any

import numpy as np

from exo_pin.anatomy import CORNERS, SIDES
from exo_pin.arrays import Array
from exo_pin.robot import Robot
from exo_pin.simulation.mujoco_model import FLOOR, Floor, compiled, mujoco_spec

_SENSED = 6
"""Numbers that a sole corner's sensor gives: force of the floor and where, world axes."""

SOLES = len(CORNERS) * _SENSED
"""Columns of the sole corners in `sensordata`; those of the joint stops follow, in the joints' order."""

_NETFORCE = 3
"""MuJoCo's reduction of a sensor's contacts to their sum, in world axes."""


def sensing_model(robot: Robot, *, floor: Floor | None = None, timestep: float = 0.001) -> Any:
    """The model of `mujoco_model` with a sensor at each sole corner and at each joint stop.

    The engine fills one array, `sensordata`, in the step itself; to read its lists of contacts and
    constraints from Python takes ten times longer.

    Args:
        robot: With the sole corners of `CORNERS`.
        floor: The ground.
        timestep: Of the simulation [s].

    Raises:
        DescriptionError: MuJoCo does not accept the robot.
        UnknownNameError: A sole corner is missing.
    """
    import mujoco

    spec = mujoco_spec(robot, floor=floor, timestep=timestep)
    force, place = mujoco.mjtConDataField.mjCONDATA_FORCE, mujoco.mjtConDataField.mjCONDATA_POS
    for name in CORNERS:
        sensor = spec.add_sensor(
            name=f"floor at {name}",
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_GEOM,
            objname=FLOOR,
            reftype=mujoco.mjtObj.mjOBJ_GEOM,
            refname=name,
        )
        sensor.intprm[:3] = [1 << int(force) | 1 << int(place), _NETFORCE, 1]
    for name in robot.joints:
        spec.add_sensor(
            name=f"stop of {name}",
            type=mujoco.mjtSensor.mjSENS_JOINTLIMITFRC,
            objtype=mujoco.mjtObj.mjOBJ_JOINT,
            objname=name,
        )
    return compiled(spec, robot)


def corner_forces(sensed: Array) -> tuple[Array, Array]:
    """Force of the floor at each sole corner, and where it acts, world axes, `(N, 2, 4, 3)` each [N, m].

    Args:
        sensed: `(N, S)` MuJoCo's `sensordata`.
    """
    corners = sensed[:, :SOLES].reshape(len(sensed), len(SIDES), -1, _SENSED)  # CORNERS: left, then right
    return corners[..., :3], corners[..., 3:]


def stop_torques(sensed: Array, angles: Array, robot: Robot) -> Array:
    """Torques of the joint stops (N, J) [N m], from what the sensors gave: a stop pushes back into the range.

    Args:
        sensed: `(N, S)` MuJoCo's `sensordata`.
        angles: `(N, J)` of the joints [rad].
        robot: Its joints' ranges.
    """
    pushes = sensed[:, SOLES:]
    return np.where(angles < (robot.lower + robot.upper) / 2, pushes, -pushes)

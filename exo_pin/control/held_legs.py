"""The legs as a controller's model has them: torques about a pelvis that is held upright."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.robot import Robot

ARMATURE = 0.05
"""Rotor inertia at each driven joint [kg m^2]: a motor of 1.2e-4 kg m^2 behind a gear of 20:1 has 0.048."""


class HeldLegs:
    """Inverse dynamics of the legs about a held pelvis, rotors included, one sample at a time, by Pinocchio.

    Args:
        robot: The model that the controller believes in.
    """

    def __init__(self, robot: Robot) -> None:
        self._model, self._data = with_rotors(robot), robot.model.createData()
        self._rest = np.array(robot.neutral)
        names = [name for name in robot.joints if name in JOINTS]
        self._ours = [JOINTS.index(name) for name in names]
        self._columns = [robot.column(name) for name in names]
        self._dofs = [column - robot.nq + robot.model.nv for column in self._columns]

    def torques(self, q: Array, dq: Array, ddq: Array) -> Array:
        """Torques (12,) [N m] of angles, velocities and accelerations (12,), in the order of `JOINTS`."""
        position, rates = self._rest.copy(), np.zeros((2, self._model.nv))
        position[self._columns] = q[self._ours]
        rates[0, self._dofs], rates[1, self._dofs] = dq[self._ours], ddq[self._ours]
        out = np.zeros(len(JOINTS))
        out[self._ours] = pin.rnea(self._model, self._data, position, *rates)[self._dofs]
        return out


def with_rotors(robot: Robot) -> Any:
    """Pinocchio's model with the rotors' inertia at the driven joints."""
    model = robot.model.copy()
    armature = np.zeros(model.nv)
    armature[model.nv - len(robot.joints) :] = np.where(robot.effort > 0.0, ARMATURE, 0.0)
    model.armature = armature
    return model

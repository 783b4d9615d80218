"""What the simulation loop writes down at every step, as arrays that are filled in place."""

from __future__ import annotations

from typing import Any

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Index

Columns = slice | Index
"""Some of the columns of an array."""


class Recording:
    """Arrays of N steps. State, torques and contacts are those before the step, from which it is made.

    Args:
        steps: N.
        model: MuJoCo's model.
        columns: Of `JOINTS`, those of MuJoCo's joints in their order.

    Attributes:
        columns: Of `JOINTS`, those of MuJoCo's joints in their order.
        qpos: `(N, nq)` MuJoCo's positions.
        qvel: `(N, nv)` MuJoCo's velocities.
        motor: `(N, 12)` torques of the motors [N m].
        wanted: `(N, 12)` torques that the controller wanted [N m].
        person: `(N, 12)` torques of the person [N m].
        friction: `(N, 12)` of the joints [N m].
        support: `(N, 6)` force and moment about mid-hip on the pelvis by support and pushes, world axes.
        constraint: `(N, nv)` generalised forces of floor and joint stops.
        energy: `(N, 2)` potential and kinetic [J].
        sensed: `(N, S)` what the sensors of `sensing_model` give: floor and joint stops.
    """

    def __init__(self, steps: int, model: Any, columns: Columns) -> None:
        joints = len(JOINTS)
        self.columns = columns
        self.qpos, self.qvel = np.zeros((steps, model.nq)), np.zeros((steps, model.nv))
        self.motor, self.wanted, self.person, self.friction = (np.zeros((steps, joints)) for _ in range(4))
        self.support, self.constraint = np.zeros((steps, 6)), np.zeros((steps, model.nv))
        self.energy, self.sensed = np.zeros((steps, 2)), np.zeros((steps, model.nsensordata))

    def cut(self, steps: int) -> None:
        """Keep the first steps: those of a run that ended early."""
        for name, values in vars(self).items():
            if name != "columns":
                setattr(self, name, values[:steps])

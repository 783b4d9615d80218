"""What the simulation loop writes down at every step, as arrays that are filled in place."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import CORNERS, JOINTS
from exo_pin.arrays import Array, Index

MOST_CONTACTS = len(CORNERS)
"""Every sole corner touches the floor once."""

Columns = slice | Index
"""Some of the columns of an array."""


class Recording:
    """Arrays of N steps. State, torques and contacts are those before the step, from which it is made.

    Attributes:
        columns: Of `JOINTS`, those of MuJoCo's joints in their order.
        qpos: `(N, nq)` MuJoCo's positions.
        qvel: `(N, nv)` MuJoCo's velocities.
        motor: `(N, 12)` torques of the motors [N m].
        wanted: `(N, 12)` torques that the controller wanted [N m].
        person: `(N, 12)` torques of the person [N m].
        friction: `(N, 12)` of the joints [N m].
        stops: `(N, 12)` of the joint stops [N m].
        support: `(N, 6)` force and moment about mid-hip on the pelvis by support and pushes, world axes.
        constraint: `(N, nv)` generalised forces of floor and joint stops.
        energy: `(N,)` kinetic and potential energy [J].
        contacts: `(N,)` number of contacts.
        corner: `(N, 8)` which sole corner touches, by contact.
        point: `(N, 8, 3)` where [m].
        frame: `(N, 8, 9)` contact frames: normal, two tangents.
        force: `(N, 8, 3)` force of the floor in that frame [N].
    """

    def __init__(self, steps: int, nq: int, nv: int, columns: Columns) -> None:
        joints = len(JOINTS)
        self.columns = columns
        self.qpos, self.qvel = np.zeros((steps, nq)), np.zeros((steps, nv))
        self.motor, self.wanted, self.person, self.friction, self.stops = (
            np.zeros((steps, joints)) for _ in range(5)
        )
        self.support, self.constraint = np.zeros((steps, 6)), np.zeros((steps, nv))
        self.energy = np.zeros(steps)
        self.contacts: Index = np.zeros(steps, dtype=int)
        self.corner: Index = np.zeros((steps, MOST_CONTACTS), dtype=int)
        self.point, self.force = (np.zeros((steps, MOST_CONTACTS, 3)) for _ in range(2))
        self.frame: Array = np.zeros((steps, MOST_CONTACTS, 9))

    def cut(self, steps: int) -> None:
        """Keep the first steps: those of a run that ended early."""
        for name, values in vars(self).items():
            if name != "columns":
                setattr(self, name, values[:steps])

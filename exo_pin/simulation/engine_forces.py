"""Forces that the engine computed in a step, written down: floor, joint stops, energy."""

from __future__ import annotations

from typing import Any

import numpy as np

from exo_pin.anatomy import CORNERS, JOINTS
from exo_pin.simulation.recording import MOST_CONTACTS, Recording

_ROWS = 3
"""Rows of a contact among the engine's constraints: normal and two tangents (elliptic cone)."""


class EngineForces:
    """Reads the forces of each step from MuJoCo's data.

    Args:
        model: MuJoCo's model, as `mujoco_model` makes it.
        record: Where they are written.
    """

    def __init__(self, model: Any, record: Recording) -> None:
        import mujoco

        self._model, self._record = model, record
        self._corner = np.zeros(model.ngeom, dtype=int)
        for k, name in enumerate(CORNERS):
            self._corner[model.geom(name).id] = k
        self._stop = int(mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT)
        names = [model.joint(k).name for k in range(model.njnt)]
        self._column = [JOINTS.index(name) if name in JOINTS else 0 for name in names]

    def note(self, k: int, data: Any) -> None:
        """Write down the forces which step k computed for the state before it."""
        record = self._record
        record.constraint[k] = data.qfrc_constraint
        energy = data.energy
        record.energy[k] = energy[0] + energy[1]
        n = min(data.ncon, MOST_CONTACTS)
        if n:
            contact = data.contact
            record.contacts[k] = n
            record.corner[k, :n] = self._corner[contact.geom2[:n]]
            record.point[k, :n], record.frame[k, :n] = contact.pos[:n], contact.frame[:n]
            last = data.nefc  # contacts stand behind all other constraints, in their order
            record.force[k, :n] = data.efc_force[last - _ROWS * n : last].reshape(n, _ROWS)
        if data.nl:
            self._note_stops(k, data)

    def _note_stops(self, k: int, data: Any) -> None:
        """Torques of the joint stops: a stop pushes back into the range."""
        model = self._model
        for row in np.flatnonzero(data.efc_type[: data.nefc] == self._stop):
            joint = int(data.efc_id[row])
            below = data.qpos[model.jnt_qposadr[joint]] < model.jnt_range[joint].mean()
            self._record.stops[k, self._column[joint]] += data.efc_force[row] * (1.0 if below else -1.0)

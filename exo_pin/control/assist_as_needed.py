"""Assistance as needed: a controller that stiffens where the leg errs and softens where it does not."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.control.controller import Reference
from exo_pin.control.servo import DAMPING, STIFFNESS
from exo_pin.gait import Gait
from exo_pin.robot import Robot

_BINS = 50
"""Parts of the gait cycle that learn on their own (a choice)."""

_START, _FORGETTING, _GAIN = 50.0, 0.8, 3e5
"""First stiffness [N m/rad], what is kept of it after a cycle, and stiffness by squared error [N m/rad^3]."""


class AssistAsNeeded:
    """Stiffness by joint and phase of the cycle: `K <- 0.8 K + g e^2` after each visit of a phase.

    The error of the moment stiffens the joint as well (`K + g e^2`), so that a leg which gives way is caught
    in the same step and not a cycle later; damping follows with the root of the stiffness. Both end at a
    stiff servo's.
    """

    def reset(self, robot: Robot, gait: Gait) -> None:
        """Forget what was learned."""
        self._most = np.resize(STIFFNESS, len(JOINTS))
        self._damping = np.resize(DAMPING, len(JOINTS)) / np.sqrt(self._most)
        self.stiffness = np.full((_BINS, len(JOINTS)), _START)
        self._bin, self._sum, self._visits = -1, np.zeros(len(JOINTS)), 0

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Torques (12,) [N m]."""
        error = reference.q - q
        square = error * error
        here = min(int(reference.phase * _BINS), _BINS - 1)
        if here != self._bin:
            self._learn()
            self._bin = here
        self._sum += square
        self._visits += 1
        K = np.minimum(self.stiffness[here] + _GAIN * square, self._most)
        torque: Array = K * error + self._damping * np.sqrt(K) * (reference.dq - dq)
        return torque

    def _learn(self) -> None:
        """Stiffness of the part of the cycle that is over, from its mean squared error."""
        if self._visits:
            row = self.stiffness[self._bin]
            np.minimum(_FORGETTING * row + _GAIN * self._sum / self._visits, self._most, out=row)
        self._sum, self._visits = np.zeros(len(JOINTS)), 0

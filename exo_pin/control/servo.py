"""Servo controllers: joints held to the walk by stiffness and damping, with or without feed-forward."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.control.controller import Reference
from exo_pin.control.held_legs import HeldLegs
from exo_pin.gait import Gait
from exo_pin.robot import Robot

STIFFNESS = (3000.0, 3000.0, 1500.0, 3000.0, 2000.0, 1500.0)
DAMPING = (80.0, 80.0, 40.0, 80.0, 50.0, 40.0)
"""Of a stiff position servo by movement [N m/rad, N m s/rad]: they carried all five speeds in simulation."""

SOFT_STIFFNESS, SOFT_DAMPING = 150.0, 10.0
"""Of an impedance controller, every joint [N m/rad, N m s/rad]."""


class Servo:
    """Stiffness and damping about the walk, plus the part of its torques that is fed forward.

    Args:
        stiffness: By movement (6,) or one for all [N m/rad].
        damping: Likewise [N m s/rad].
        feed_forward: Whether the torques that the person does not give are added.
    """

    def __init__(
        self,
        stiffness: Sequence[float] | float = STIFFNESS,
        damping: Sequence[float] | float = DAMPING,
        *,
        feed_forward: bool = True,
    ) -> None:
        self.stiffness, self.damping = (np.resize(gain, len(JOINTS)) for gain in (stiffness, damping))
        self.feed_forward = feed_forward

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Torques (12,) [N m]."""
        tau: Array = self.stiffness * (reference.q - q) + self.damping * (reference.dq - dq)
        return tau + reference.missing if self.feed_forward else tau


class GravityServo(Servo):
    """The servo plus the weight of the legs as they hang from a pelvis that is held: no ground, no motion."""

    def __init__(self) -> None:
        super().__init__(feed_forward=False)

    def reset(self, robot: Robot, gait: Gait) -> None:
        """Take the model of the legs from the robot."""
        self._legs = HeldLegs(robot)

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Torques (12,) [N m]."""
        still = np.zeros(len(JOINTS))
        return super().__call__(time, q, dq, reference) + self._legs.torques(q, still, still)


class ComputedTorque:
    """Torques that give the joints' errors a chosen linear motion (computed-torque control).

    The legs' inertia, Coriolis and gravity torques are those about a held pelvis; what the ground and the
    pelvis's motion add is taken from the walk's feed-forward, what the person gives is taken off.

    Args:
        frequency: Of the error's motion, critically damped [rad/s].
    """

    def __init__(self, frequency: float = 60.0) -> None:
        self.frequency = frequency

    def reset(self, robot: Robot, gait: Gait) -> None:
        """Take the model of the legs from the robot."""
        self._legs = HeldLegs(robot)

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Torques (12,) [N m]."""
        w = self.frequency
        wanted = reference.ddq + w * w * (reference.q - q) + 2 * w * (reference.dq - dq)
        legs = self._legs
        walk = legs.torques(reference.q, reference.dq, reference.ddq)
        return legs.torques(q, dq, wanted) - walk + reference.missing

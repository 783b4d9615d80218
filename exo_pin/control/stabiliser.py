"""Servos that stand without a support: ankles by a rule for the body, and a stabiliser of the balance."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import joint
from exo_pin.arrays import Array
from exo_pin.control.controller import Reference
from exo_pin.control.planned_balance import Foot, PlannedBalance, over_ground
from exo_pin.control.servo import DAMPING, STIFFNESS, Servo
from exo_pin.dynamics import mass_of
from exo_pin.gait import Gait
from exo_pin.kinematics import center_of_mass
from exo_pin.physics import GRAVITY
from exo_pin.robot import Robot
from exo_pin.robot.floating_base import base_coordinates
from exo_pin.robot.gait_columns import gait_columns

_FLEXIONS = [JOINTS.index(joint(side, "ankle_dorsiflexion")) for side in SIDES]
_INVERSIONS = [JOINTS.index(joint(side, "ankle_inversion")) for side in SIDES]
_ANKLES = [*_FLEXIONS, *_INVERSIONS]

ANKLE_STIFFNESS, ANKLE_DAMPING = 1.0, 2.0
"""Of the ankles, times the servo's: of those tried over bodies and steps the set under which all stand
(docs/walking.md)."""

_TIPPING = 823.0
"""Moment m g h of a body of 1.75 m in the device: what tips it, per radian about its ankles [N m/rad]."""


class FreeServo(Servo):
    """The servo with ankles for a free pelvis: gains in proportion to the moment that tips the body.

    Args:
        stiffness: Of the ankles, times that of `Servo`, for a body of 1.75 m.
        damping: Likewise.
    """

    def __init__(self, stiffness: float = ANKLE_STIFFNESS, damping: float = ANKLE_DAMPING) -> None:
        super().__init__()
        self._factors = stiffness, damping

    def reset(self, robot: Robot, gait: Gait) -> None:
        """Take mass and height from the model."""
        height = float(center_of_mass(robot, robot.neutral).position[2])
        body = mass_of(robot) * GRAVITY * height / _TIPPING
        for gains, usual, factor in zip(
            (self.stiffness, self.damping), (STIFFNESS, DAMPING), self._factors, strict=True
        ):
            gains[_ANKLES] = np.resize(usual, len(JOINTS))[_ANKLES] * factor * body


class Stabiliser(Servo):
    """The servo, its standing ankles soft and driven by the error of the divergent component of motion.

    The divergent component of the inverted pendulum, xi = x + x' / w, runs away from the centre of pressure p
    by xi' = w (xi - p) (Hof 2008, Human Movement Science 27:112). An error e is taken back by p moved by
    gain x e, with a gain above 1: the ankles' torque, as far as the sole reaches. The pelvis is sensed.
    Of a walk that does not carry its pelvis over ground (a cycle, a treadmill) it is the servo alone.

    Args:
        gain: Of the centre of pressure over the error.
        softness: Part of the servo's stiffness and damping that a standing ankle keeps.
    """

    def __init__(self, gain: float = 2.5, softness: float = 0.2) -> None:
        super().__init__()
        self.gain, self.softness = gain, softness
        self._plan: PlannedBalance | None = None

    def reset(self, robot: Robot, gait: Gait) -> None:
        """Take the balance of the walk from the model."""
        self._plan = PlannedBalance(robot, gait) if over_ground(robot, gait) else None
        if self._plan is None:
            return
        model = self._plan.robot
        self._model, self._data = model.model, model.model.createData()
        self._ours, self._columns = gait_columns(model.model, model.joints)
        self._dofs = [column - model.nq + model.model.nv for column in self._columns]
        self._position, self._rates = np.array(model.neutral), np.zeros(model.model.nv)

    def sense(self, pose: Array, velocity: Array) -> None:
        """Where the pelvis is, and how it moves."""
        if self._plan is None:
            return
        self._position[:7] = base_coordinates(pose)
        self._rates[:3], self._rates[3:6] = velocity[:3] @ pose[:3, :3], velocity[3:] @ pose[:3, :3]

    def __call__(self, time: float, q: Array, dq: Array, reference: Reference) -> Array:
        """Torques (12,) [N m]."""
        if self._plan is None:
            return super().__call__(time, q, dq, reference)
        x, y, *feet = self._plan.at(time)
        at = self._divergent(q, dq)
        wanted = (self.gain * (at[0] - x), self.gain * (at[1] - y))
        stiff, added = np.ones(len(JOINTS)), reference.missing.copy()
        for k, foot in enumerate(feet):
            flexion, inversion = _ankle(foot, wanted)
            added[_FLEXIONS[k]] += flexion
            added[_INVERSIONS[k]] += inversion if k == 0 else -inversion
            stiff[[_FLEXIONS[k], _INVERSIONS[k]]] = 1.0 - foot[0] * (1.0 - self.softness)
        held = self.stiffness * (reference.q - q) + self.damping * (reference.dq - dq)
        return np.asarray(stiff * held + added)

    def _divergent(self, q: Array, dq: Array) -> tuple[float, float]:
        """The divergent component of the measured motion [m]."""
        assert self._plan is not None
        self._position[self._columns], self._rates[self._dofs] = q[self._ours], dq[self._ours]
        pin.centerOfMass(self._model, self._data, self._position, self._rates)
        (x, y, _), (vx, vy, _) = self._data.com[0].tolist(), self._data.vcom[0].tolist()
        return x + vx / self._plan.rate, y + vy / self._plan.rate


def _ankle(foot: Foot, wanted: tuple[float, float]) -> tuple[float, float]:
    """Torques of dorsiflexion and of inversion of the left foot that move its centre of pressure [N m].

    Args:
        foot: The foot as planned.
        wanted: How far it is to move, x and y in the world [m]; as far as the sole reaches.
    """
    _, force, ax, ay, back, front, right, left = foot
    ahead = min(max(wanted[0] * ax + wanted[1] * ay, back), front)
    aside = min(max(wanted[1] * ax - wanted[0] * ay, right), left)
    return -force * ahead, force * aside

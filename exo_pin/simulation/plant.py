"""The simulated machine: motors with their limits, joint friction, encoders, delay; errors of the model."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields

import numpy as np

from exo_pin import arguments
from exo_pin.arrays import Array


@dataclass(frozen=True)
class Plant:
    """What the machine is like beyond its model. The controller knows the model alone.

    Attributes:
        limits: Whether the motors' torques end at the joints' effort, and driving torque at their speed.
        mass_error: The machine is heavier than the model by this part.
        length_error: It is longer by this part.
        floor_friction: Coulomb coefficient of the floor.
        floor_time_constant: Of the floor's spring and damper (MuJoCo's solref) [s].
        joint_friction: Coulomb friction of each joint [N m].
        joint_damping: Viscous friction of each joint [N m s/rad].
        encoder_step: Resolution of the measured angles [rad]; 0: exact.
        noise: Standard deviation of the measured angles [rad].
        rate: Of the controller [Hz]; None: at every step.
        delay: From measurement to torque [s].

    Raises:
        DescriptionError: A number is not within its range.
    """

    limits: bool = True
    mass_error: float = field(default=0.0, metadata={"range": (-0.5, 1.0)})
    length_error: float = field(default=0.0, metadata={"range": (-0.2, 0.2)})
    floor_friction: float = field(default=0.8, metadata={"range": (0.0, 2.0)})
    floor_time_constant: float = field(default=0.01, metadata={"range": (0.002, 0.1)})
    joint_friction: float = field(default=0.0, metadata={"range": (0.0, 100.0)})
    joint_damping: float = field(default=0.0, metadata={"range": (0.0, 100.0)})
    encoder_step: float = field(default=0.0, metadata={"range": (0.0, 0.1)})
    noise: float = field(default=0.0, metadata={"range": (0.0, 0.1)})
    rate: float | None = field(default=None, metadata={"range": (10.0, 1e5)})
    delay: float = field(default=0.0, metadata={"range": (0.0, 0.5)})

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if "range" not in entry.metadata or (entry.name == "rate" and value is None):
                continue
            lower, upper = entry.metadata["range"]
            arguments.number(entry.name, value, least=lower, most=upper)


_SLIPPING = 0.05
"""Joint speed over which Coulomb friction builds up [rad/s]: without it the sign would chatter."""


class Joints:
    """Torques of motors and friction, for one run.

    Args:
        plant: The machine.
        effort: `(12,)` largest torques [N m], 0 for joints without a motor.
        speed: `(12,)` largest speeds [rad/s].
        seed: Of the encoders' noise.
    """

    def __init__(self, plant: Plant, effort: Array, speed: Array, seed: int) -> None:
        self._plant, self._effort, self._speed = plant, effort, speed
        self._driven = effort > 0.0
        self._slowest = float(speed[self._driven].min(initial=math.inf))
        self._random = np.random.default_rng(seed)
        self._rough = plant.joint_friction > 0.0 or plant.joint_damping > 0.0
        self._exact = plant.encoder_step == 0.0 and plant.noise == 0.0

    def motor(self, wanted: Array, dq: Array, fastest: float) -> Array:
        """Torques (12,) that the motors give [N m].

        Args:
            wanted: Torques (12,) of the controller [N m].
            dq: Joint velocities (12,) [rad/s].
            fastest: The largest of them, absolute; where no limit is below it none is looked at.
        """
        if not self._plant.limits:
            return wanted * self._driven
        tau: Array = np.minimum(np.maximum(wanted, -self._effort), self._effort)
        if fastest > self._slowest:  # beyond its speed a motor brakes but does not drive
            tau[(np.abs(dq) > self._speed) & (tau * dq > 0.0)] = 0.0
        return tau

    def friction(self, dq: Array) -> Array | None:
        """Torques (12,) of the joints' friction [N m]; None if they have no friction."""
        if not self._rough:
            return None
        dry: Array = np.tanh(dq / _SLIPPING)
        return -self._plant.joint_friction * dry - self._plant.joint_damping * dq

    def measured(self, q: Array) -> Array:
        """Angles (12,) as the encoders give them [rad], a copy."""
        if self._exact:
            return q.copy()
        q = q + self._plant.noise * self._random.standard_normal(len(q))
        step = self._plant.encoder_step
        return np.asarray(np.round(q / step) * step) if step else q

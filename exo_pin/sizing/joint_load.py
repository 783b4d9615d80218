"""Load of one joint over a walk: torque, speed, power, energy per stride, and a parallel spring."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exo_pin.arguments import number, real, text
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class JointLoad:
    """What one joint bears on a walk, n samples.

    Attributes:
        joint: Its name.
        angle: `(n,)` [rad].
        speed: `(n,)` [rad/s].
        acceleration: `(n,)` [rad/s^2].
        torque: `(n,)` positive the way the joint is named [N m].
        share: `(n,)` part of the walk's time that each sample stands for; they sum to 1.
        stride: Stride time [s]; NaN where none is known: then there is no energy per stride.

    Raises:
        DescriptionError: The shapes differ, a number is not finite, or the stride time is not positive.
    """

    joint: str
    angle: Array
    speed: Array
    acceleration: Array
    torque: Array
    share: Array
    stride: float = math.nan

    __repr__ = short_repr

    def __post_init__(self) -> None:
        text("joint", self.joint)
        n = len(real("torque", self.torque, ("n",)))
        for name in ("angle", "speed", "acceleration", "share"):
            real(name, getattr(self, name), (n,))
        if not (isinstance(self.stride, float) and math.isnan(self.stride)):
            number("stride", self.stride, above=0.0)
        if not n or not math.isclose(float(self.share.sum()), 1.0, abs_tol=1e-6):
            raise DescriptionError(f"share of {n} samples sums to {self.share.sum():g}; 1 is accepted")

    @property
    def power(self) -> Array:
        """`(n,)` mechanical power, positive where the joint gives energy [W]."""
        return self.torque * self.speed

    @property
    def peak_torque(self) -> float:
        """Largest size of the torque [N m]."""
        return float(np.abs(self.torque).max())

    @property
    def rms_torque(self) -> float:
        """Root mean square of the torque over time [N m]."""
        return self.rms(self.torque)

    @property
    def peak_speed(self) -> float:
        """Largest size of the speed [rad/s]."""
        return float(np.abs(self.speed).max())

    @property
    def peak_power(self) -> float:
        """Largest size of the power [W]."""
        return float(np.abs(self.power).max())

    def energy(self, *, efficiency: float = 1.0, recovery: bool = False) -> float:
        """Energy that the joint takes from its supply in a stride [J].

        Args:
            efficiency: Of motor and gear, both ways: driving takes P / efficiency, braking returns
                P * efficiency.
            recovery: Whether what braking returns is used again; else it becomes heat.
        """
        number("efficiency", efficiency, above=0.0, most=1.0)
        driving, braking = (self.mean(np.maximum(sign * self.power, 0.0)) for sign in (1.0, -1.0))
        taken = driving / efficiency - (braking * efficiency if recovery else 0.0)
        return taken * self.stride

    def mean(self, values: Array) -> float:
        """Mean over time of values `(n,)`.

        Raises:
            DescriptionError: There are not n finite numbers.
        """
        return float(self.share @ real("values", values, self.share.shape))

    def rms(self, values: Array) -> float:
        """Root mean square over time of values `(n,)`.

        Raises:
            DescriptionError: There are not n finite numbers.
        """
        return math.sqrt(self.mean(real("values", values) ** 2))

    def spring(self) -> Spring | None:
        """The spring beside the motor that leaves it the smallest rms torque; None where no spring helps.

        Least squares of torque + stiffness (angle - rest) over time. A negative stiffness is no spring.
        """
        angle = self.angle - self.mean(self.angle)
        spread = self.mean(angle**2)
        stiffness = -self.mean(angle * self.torque) / spread if spread > _LEAST_SPREAD else 0.0
        if stiffness <= 0.0:
            return None
        return Spring(stiffness, self.mean(self.angle) + self.mean(self.torque) / stiffness)

    def beside(self, spring: Spring) -> JointLoad:
        """What is left for the motor beside a parallel spring."""
        return replace(self, torque=self.torque - spring.torque(self.angle))

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON, units as the keys say; None for an energy that is not known."""
        return {
            "peak_Nm": self.peak_torque,
            "rms_Nm": self.rms_torque,
            "peak_speed_rad_s": self.peak_speed,
            "peak_W": self.peak_power,
            "energy_J_per_stride": known(self.energy()),
            "energy_with_recovery_J_per_stride": known(self.energy(recovery=True)),
        }


@dataclass(frozen=True)
class Spring:
    """A linear spring that acts on a joint, beside its motor.

    Attributes:
        stiffness: [N m/rad].
        rest: Angle without torque [rad].

    Raises:
        DescriptionError: The stiffness is negative, or a number is not finite.
    """

    stiffness: float
    rest: float

    def __post_init__(self) -> None:
        number("stiffness", self.stiffness, least=0.0)
        number("rest", self.rest)

    def torque(self, angle: Array) -> Array:
        """Its torque on the joint at angles of any shape [rad], towards its rest [N m].

        Raises:
            DescriptionError: An angle is not finite.
        """
        return -self.stiffness * (real("angle", angle) - self.rest)


_LEAST_SPREAD = 1e-8
"""Mean square of the angle [rad^2] below which the joint stands still and no stiffness can be found."""


def known(value: float) -> float | None:
    """A number for JSON, None for NaN."""
    return None if math.isnan(value) else value

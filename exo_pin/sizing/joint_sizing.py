"""Sizing of one joint: its load against the limits of the device's record, or of a motor and its gear."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from exo_pin.short_repr import short_repr
from exo_pin.sizing.gear import GearedUse, Ratios
from exo_pin.sizing.joint_load import JointLoad, Spring, known
from exo_pin.sizing.motor import Motor


@dataclass(frozen=True, eq=False, kw_only=True)
class JointSizing:
    """One joint's load against what its drive can do.

    Attributes:
        load: What the joint bears.
        effort: Largest torque of the device's record [N m].
        velocity: Largest speed of the device's record [rad/s].
        motor: The motor that stands for the record's limits, or None.
        given: The motor with the ratio that was given, or None.
        ratios: The ratios with which it fits, or None without a motor.
        spring: A spring beside the motor that saves most, or None.
    """

    load: JointLoad
    effort: float
    velocity: float
    motor: Motor | None = None
    given: GearedUse | None = None
    ratios: Ratios | None = None
    spring: Spring | None = None

    __repr__ = short_repr

    @property
    def use(self) -> GearedUse | None:
        """The motor with the given ratio, else the best or nearest one; None without a motor."""
        return self.given or (None if self.ratios is None else self.ratios.best)

    @property
    def torque_use(self) -> float:
        """Peak torque as a part of the record's."""
        return self.load.peak_torque / self.effort if self.effort else math.inf

    @property
    def speed_use(self) -> float:
        """Peak speed as a part of the record's."""
        return self.load.peak_speed / self.velocity if self.velocity else math.inf

    @property
    def fits(self) -> bool:
        """With a motor: whether it fits, with the given ratio or with any; else the record's rectangle."""
        if self.given is not None:
            return self.given.fits
        if self.ratios is not None:
            return bool(self.ratios.ranges)
        return max(self.torque_use, self.speed_use) <= 1.0

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON, units as the keys say."""
        facts = self.load.facts() | {
            "fits": self.fits,
            "rectangle": {
                "effort_Nm": self.effort,
                "velocity_rad_s": self.velocity,
                "torque_use": self.torque_use,
                "speed_use": self.speed_use,
            },
            "spring": self._spring_facts(),
        }
        if self.motor is not None and self.ratios is not None:
            facts["motor"] = self._motor_facts(self.motor, self.ratios)
        return facts

    def _motor_facts(self, motor: Motor, ratios: Ratios) -> dict[str, Any]:
        facts = ratios.facts()
        for key, recovery in (("energy", False), ("energy_with_recovery", True)):
            spent = self.load.energy(efficiency=motor.efficiency, recovery=recovery)
            facts[f"electrical_{key}_J_per_stride"] = known(spent)
        return facts if self.given is None else facts | {"given": self.given.facts()}

    def _spring_facts(self) -> dict[str, Any] | None:
        if self.spring is None:
            return None
        left = self.load.beside(self.spring)
        return {
            "stiffness_Nm_per_rad": self.spring.stiffness,
            "rest_rad": self.spring.rest,
            "rms_Nm": left.rms_torque,
            "peak_Nm": left.peak_torque,
            "rms_saved": 1.0 - left.rms_torque / self.load.rms_torque,
            "energy_J_per_stride": known(left.energy()),
        }

"""Motors: speed-torque line, continuous torque, rotor inertia, efficiency."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.arguments import number, real, text
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError


@dataclass(frozen=True)
class Motor:
    """A motor without its gear.

    Attributes:
        name: What it is called.
        source: Where its numbers come from.
        no_load_speed: Speed without torque [rad/s].
        peak_torque: Torque at standstill, where the speed-torque line begins [N m].
        continuous_torque: Torque that it bears without end; limit of the rms torque [N m].
        rotor_inertia: Of the rotor about its shaft [kg m^2].
        efficiency: Mechanical of electrical energy while it drives, 0 to 1; taken as constant.

    Raises:
        DescriptionError: A number is not positive, or the source is empty.
    """

    name: str
    source: str
    no_load_speed: float
    peak_torque: float
    continuous_torque: float
    rotor_inertia: float
    efficiency: float

    def __post_init__(self) -> None:
        for name in ("no_load_speed", "peak_torque", "continuous_torque"):
            number(name, getattr(self, name), above=0.0)
        number("rotor_inertia", self.rotor_inertia, least=0.0)
        number("efficiency", self.efficiency, above=0.0, most=1.0)
        if self.continuous_torque > self.peak_torque:
            raise DescriptionError(
                f"continuous torque {self.continuous_torque:g} N m exceeds the peak torque "
                f"{self.peak_torque:g} N m; at most the peak torque is accepted"
            )
        text("name", self.name)
        if not text("source", self.source).strip():
            raise DescriptionError(
                "source is empty; a text that says where the numbers come from is accepted"
            )

    def line_use(self, torque: Array, speed: Array) -> Array:
        """How far points lie towards the edge of what the motor can do; 1: on it.

        While it drives, the edge is the straight line from peak torque to no-load speed. While it brakes,
        it is the peak torque up to the no-load speed: a choice on the safe side, it could do more.

        Args:
            torque: At the motor's shaft, any shape [N m].
            speed: Of the motor's shaft, likewise [rad/s].

        Raises:
            DescriptionError: The shapes differ, or a number is not finite.
        """
        torque = real("torque", torque)
        speed = real("speed", speed, torque.shape)
        of_torque, of_speed = np.abs(torque) / self.peak_torque, np.abs(speed) / self.no_load_speed
        driving = torque * speed > 0.0
        return np.asarray(np.where(driving, of_torque + of_speed, np.maximum(of_torque, of_speed)))

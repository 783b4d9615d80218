"""Fit of a device to person and walk: statures, masses and sizes that it takes, speeds of its treadmill."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from exo_pin.anatomy import SIDES, Body
from exo_pin.devices import Device
from exo_pin.files import json_number
from exo_pin.gait import Gait
from exo_pin.kinematics import walking_speed
from exo_pin.robot import Robot, load_robot
from exo_pin.robot.model import LIMIT_TOLERANCE

UNEVEN = 0.005
"""Difference of the legs from hip to sole that is remarked on [m] (a choice)."""


@dataclass(frozen=True)
class Fit:
    """A property of walk or person against the interval that the device accepts.

    Attributes:
        what: `"treadmill"` (walking speed [m/s]) or `"person"` (a size [m] or the mass [kg]).
        required: The speed or stature; NaN where the walk shows no speed.
        available: Smallest and largest accepted value.
        unit: Of all three.
        of: Which size of the person, e.g. `"stature"`; empty for the treadmill.
    """

    what: Literal["treadmill", "person"]
    required: float
    available: tuple[float, float]
    unit: str
    of: str = ""

    @property
    def ok(self) -> bool:
        """Whether it lies within the interval; an unknown value does not count against it."""
        low, high = self.available
        return not (self.required < low - LIMIT_TOLERANCE or self.required > high + LIMIT_TOLERANCE)

    @property
    def how(self) -> str:
        """Both in words."""
        low, high = self.available
        digits = 3 if self.unit == "m" and self.of != "stature" else 2  # parts of the body to the millimetre
        possible = f"{low:.{digits}f} to {high:.{digits}f}" if low > 0 else f"at most {high:.{digits}f}"
        name = f"{self.of} " if self.of else ""
        known = np.isfinite(self.required)
        required = f"{self.required:.{digits}f} {self.unit} required" if known else "not known"
        return f"{name}{required}, {possible} {self.unit} possible"

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        low, high = self.available
        required = json_number(self.required)
        return {
            "what": self.what,
            "of": self.of or None,
            "asked": required,
            "low": low,
            "high": high,
            "unit": self.unit,
            "ok": self.ok,
        }


def fits(robot: Robot, gait: Gait) -> tuple[Fit, ...]:
    """What the device's record says about treadmill and person, against this walk and body."""
    device, body, found = robot.device, robot.body, []
    if device is not None and device.treadmill is not None:
        found.append(Fit("treadmill", walking_speed(load_robot(body), gait), device.treadmill, "m/s"))
    if device is not None and body is not None:
        found += _person(device, body)
    return tuple(found)


def _person(device: Device, body: Body) -> list[Fit]:
    """Every size of the person for which the device's record has a range; equal legs once."""
    sizes = [
        ("stature", body.stature, device.statures, "m"),
        ("mass", body.mass, device.masses, "kg"),
        ("hip breadth", body.hip_breadth, device.hip_breadths, "m"),
    ]
    for name, available in (("thigh", device.thighs), ("shank", device.shanks)):
        legs = {f"{side} {name}": getattr(body.leg(side), name) for side in SIDES}
        legs = legs if len(set(legs.values())) > 1 else {name: next(iter(legs.values()))}
        sizes += [(what, value, available, "m") for what, value in legs.items()]
    return [Fit("person", value, span, unit, what) for what, value, span, unit in sizes if span is not None]


def leg_difference(body: Body | None) -> str | None:
    """A remark where the legs differ in length by more than `UNEVEN`."""
    if body is None:
        return None
    left, right = (leg.length for leg in body.legs)
    if abs(left - right) < UNEVEN:
        return None
    return (
        f"the wearer's legs differ by {1e3 * abs(left - right):.0f} mm from hip to sole (left {left:.3f} m, "
        f"right {right:.3f} m): thigh and shank of the device are set on each side apart"
    )


def within_belt_speed(fit: Fit, robot: Robot) -> Callable[[Gait], bool]:
    """A condition on other amplitudes of the walk: the treadmill is fast enough for them."""
    full, (_, fastest) = load_robot(robot.body), fit.available
    if not np.isfinite(fit.required):
        return lambda gait: True
    return lambda gait: not walking_speed(full, gait) > fastest + LIMIT_TOLERANCE

"""Fit of a device to person and walk: its range of statures, and the speeds of its treadmill."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from exo_pin.errors import GaitError
from exo_pin.files import json_number
from exo_pin.gait import Gait
from exo_pin.kinematics import spatiotemporal
from exo_pin.robot import Robot, load_robot
from exo_pin.robot.model import LIMIT_TOLERANCE


@dataclass(frozen=True)
class Fit:
    """A property of walk or person against the interval that the device accepts.

    Attributes:
        what: `"treadmill"` (walking speed [m/s]) or `"person"` (stature [m]).
        required: The speed or stature; NaN where the walk has no cycles and so no speed.
        available: Smallest and largest accepted value.
        unit: Of all three.
    """

    what: Literal["treadmill", "person"]
    required: float
    available: tuple[float, float]
    unit: str

    @property
    def ok(self) -> bool:
        """Whether it lies within the interval; an unknown value does not count against it."""
        low, high = self.available
        return not (self.required < low - LIMIT_TOLERANCE or self.required > high + LIMIT_TOLERANCE)

    @property
    def how(self) -> str:
        """Both in words."""
        low, high = self.available
        return f"{self.required:.2f} {self.unit} required, {low:.2f} to {high:.2f} {self.unit} possible"

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        low, high = self.available
        required = json_number(self.required)
        return {
            "what": self.what,
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
        found.append(Fit("treadmill", _speed(load_robot(body), gait), device.treadmill, "m/s"))
    if device is not None and device.statures is not None and body is not None:
        found.append(Fit("person", body.stature, device.statures, "m"))
    return tuple(found)


def within_belt_speed(fit: Fit, robot: Robot) -> Callable[[Gait], bool]:
    """A condition on other amplitudes of the walk: the treadmill is fast enough for them."""
    full, (_, fastest) = load_robot(robot.body), fit.available
    return lambda gait: not np.isfinite(fit.required) or not _speed(full, gait) > fastest + LIMIT_TOLERANCE


def _speed(robot: Robot, gait: Gait) -> float:
    """Walking speed on the full exoskeleton [m/s]; NaN where the walk has no cycles."""
    try:
        return float(spatiotemporal(robot, gait)["speed"].mean)
    except GaitError:
        return float("nan")

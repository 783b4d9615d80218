"""Whether a device fits the person and its belt the walk's speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.kinematics import spatiotemporal
from exo_pin.robot import Robot, load_robot

_ROUNDING = 1e-9


@dataclass(frozen=True)
class Fit:
    """What is asked, and between what it may lie.

    Attributes:
        what: `"treadmill"` or `"person"`.
        asked: Walking speed [m/s] or stature [m]; NaN where the walk does not tell.
        low: Least.
        high: Most.
        unit: Of all three.
    """

    what: str
    asked: float
    low: float
    high: float
    unit: str

    @property
    def ok(self) -> bool:
        """Within; what is not known does not count."""
        return not (self.asked < self.low - _ROUNDING or self.asked > self.high + _ROUNDING)

    @property
    def how(self) -> str:
        """What does not fit, in words."""
        return f"{self.asked:.2f} {self.unit} asked, {self.low:.2f} to {self.high:.2f} {self.unit} possible"


def fits(robot: Robot, gait: Gait) -> tuple[Fit, ...]:
    """What the device's record says about belt and person, against this walk and body."""
    device, body, found = robot.device, robot.body, []
    if device is not None and device.treadmill is not None:
        found.append(Fit("treadmill", speed(load_robot(body), gait), *device.treadmill, "m/s"))
    if device is not None and device.statures is not None and body is not None:
        found.append(Fit("person", body.stature, *device.statures, "m"))
    return tuple(found)


def speed(robot: Robot, gait: Gait) -> float:
    """Walking speed on the full exoskeleton [m/s]; NaN where the walk has no cycles."""
    try:
        return float(spatiotemporal(robot, gait)["speed"].mean)
    except GaitError:
        return float("nan")


def keeps_up(fit: Fit, robot: Robot) -> Callable[[Gait], bool]:
    """Whether the belt is quick enough for another amplitude of the walk."""
    full = load_robot(robot.body)
    return lambda gait: not np.isfinite(fit.asked) or not speed(full, gait) > fit.high + _ROUNDING

"""Loss of one device: errors of the feet, step width, clearance, joint angles, centre of mass."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.anatomy.names import Movement
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.compare.best_motion import DeviceMotion
from exo_pin.compare.recorded_walk import Walk
from exo_pin.demand import RangeDemand, range_demands
from exo_pin.devices import Device
from exo_pin.files import json_number
from exo_pin.gait.heading import mean_heading
from exo_pin.gait.phases import masks
from exo_pin.gait.rigid_poses import angle_of
from exo_pin.short_repr import short_repr

_COMPARED: tuple[Movement, ...] = ("hip_flexion", "knee_flexion")  # movements whose change is reported


class Spread(NamedTuple):
    """Root mean square and largest value of an error, in its own unit."""

    rms: float
    max: float


@dataclass(frozen=True, eq=False)
class Loss:
    """The motion of a device against the recorded walk.

    Attributes:
        device: The device.
        walk: The recorded walk.
        motion: The device's motion.
    """

    device: Device
    walk: Walk
    motion: DeviceMotion

    __repr__ = short_repr

    @cached_property
    def sole_error(self) -> Array:
        """Root mean square distance of a foot's four sole corners from the recorded ones (n, 2) [m]."""
        squares = ((self.motion.corners - self.walk.corners) ** 2).sum(axis=-1)
        return np.asarray(np.sqrt(squares.mean(axis=-1)))

    @cached_property
    def position_error(self) -> Array:
        """Distance of the foot frames from the recorded ones (n, 2) [m]."""
        gap = self.motion.feet[..., :3, 3] - self.walk.feet[..., :3, 3]
        return np.asarray(np.linalg.norm(gap, axis=-1))

    @cached_property
    def rotation_error(self) -> Array:
        """Angle between the feet and the recorded ones (n, 2) [rad]."""
        R = self.motion.feet[..., :3, :3].swapaxes(-1, -2) @ self.walk.feet[..., :3, :3]
        return angle_of(R)

    @property
    def rms(self) -> float:
        """Root mean square of `sole_error` over both feet and the walk [m]: devices are ranked by it."""
        return _root_mean_square(self.sole_error)

    @property
    def sole_spread(self) -> Spread:
        """Of `sole_error` [m]."""
        return _spread(self.sole_error)

    @property
    def position_spread(self) -> Spread:
        """Of `position_error` [m]."""
        return _spread(self.position_error)

    @property
    def rotation_spread(self) -> Spread:
        """Of `rotation_error` [rad]."""
        return _spread(self.rotation_error)

    def in_phases(self, errors: Array) -> dict[str, float]:
        """Root mean square of errors (n, 2) in each phase of the foot's own cycle; NaN without events.

        Raises:
            DescriptionError: The shape does not fit the walk, or an error is not finite.
        """
        errors = real("errors", errors, (len(self.walk.gait), 2))
        parts = [masks(self.walk.gait, side) for side in SIDES]
        return {
            name: _root_mean_square(np.concatenate([errors[parts[k][name], k] for k in range(2)]))
            for name in parts[0]
        }

    @cached_property
    def by_phase(self) -> dict[str, float]:
        """Root mean square of `sole_error` in each phase of the foot's own cycle [m]; NaN without events."""
        return self.in_phases(self.sole_error)

    @property
    def step_width(self) -> float:
        """Mean distance of the feet across the heading at heel strikes [m]; NaN without events."""
        return step_width(self.walk, self.motion.feet)

    @property
    def step_width_lost(self) -> float:
        """Recorded minus the device's step width [m]; NaN without events."""
        return step_width(self.walk, self.walk.feet) - self.step_width

    @property
    def clearance(self) -> float:
        """Smallest height of the swinging sole over the standing one in mid swing [m]; NaN without events."""
        return clearance(self.walk, self.motion.corners)

    @property
    def clearance_lost(self) -> float:
        """Recorded minus the device's clearance [m]; NaN without events."""
        return clearance(self.walk, self.walk.corners) - self.clearance

    @cached_property
    def angle_change(self) -> dict[Movement, float]:
        """Largest difference of hip and knee flexion from the required angles, over both sides [rad]."""
        change = np.abs(self.motion.gait.q - self.motion.required).max(axis=0)
        return {m: float(max(change[JOINTS.index(f"{side}_{m}")] for side in SIDES)) for m in _COMPARED}

    @cached_property
    def ranges(self) -> dict[str, RangeDemand]:
        """By joint of the device, its positions against its range [rad, m]."""
        return range_demands(self.motion.robot, self.motion.q)

    @cached_property
    def com_shift(self) -> Array:
        """The centre of mass minus the recorded one (n, 3) [m]: forward, left, up in the mean heading."""
        return np.asarray((self.motion.com - self.walk.com) @ axes(self.walk).T)

    @property
    def com_error(self) -> float:
        """Root mean square distance of the centre of mass from the recorded walk's [m]."""
        return _root_mean_square(np.linalg.norm(self.com_shift, axis=1))

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON: units as the keys say, None where events are missing."""
        ranges = {
            joint: {
                "min": demand.lowest,
                "max": demand.highest,
                "samples_at_limit": demand.samples_at_limit,
            }
            for joint, demand in self.ranges.items()
        }
        degree = float(np.degrees(1.0))
        return {
            "device": self.device.name,
            "motors": self.device.motors,
            "sole_error_mm": _scaled(self.sole_spread, 1e3),
            "position_error_mm": _scaled(self.position_spread, 1e3),
            "rotation_error_deg": _scaled(self.rotation_spread, degree),
            "sole_error_by_phase_mm": self._phases(self.sole_error, 1e3),
            "position_error_by_phase_mm": self._phases(self.position_error, 1e3),
            "rotation_error_by_phase_deg": self._phases(self.rotation_error, degree),
            "step_width_mm": json_number(1e3 * self.step_width),
            "step_width_lost_mm": json_number(1e3 * self.step_width_lost),
            "clearance_mm": json_number(1e3 * self.clearance),
            "clearance_lost_mm": json_number(1e3 * self.clearance_lost),
            "angle_change_deg": {m: float(np.degrees(x)) for m, x in self.angle_change.items()},
            "com_error_mm": 1e3 * self.com_error,
            "com_error_along_mm": {
                way: 1e3 * _root_mean_square(self.com_shift[:, i])
                for i, way in enumerate(("forward", "left", "up"))
            },
            "joint_ranges_rad": ranges,
        }

    def _phases(self, errors: Array, scale: float) -> dict[str, float | None]:
        return {name: json_number(scale * x) for name, x in self.in_phases(errors).items()}


def _root_mean_square(values: Array) -> float:
    """Root of the mean of squares; NaN of nothing."""
    return float(np.sqrt(np.mean(values**2))) if values.size else float("nan")


def axes(recorded: Walk) -> Array:
    """Forward, left and up (3, 3) in the world, by the mean heading."""
    c, s = mean_heading(recorded.base)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def step_width(recorded: Walk, feet: Array) -> float:
    """Mean distance of feet (n, 2, 4, 4) across the mean heading at the recorded heel strikes [m]."""
    strikes = [e.time for e in recorded.gait.events if e.kind == "heel_strike"]
    if not strikes:
        return float("nan")
    across = axes(recorded)[1, :2]
    rows = [int(np.argmin(np.abs(recorded.gait.time - t))) for t in strikes]
    return float(np.mean((feet[rows, 0, :2, 3] - feet[rows, 1, :2, 3]) @ across))


def clearance(recorded: Walk, corners: Array) -> float:
    """Smallest height of a swinging sole over the other one in mid swing, by corners (n, 2, 4, 3) [m]."""
    lowest = corners[..., 2].min(axis=-1)  # (n, 2)
    gaps = []
    for k, side in enumerate(SIDES):
        swing = masks(recorded.gait, side)["mid swing"]
        gaps += list(lowest[swing, k] - lowest[swing, 1 - k])
    return float(min(gaps)) if gaps else float("nan")


def _spread(values: Array) -> Spread:
    return Spread(_root_mean_square(values), float(values.max()))


def _scaled(spread: Spread, scale: float) -> dict[str, float]:
    return {"rms": scale * spread.rms, "max": scale * spread.max}

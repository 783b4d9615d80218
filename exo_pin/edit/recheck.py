"""Joint limits checked anew after an adjustment: ranges, velocities, accelerations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin.demand import JointDemand, joint_demands
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Recheck:
    """The demand of an adjusted walk on the joints, and the joints that exceed what is available.

    Attributes:
        demands: The demand on each joint.
    """

    demands: tuple[JointDemand, ...]

    __repr__ = short_repr

    @property
    def angle(self) -> dict[str, float]:
        """Joint -> its angle furthest beyond a limit [rad]; only joints that leave their range."""
        return {d.joint: d.position.worst for d in self.demands if d.position.outside.any()}

    @property
    def velocity(self) -> dict[str, float]:
        """Joint -> its largest speed [rad/s]; only joints that exceed their velocity limit."""
        return {d.joint: d.speed.peak for d in self.demands if d.speed.exceeded.any()}

    @property
    def acceleration(self) -> dict[str, float]:
        """Joint -> its largest acceleration [rad/s^2]; only joints that exceed `ACCELERATION_LIMIT`."""
        return {d.joint: d.acceleration.peak for d in self.demands if d.acceleration.exceeded.any()}

    @property
    def closest(self) -> JointDemand:
        """The joint with the smallest margin to a limit of its range."""
        return min(self.demands, key=lambda demand: demand.position.margin)

    @property
    def fastest(self) -> JointDemand:
        """The joint that uses the largest share of its velocity limit."""
        return max(self.demands, key=lambda demand: demand.speed.use)

    @property
    def hardest(self) -> JointDemand:
        """The joint with the largest acceleration."""
        return max(self.demands, key=lambda demand: demand.acceleration.peak)

    @property
    def ok(self) -> bool:
        """Whether every joint keeps its limits."""
        return all(demand.ok for demand in self.demands)

    def lines(self) -> list[str]:
        """One sentence for each joint and limit that it exceeds, in degrees."""
        kinds = (
            ("angle", self.angle, "deg", "its limits"),
            ("velocity", self.velocity, "deg/s", "its motor's speed"),
            ("acceleration", self.acceleration, "deg/s^2", "any usual walk"),
        )
        return [
            f"{joint}: {kind} {np.degrees(value):.4g} {unit} is beyond {limit}"
            for kind, found, unit, limit in kinds
            for joint, value in found.items()
        ]

    def facts(self) -> dict[str, Any]:
        """The verdict as plain values for JSON [rad, s]."""
        closest, fastest, hardest = self.closest, self.fastest, self.hardest
        return {
            "ok": self.ok,
            "angle": self.angle,
            "velocity": self.velocity,
            "acceleration": self.acceleration,
            "closest": [closest.joint, closest.position.margin],
            "fastest": [fastest.joint, fastest.speed.peak, fastest.speed.available],
            "hardest": [hardest.joint, hardest.acceleration.peak],
        }


def recheck(robot: Robot, gait: Gait) -> Recheck:
    """The demand of a gait on the joints of a robot, in the robot's own hip order."""
    return Recheck(joint_demands(robot, gait))

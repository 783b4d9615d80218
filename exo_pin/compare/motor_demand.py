"""Torque and power that a walk requires of the motors of a device."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from exo_pin.compare.best_motion import DeviceMotion
from exo_pin.demand import JointDemand, joint_demands
from exo_pin.devices import Device
from exo_pin.gait import Torques


@dataclass(frozen=True, eq=False)
class MotorDemand:
    """Torques of a walk against the effort of a device's motors; its joints move as in the plain copy.

    Attributes:
        device: The device.
        joints: Demand on each joint that a motor drives and whose torque is known.
    """

    device: Device
    joints: tuple[JointDemand, ...]

    @property
    def hardest(self) -> JointDemand | None:
        """The joint that uses the largest part of its effort; None where no torque is known."""
        return max(self.joints, key=_use, default=None)

    @property
    def peak_power(self) -> float:
        """Largest power of a motor, given or taken [W]; NaN where no torque is known."""
        return max((d.power.peak for d in self.joints if d.power is not None), default=math.nan)

    @property
    def ok(self) -> bool:
        """Whether no motor needs more torque than its effort."""
        return not self.failures

    @property
    def failures(self) -> tuple[str, ...]:
        """A sentence for each motor that is too weak: `left hip flexion torque: 166 of 150 N m`."""
        return tuple(_words(d) for d in self.joints if d.torque is not None and d.torque.exceeded.any())

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON: of each joint, then the verdict."""
        joints = {
            d.joint: {
                "peak_Nm": d.torque.peak,
                "limit_Nm": d.torque.available,
                "torque_use": d.torque.use,
                "peak_W": d.power.peak,
            }
            for d in self.joints
            if d.torque is not None and d.power is not None
        }
        return {"device": self.device.name, "joints": joints, "ok": self.ok, "failures": list(self.failures)}


def motor_demand(device: Device, copied: DeviceMotion, torques: Torques) -> MotorDemand:
    """The demand on a device's motors.

    Args:
        device: The device.
        copied: Its plain copy of the walk.
        torques: Joint torques of the walk, about the clinical axes.

    Raises:
        GaitError: The torques are at other times than the walk.
    """
    demands = joint_demands(copied.robot, copied.gait, torques=torques)
    return MotorDemand(device, tuple(d for d in demands if d.torque is not None and d.joint in device.joints))


def _use(demand: JointDemand) -> float:
    return 0.0 if demand.torque is None else demand.torque.use


def _words(demand: JointDemand) -> str:
    assert demand.torque is not None
    peak = demand.torque
    return f"{demand.joint.replace('_', ' ')} torque: {peak.peak:.0f} of {peak.available:.0f} N m"

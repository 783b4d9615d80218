"""Sizing of a device for a walk: every driven joint's load against the limits of its actuator or motor."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin import kinematics
from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import Reaction
from exo_pin.arguments import number
from exo_pin.arrays import Array
from exo_pin.dynamics import Dynamics
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr
from exo_pin.sizing.gear import fitting_ratios, geared
from exo_pin.sizing.joint_load import JointLoad
from exo_pin.sizing.joint_sizing import JointSizing
from exo_pin.sizing.motor import Motor

_FREE = 6
"""Degrees of freedom of the pelvis, in front of the joints'."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Sizing:
    """Every driven joint of a walk on a device.

    Attributes:
        joints: Driven joints, in the order of `JOINTS`.
        passive: Joints that move without a motor: their torque is not sized.
        motor: The motor of all joints, or None: the device's record counts.
        reaction: Whether the ground reaction behind the torques is `"measured"` or `"predicted"`.
        source: Where the torques come from, in words.
        remarks: What is not known or assumed, a plain sentence each.
    """

    joints: tuple[JointSizing, ...]
    passive: tuple[str, ...]
    motor: Motor | None
    reaction: Reaction
    source: str
    remarks: tuple[str, ...]

    __repr__ = short_repr

    @property
    def fits(self) -> bool:
        """Whether every joint's drive fits."""
        return all(joint.fits for joint in self.joints)

    @property
    def limit(self) -> str:
        """What the loads are held against, in words."""
        if self.motor is None:
            return "rectangle of the device's record (effort, velocity), no speed-torque line"
        return f"{self.motor.name} ({self.motor.source})"

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON, units as the keys say."""
        return {
            "fits": self.fits,
            "joints": {joint.load.joint: joint.facts() for joint in self.joints},
            "passive": list(self.passive),
            "limit": self.limit,
            "ground_reaction": self.reaction,
            "source": self.source,
            "remarks": list(self.remarks),
        }


def size(
    dynamics: Dynamics, *, stride: float = math.nan, motor: Motor | None = None, ratio: float | None = None
) -> Sizing:
    """The drives of a walk's joints, each bearing the whole torque of its joint.

    Args:
        dynamics: Of the walk on the device (`exo_pin.dynamics.torques`).
        stride: Stride time, for energies per stride [s] (`stride_time`); NaN: not known.
        motor: Stands for the effort and velocity of the device's record at every joint.
        ratio: Gear ratio of the motor at every joint; left out: those that fit are looked for.

    Raises:
        GaitError: No driven joint has a torque.
        DescriptionError: The ratio is not positive.
    """
    if ratio is not None:
        number("ratio", ratio, above=0.0)
    robot = dynamics.robot
    passive = () if robot.device is None else robot.device.passive
    loads = joint_loads(dynamics, stride)
    joints = []
    for name in (name for name in loads if name not in passive):
        j = robot.joints.index(name)
        joints.append(_sized(loads[name], float(robot.effort[j]), float(robot.velocity[j]), motor, ratio))
    if not joints:
        raise GaitError("no driven joint of this device has a torque on this walk")
    return Sizing(
        joints=tuple(joints),
        passive=tuple(name for name in passive if name in loads),
        motor=motor,
        reaction=dynamics.reaction,
        source=dynamics.source,
        remarks=(*dynamics.remarks, *_remarks(dynamics, stride)),
    )


def _remarks(dynamics: Dynamics, stride: float) -> list[str]:
    """What the numbers of a part of a walk are not."""
    found = []
    valid, frames = int(dynamics.valid.sum()), len(dynamics.valid)
    if valid < frames:
        found.append(
            f"Rms and energies are those of the {valid} of {frames} frames that are valid; a whole stride's "
            "differ where these are not spread evenly over it."
        )
    if math.isnan(stride):
        found.append("No stride time is known: there are no energies per stride.")
    return found


def joint_loads(dynamics: Dynamics, stride: float = math.nan) -> Mapping[str, JointLoad]:
    """The load of every joint that has a torque, over the frames that are valid.

    Args:
        dynamics: Of the walk.
        stride: Stride time [s]; NaN: not known.
    """
    robot, motion = dynamics.robot, dynamics.motion
    angles, accelerations = robot.angles(motion.q), motion.a[:, _FREE:]
    share = _shares(dynamics.time)
    found = {}
    for k, name in enumerate(JOINTS):
        torque = dynamics.torque[:, k]
        kept = np.isfinite(torque)
        if not kept.any():
            continue
        j = robot.joints.index(name)
        part = share[kept] / share[kept].sum()
        curves = (angles[kept, j], dynamics.velocity[kept, k], accelerations[kept, j], torque[kept])
        found[name] = JointLoad(name, *curves, part, stride)
    return found


def _sized(
    load: JointLoad, effort: float, velocity: float, motor: Motor | None, ratio: float | None
) -> JointSizing:
    return JointSizing(
        load=load,
        effort=effort,
        velocity=velocity,
        motor=motor,
        given=None if motor is None or ratio is None else geared(load, motor, ratio),
        ratios=None if motor is None else fitting_ratios(load, motor),
        spring=load.spring(),
    )


def _shares(time: Array) -> Array:
    """Part of the time that every sample stands for, also on an uneven clock."""
    steps = np.gradient(time)
    return np.asarray(steps / steps.sum())


def stride_time(robot: Robot, gait: Gait) -> float:
    """Mean stride time of a walk [s]; NaN where it has none.

    Args:
        robot: Who walks.
        gait: The walk.
    """
    try:
        numbers = kinematics.spatiotemporal(robot, gait)
    except GaitError:
        return math.nan
    return numbers["stride_time"].mean if "stride_time" in numbers else math.nan

"""Retargeted walk: joint values of another robot, errors of its feet, and use of its joint limits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import Body
from exo_pin.anatomy.names import Movement
from exo_pin.arrays import Array, Mask
from exo_pin.demand import PeakDemand, RangeDemand, peak_demands, range_demands
from exo_pin.files import json_number
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import angle_of
from exo_pin.gait.time_series import derivative
from exo_pin.kinematics import poses
from exo_pin.retarget.biped import Biped
from exo_pin.retarget.feet import largest_step
from exo_pin.retarget.target_robots import Target
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

_REACHED = 1e-5
"""A foot further from its goal than this is missed [m, rad]."""

_ROUNDING = math.radians(0.05)
"""A step that exceeds the largest one by less is none: the solver weighs it against the ankle's place."""


class LimitUse(NamedTuple):
    """One leg joint against its range [rad].

    Attributes:
        used: Values foot by foot, within the limits.
        copied: Values joint by joint, not clipped to the limits.
        speed: Velocities foot by foot against the file's limit, infinite where it has none [rad/s].
    """

    used: RangeDemand
    copied: RangeDemand
    speed: PeakDemand


class FootErrors(NamedTuple):
    """Distance of the feet from their goals.

    Attributes:
        position: Of the ankles (n, 2) [m].
        rotation: Of the feet (n, 2) [rad].
    """

    position: Array
    rotation: Array

    @property
    def position_rms(self) -> float:
        """Root mean square distance of the ankles [m]."""
        return float(np.sqrt(np.mean(self.position**2)))

    @property
    def largest_position(self) -> float:
        """Largest distance of an ankle [m]."""
        return float(self.position.max())

    @property
    def rotation_rms(self) -> float:
        """Root mean square angle of the feet [rad]."""
        return float(np.sqrt(np.mean(self.rotation**2)))

    @property
    def largest_rotation(self) -> float:
        """Largest angle of a foot [rad]."""
        return float(self.rotation.max())

    def facts(self) -> dict[str, float]:
        """Plain values for JSON."""
        return {
            "position_error_mm_rms": 1e3 * self.position_rms,
            "position_error_mm_max": 1e3 * self.largest_position,
            "rotation_error_deg_rms": math.degrees(self.rotation_rms),
            "rotation_error_deg_max": math.degrees(self.largest_rotation),
        }


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A walk on another robot.

    Attributes:
        biped: The robot with its legs.
        gait: The person's walk.
        q: Joint values (n, nq), foot by foot, within the robot's limits [rad].
        copied: Joint values (n, nq), joint by joint, not clipped to the limits [rad].
        base: T_world_root (n, 4, 4) of the robot's root, before its height is fitted to the ground.
        lean: Mean forward lean of the person's pelvis, which the robot's hips take over [rad].
        scale: Ratio of the robot's paths to the person's, left and right.
        ankles: Goals of the ankles (n, 2, 3), in the walker's axes at the robot's root [m].
        attitudes: Goals of the feet's rotation (n, 2, 3, 3), in the same axes.
        body: Whose walk it is.
        notes: What to know about the robot's description and this walk on it, a plain sentence each.
    """

    biped: Biped
    gait: Gait
    q: Array
    copied: Array
    base: Array
    lean: float
    scale: tuple[float, float]
    ankles: Array
    attitudes: Array
    body: Body
    notes: tuple[str, ...] = ()

    __repr__ = short_repr

    @property
    def target(self) -> Target:
        """The robot's record."""
        return self.biped.target

    @property
    def robot(self) -> Robot:
        """The robot, its root at the origin."""
        return self.biped.robot

    @property
    def time(self) -> Array:
        """Times (n,) [s]."""
        return self.gait.time

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of both legs."""
        return self.biped.joints

    @cached_property
    def errors(self) -> FootErrors:
        """Errors of the feet foot by foot."""
        return self._errors(self.q)

    @cached_property
    def copied_errors(self) -> FootErrors:
        """Errors of the feet joint by joint, without limits."""
        return self._errors(self.copied)

    @property
    def missed(self) -> Mask:
        """Feet (n, 2) that were not reached; of legs with fewer than six joints only the place counts."""
        any_pose = [leg.reaches_any_pose for leg in self.biped.legs]
        position, rotation = self.errors
        return np.asarray((position > _REACHED) | ((rotation > _REACHED) & any_pose))

    @property
    def missed_places(self) -> Mask:
        """Ankles (n, 2) that were not brought to their places."""
        return self.errors.position > _REACHED

    @property
    def jumps(self) -> Mask:
        """Which joints of the legs (k,) turn further between two samples than a walk asks for."""
        return self.largest_steps > largest_step(self.gait) + _ROUNDING

    @property
    def samples_missed(self) -> int:
        """Number of samples in which a foot was not reached."""
        return int(self.missed.any(axis=1).sum())

    @property
    def limit_use(self) -> dict[str, LimitUse]:
        """By leg joint, its values foot by foot and joint by joint against its limits."""
        used, copied = (range_demands(self.robot, q) for q in (self.q, self.copied))
        period = self.gait.duration if self.gait.periodic else None
        rates = derivative(self.time, self.robot.angles(self.q), 1, period)
        stated = np.where(self.robot.velocity > 0, self.robot.velocity, np.inf)
        speeds = peak_demands(self.robot.joints, rates, stated)
        return {name: LimitUse(used[name], copied[name], speeds[name]) for name in self.joints}

    @property
    def movements(self) -> dict[str, Movement]:
        """By leg joint, the movement of a person's leg that it makes."""
        pairs = (zip(leg.joints, leg.movements, strict=True) for leg in self.biped.legs)
        return {joint: movement for leg in pairs for joint, movement in leg}

    @property
    def largest_steps(self) -> Array:
        """What each joint of the legs (k,) turns by at most between two samples [rad]."""
        q = self.q[:, [self.robot.column(name) for name in self.joints]]
        steps = np.diff(q, axis=0, append=q[:1] if self.gait.periodic else q[-1:])
        return np.asarray(np.abs(steps).max(axis=0))

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "robot": self.target.name,
            "title": self.target.title,
            "samples": len(self.gait),
            "joints_per_leg": self.biped.joints_per_leg,
            "hip_order": self.biped.hip_order,
            "lean_deg": math.degrees(self.lean),
            "scale": list(self.scale),
            "foot_by_foot": self.errors.facts(),
            "samples_missed": self.samples_missed,
            "joint_by_joint": self.copied_errors.facts(),
            "joints": {
                name: {
                    "movement": self.movements[name],
                    "limits_deg": _degrees(used.available),
                    "used_deg": _degrees((used.lowest, used.highest)),
                    "limit_use": json_number(used.use),
                    "asked_deg": _degrees((copied.lowest, copied.highest)),
                    "samples_outside": copied.samples_outside,
                    "speed_rad_per_s": json_number(speed.peak),
                    "speed_limit_rad_per_s": _finite(speed.available),
                    "speed_use": json_number(speed.use) if _finite(speed.available) else None,
                }
                for name, (used, copied, speed) in self.limit_use.items()
            },
            "largest_step_deg": math.degrees(self.largest_steps.max()),
            "remarks": self.target.remarks,
            "notes": list(self.notes),
        }

    def _errors(self, q: Array) -> FootErrors:
        legs, rotation = self.biped.legs, self.biped.rotation
        T = poses(self.robot, q, [leg.foot for leg in legs])
        arms = np.array([leg.ankle_in_foot for leg in legs])
        ankles = (T[..., :3, 3] + np.einsum("nkij,kj->nki", T[..., :3, :3], arms)) @ rotation
        rest = np.array([leg.T[:3, :3] for leg in legs])
        R = rotation.T @ T[..., :3, :3] @ np.swapaxes(rest, -1, -2)
        off = np.swapaxes(self.attitudes, -1, -2) @ R
        return FootErrors(np.linalg.norm(ankles - self.ankles, axis=-1), angle_of(off))


def _finite(value: float) -> float | None:
    """A limit for JSON; None where there is none."""
    return value if math.isfinite(value) else None


def _degrees(pair: tuple[float, float]) -> list[float]:
    return [math.degrees(value) for value in pair]

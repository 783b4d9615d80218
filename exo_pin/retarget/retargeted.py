"""`Retargeted`: a walk on another robot, with what was missed and how much of its limits it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from exo_pin.anatomy import Body
from exo_pin.arrays import Array, Mask
from exo_pin.gait import Gait
from exo_pin.gait.rigid import angle_of
from exo_pin.kinematics import poses
from exo_pin.retarget.machine import Machine
from exo_pin.retarget.target_robots import Target
from exo_pin.robot import Robot

REACHED = 1e-5
"""A foot further away than this [m, rad] is missed."""

ROUNDING = 1e-9
"""A joint this little beyond its limit is on it [rad]."""


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A walk on another robot.

    Attributes:
        machine: The robot with its legs.
        gait: The person's walk.
        q: Joint values (n, nq), foot by foot, within the robot's limits [rad].
        copied: Joint values (n, nq), joint by joint, not cut to the limits [rad].
        base: T_world_root (n, 4, 4): how the robot's root goes, its height still to be fitted to the ground.
        lean: How far the person's pelvis leans forward on average, which the robot's hips take over [rad].
        scale: Robot's paths over the person's, left and right.
        ankles: Where the ankles shall be (n, 2, 3), in the walker's axes at the robot's root [m].
        attitudes: How the feet shall be turned (n, 2, 3, 3), in the same axes.
        body: Whose walk it is.
    """

    machine: Machine
    gait: Gait
    q: Array
    copied: Array
    base: Array
    lean: float
    scale: tuple[float, float]
    ankles: Array
    attitudes: Array
    body: Body

    @property
    def target(self) -> Target:
        """The robot's record."""
        return self.machine.target

    @property
    def robot(self) -> Robot:
        """The robot, its root at the origin."""
        return self.machine.robot

    @property
    def time(self) -> Array:
        """Times (n,) [s]."""
        return self.gait.time

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints of both legs."""
        return self.machine.joints

    @cached_property
    def errors(self) -> tuple[Array, Array]:
        """Foot by foot: how far ankles (n, 2) [m] and feet (n, 2) [rad] are from their goals."""
        return self._errors(self.q)

    @cached_property
    def copied_errors(self) -> tuple[Array, Array]:
        """The same joint by joint, as if there were no limits."""
        return self._errors(self.copied)

    @property
    def missed(self) -> Mask:
        """Which feet (n, 2) were not reached; legs of fewer than six joints answer for the place alone."""
        place, turn = self.errors
        whole = [leg.whole for leg in self.machine.legs]
        return np.asarray((place > REACHED) | ((turn > REACHED) & whole))

    def limit_use(self) -> dict[str, dict[str, Any]]:
        """By leg joint: its limits, what foot by foot uses of them and what joint by joint asks [rad].

        `share` is how far foot by foot goes on the way from mid-range to a limit (1: it is on the limit),
        `samples_outside` how often the limits forbid what joint by joint asks.
        """
        use = {}
        for name in self.joints:
            j, k = self.robot.column(name), self.robot.joints.index(name)
            low, high = float(self.robot.lower[k]), float(self.robot.upper[k])
            used, asked = self.q[:, j], self.copied[:, j]
            outside = (asked < low - ROUNDING) | (asked > high + ROUNDING)
            use[name] = {
                "limits": (low, high),
                "used": (float(used.min()), float(used.max())),
                "share": float(np.abs(2 * used - low - high).max() / (high - low)),
                "asked": (float(asked.min()), float(asked.max())),
                "samples_outside": int(outside.sum()),
            }
        return use

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "robot": self.target.name,
            "title": self.target.title,
            "samples": len(self.gait),
            "joints_per_leg": len(self.machine.legs[0].joints),
            "hip_order": self.machine.legs[0].hip_order,
            "lean_deg": math.degrees(self.lean),
            "scale": list(self.scale),
            "foot_by_foot": _residuals(*self.errors),
            "samples_missed": int(self.missed.any(axis=1).sum()),
            "joint_by_joint": _residuals(*self.copied_errors),
            "joints": {
                name: {
                    "limits_deg": _degrees(use["limits"]),
                    "used_deg": _degrees(use["used"]),
                    "limit_use": use["share"],
                    "asked_deg": _degrees(use["asked"]),
                    "samples_outside": use["samples_outside"],
                }
                for name, use in self.limit_use().items()
            },
            "remarks": self.target.remarks,
        }

    def _errors(self, q: Array) -> tuple[Array, Array]:
        legs, turn = self.machine.legs, self.machine.turn
        T = poses(self.robot, q, [leg.foot for leg in legs])
        arms = np.array([leg.ankle_in_foot for leg in legs])
        ankles = (T[..., :3, 3] + np.einsum("nkij,kj->nki", T[..., :3, :3], arms)) @ turn
        rest = np.array([leg.T[:3, :3] for leg in legs])
        R = turn.T @ T[..., :3, :3] @ np.swapaxes(rest, -1, -2)
        off = np.swapaxes(self.attitudes, -1, -2) @ R
        return np.linalg.norm(ankles - self.ankles, axis=-1), angle_of(off)


def _residuals(place: Array, turn: Array) -> dict[str, float]:
    return {
        "position_error_mm_rms": 1e3 * float(np.sqrt(np.mean(place**2))),
        "position_error_mm_max": 1e3 * float(place.max()),
        "rotation_error_deg_rms": float(np.degrees(np.sqrt(np.mean(turn**2)))),
        "rotation_error_deg_max": float(np.degrees(turn.max())),
    }


def _degrees(pair: tuple[float, float]) -> list[float]:
    return [math.degrees(value) for value in pair]

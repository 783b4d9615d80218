"""A leg of six revolute joints: its axes, hip centre, ankle centre and reach, read from the robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar, cast

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Index
from exo_pin.short_repr import short_repr

LEG_JOINTS = 6
Derived = TypeVar("Derived")


@dataclass(frozen=True, eq=False)
class LegAxes:
    """Six revolute joints in a row and the frame that they carry, the robot at its own placement, q = 0.

    Attributes:
        frame: Name of the frame.
        columns: Where the joints stand in q (6,).
        axes: Directions of the joint axes in the world (6, 3).
        points: A point on each axis (6, 3) [m].
        tip: T_world_frame (4, 4).
        lower: Lower joint limits (6,) [rad].
        upper: Upper joint limits (6,) [rad].
    """

    frame: str
    columns: Index
    axes: Array
    points: Array
    tip: Array
    lower: Array
    upper: Array

    __repr__ = short_repr

    @cached_property
    def hip(self) -> Array:
        """The point nearest to the first three axes (3,), the hip centre where these meet."""
        return nearest_point(self.points[:3], self.axes[:3])

    @cached_property
    def ankle(self) -> Array:
        """The point nearest to the last two axes (3,) at q = 0, the ankle centre where these meet."""
        return nearest_point(self.points[4:], self.axes[4:])

    @cached_property
    def ankle_in_frame(self) -> Array:
        """The ankle centre as the frame sees it (3,)."""
        return np.asarray(self.tip[:3, :3].T @ (self.ankle - self.tip[:3, 3]))

    @cached_property
    def reach_error(self) -> float:
        """By how much the reach may be wrong because the axes do not meet exactly [m]."""
        apart = [np.linalg.norm(np.cross(self.axes[j], self.hip - self.points[j])) for j in range(3)]
        apart += [np.linalg.norm(np.cross(self.axes[j], self.ankle - self.points[j])) for j in (4, 5)]
        skew = np.linalg.norm(np.cross(self.axes[3], self.axes[4])) * self.reach
        return float(2.0 * sum(apart) + skew) + 1e-6

    @cached_property
    def reach(self) -> float:
        """Largest distance from the hip centre to the ankle within the knee's limits [m]."""
        axis, point = self.axes[3], self.points[3]
        thigh, shank = self.hip - point, self.ankle - point
        along = (thigh @ axis) * (shank @ axis)
        swing = thigh @ shank - along, thigh @ np.cross(axis, shank)
        straight = math.atan2(swing[1], swing[0]) + math.pi
        straight -= 2 * math.pi * round((straight - 0.5 * (self.lower[3] + self.upper[3])) / (2 * math.pi))
        knee = min(max(straight, self.lower[3]), self.upper[3])
        ends = [knee, self.lower[3], self.upper[3]]
        dots = [along + swing[0] * math.cos(q) + swing[1] * math.sin(q) for q in ends]
        return math.sqrt(float(thigh @ thigh + shank @ shank - 2 * min(dots)))

    def derived(self, make: Callable[[LegAxes], Derived]) -> Derived:
        """What a function makes of this leg: made once and kept as long as the leg.

        Args:
            make: A function of a module, not a closure: it is the key under which its result is kept.
        """
        if make not in self._derived:
            self._derived[make] = make(self)
        return cast("Derived", self._derived[make])

    @cached_property
    def _derived(self) -> dict[Callable[[LegAxes], Any], Any]:
        return {}


def nearest_point(points: Array, axes: Array) -> Array:
    """The point with the least sum of squared distances to lines; nearest to their points if many."""
    across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    middle = points.mean(axis=0)
    right = np.einsum("kij,kj->i", across, points - middle)
    return np.asarray(middle + np.linalg.lstsq(across.sum(axis=0), right, rcond=1e-9)[0])


def read_leg(model: Any, frame: str, index: int, joints: list[int], rest: Array) -> LegAxes | None:
    """The leg that carries a frame, or None where its joints are not six revolute ones.

    Args:
        model: Pinocchio's model of the whole robot.
        frame: Name of the frame.
        index: Pinocchio's index of the frame.
        joints: Pinocchio's indices of the joints that carry it, from the root outwards.
        rest: Configuration (nq,) of the robot at its own placement, its joints at zero.
    """
    if len(joints) != LEG_JOINTS or any(model.nqs[j] != 1 for j in joints):
        return None
    data = model.createData()
    pin.framesForwardKinematics(model, data, rest)
    jacobians = pin.computeJointJacobians(model, data, rest)
    axes = np.array([jacobians[3:, model.idx_vs[j]] for j in joints])
    if np.abs(np.linalg.norm(axes, axis=1) - 1.0).max() > 1e-9:
        return None  # a prismatic joint
    columns = np.array([model.idx_qs[j] for j in joints])
    return LegAxes(
        frame=frame,
        columns=columns,
        axes=axes,
        points=np.array([data.oMi[j].translation for j in joints]),
        tip=np.array(data.oMf[index].homogeneous),
        lower=np.array(model.lowerPositionLimit)[columns],
        upper=np.array(model.upperPositionLimit)[columns],
    )

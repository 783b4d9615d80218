"""A leg read from the Robot: six axes from the pelvis to a frame, its hip centre, ankle and reach."""

from __future__ import annotations

import math
import weakref
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Index
from exo_pin.robot import Robot

AXES = 6
_LEGS: weakref.WeakKeyDictionary[Robot, dict[str, LegAxes | None]] = weakref.WeakKeyDictionary()


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

    @cached_property
    def hip(self) -> Array:
        """The point nearest to the first three axes (3,), the hip centre of an ideal leg."""
        return nearest_point(self.points[:3], self.axes[:3])

    @cached_property
    def ankle(self) -> Array:
        """The point nearest to the last two axes (3,) at q = 0, the ankle centre of an ideal leg."""
        return nearest_point(self.points[4:], self.axes[4:])

    @cached_property
    def ankle_in_frame(self) -> Array:
        """The ankle centre as the frame sees it (3,)."""
        return np.asarray(self.tip[:3, :3].T @ (self.ankle - self.tip[:3, 3]))

    @cached_property
    def doubt(self) -> float:
        """How far the reach may be off because the axes do not meet as an ideal leg's [m]."""
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


def leg(robot: Robot, frame: str) -> LegAxes | None:
    """The leg that carries a frame, or None where that is not a chain of six revolute joints."""
    known = _LEGS.setdefault(robot, {})
    if frame not in known:
        known[frame] = _read(robot, frame)
    return known[frame]


def nearest_point(points: Array, axes: Array) -> Array:
    """The point with the least sum of squared distances to lines; nearest to their points if many."""
    across = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    middle = points.mean(axis=0)
    right = np.einsum("kij,kj->i", across, points - middle)
    return np.asarray(middle + np.linalg.lstsq(across.sum(axis=0), right, rcond=1e-9)[0])


def _read(robot: Robot, frame: str) -> LegAxes | None:
    model, data = robot.model, robot.model.createData()
    index = robot.frame(frame)
    joints = [int(j) for j in model.supports[model.frames[index].parentJoint] if j > 0]
    if robot.base == "floating":
        joints = [j for j in joints if j != 1]
    if len(joints) != AXES or any(model.nqs[j] != 1 for j in joints):
        return None
    q = robot.neutral
    pin.framesForwardKinematics(model, data, q)
    slopes = pin.computeJointJacobians(model, data, q)
    axes = np.array([slopes[3:, model.idx_vs[j]] for j in joints])
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

"""Legs of a robot read from its model: movement of each joint, centres of hip and ankle, reach."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pinocchio as pin

from exo_pin.anatomy.names import Movement, Side
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait.rigid_poses import about
from exo_pin.kinematics import poses
from exo_pin.robot import Robot
from exo_pin.robot.leg_axes import nearest_point

_HIP: tuple[Movement, ...] = ("hip_adduction", "hip_flexion", "hip_rotation")
"""Movement of a hip joint by the coordinate that its axis is nearest to."""

_ANKLE: tuple[Movement | None, ...] = ("ankle_inversion", "ankle_dorsiflexion", None)
"""The same below the knee; no ankle rotates about the vertical."""

_LATERAL = 1
"""Coordinate of the flexion axes: y, to the left."""

_SIX = 6
"""Joints of a leg that can give its foot any pose."""

_KNEE_STEPS = 721  # a quarter of a degree over 180: the reach is found within 3e-6 of itself


@dataclass(frozen=True, eq=False)
class RobotLeg:
    """A leg of a standing robot in the walker's axes (x forward, y left, z up), the root at the origin.

    Attributes:
        side: `"left"` or `"right"`.
        foot: Name of the foot's link.
        joints: From the hip outwards.
        movements: Movement of a person's leg that each joint makes, e.g. `"knee_flexion"`.
        axes: Directions of the joints (k, 3).
        points: A point on each axis (k, 3) [m].
        limits: Lower and upper limits (k, 2) [rad], from the standing pose.
        T: Pose of the foot's link (4, 4).
    """

    side: Side
    foot: str
    joints: tuple[str, ...]
    movements: tuple[Movement, ...]
    axes: Array
    points: Array
    limits: Array
    T: Array

    @property
    def knee(self) -> int:
        """Index of the knee in `joints`."""
        return self.movements.index("knee_flexion")

    @property
    def reaches_any_pose(self) -> bool:
        """Whether it has six joints, for any pose of the foot; others reach places, not every attitude."""
        return len(self.joints) == _SIX

    @property
    def hip_order(self) -> str:
        """The hip's axes from the pelvis outwards, in words."""
        words: dict[Movement, str] = {"hip_flexion": "pitch", "hip_adduction": "roll", "hip_rotation": "yaw"}
        return "-".join(words[movement] for movement in self.movements[: self.knee])

    @cached_property
    def hip(self) -> Array:
        """The point nearest to the hip's axes (3,), moved sideways above the ankle [m]."""
        hip = nearest_point(self.points[: self.knee], self.axes[: self.knee])
        hip[_LATERAL] = self.ankle[_LATERAL]
        return hip

    @cached_property
    def ankle(self) -> Array:
        """The point nearest to the ankle's axes (3,); without an ankle the origin of the foot's link [m]."""
        below = slice(self.knee + 1, None)
        if not len(self.points[below]):
            return np.array(self.T[:3, 3])
        return nearest_point(self.points[below], self.axes[below])

    @cached_property
    def ankle_in_foot(self) -> Array:
        """The ankle in the axes of the foot's link (3,) [m]."""
        return np.asarray(self.T[:3, :3].T @ (self.ankle - self.T[:3, 3]))

    @cached_property
    def reach(self) -> float:
        """Largest distance from hip to ankle within the knee's limits [m]."""
        knee = self.points[self.knee]
        lower, upper = self.limits[self.knee].clip(-np.pi, np.pi)
        angles = np.linspace(float(lower), float(upper), _KNEE_STEPS)
        ankles = knee + about(self.axes[self.knee], angles) @ (self.ankle - knee)
        return float(np.linalg.norm(ankles - self.hip, axis=1).max())


def robot_leg(
    robot: Robot, side: Side, foot: str, joints: tuple[str, ...], stand: Array, rotation: Array
) -> RobotLeg:
    """Read a leg.

    Args:
        robot: The robot, its root at the origin.
        side: `"left"` or `"right"`.
        foot: The foot's link.
        joints: The leg's joints from the hip outwards.
        stand: Configuration (nq,) at which the robot stands.
        rotation: Rotation matrix (3, 3) from the walker's axes to the root link's.

    Raises:
        DescriptionError: A joint is prismatic, or the joints are no leg: no hip flexion and knee, or two
            joints for one movement.
    """
    model, data = robot.model, robot.model.createData()
    jacobians = pin.computeJointJacobians(model, data, stand)
    ids = [model.getJointId(name) for name in joints]
    axes = np.array([jacobians[3:, model.idx_vs[j]] for j in ids])
    if (np.linalg.norm(axes, axis=1) < 0.5).any():
        raise DescriptionError(
            f"the leg of {foot} has a prismatic joint, or one that has no axis; revolute joints are accepted"
        )
    columns = [robot.column(name) for name in joints]
    rows = [robot.joints.index(name) for name in joints]
    T = poses(robot, stand, [foot])[0]
    return RobotLeg(
        side=side,
        foot=foot,
        joints=joints,
        movements=movements(axes @ rotation, joints),
        axes=axes @ rotation,
        points=np.array([data.oMi[j].translation for j in ids]) @ rotation,
        limits=np.stack([robot.lower[rows], robot.upper[rows]], axis=1) - stand[columns, None],
        T=np.block([[rotation.T @ T[:3, :3], (rotation.T @ T[:3, 3:])], [np.zeros((1, 3)), np.ones((1, 1))]]),
    )


def movements(axes: Array, joints: tuple[str, ...]) -> tuple[Movement, ...]:
    """The movement of each joint of a leg from its axis (k, 3) in the walker's axes.

    Joints about the lateral axis are hip, knee and ankle flexion, in this order. Joints above the knee belong
    to the hip, joints below it to the ankle.

    Raises:
        DescriptionError: There is no hip flexion and knee, or a movement has no joint or two.
    """
    main = np.argmax(np.abs(axes), axis=1)
    flexing = np.flatnonzero(main == _LATERAL)
    if len(flexing) < 2:
        raise DescriptionError(
            f"the joints {', '.join(joints)} have no hip flexion and knee about the lateral axis"
        )
    knee = int(flexing[1])
    found: list[Movement | None] = [*(_HIP[k] for k in main[:knee]), "knee_flexion"]
    found += [_ANKLE[k] for k in main[knee + 1 :]]
    for movement in found:
        same = [joint for joint, other in zip(joints, found, strict=True) if other == movement]
        if len(same) > 1 or not movement:
            what = movement or "a rotation about the vertical below the knee"
            raise DescriptionError(
                f"{' and '.join(same)} stand for {what}; a leg has one joint for each movement"
            )
    return tuple(movement for movement in found if movement)

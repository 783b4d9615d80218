"""Legs of a robot read from its model: movements of joints, centres of hip and ankle, the knee's branch."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from exo_pin.anatomy.names import KneeBranch, Movement, Side
from exo_pin.arrays import Array
from exo_pin.gait.rigid_poses import about
from exo_pin.kinematics import poses
from exo_pin.retarget.leg_joints import LimbJoints, axes_and_points
from exo_pin.retarget.leg_search import Standing
from exo_pin.retarget.movements import LATERAL, movements
from exo_pin.robot.leg_axes import nearest_point

_SIX = 6
"""Joints of a leg that can give its foot any pose."""

_KNEE_STEPS = 1441  # a quarter of a degree over a turn: with a parabola, the straight leg within 1e-5 rad

_BENT = math.radians(0.5)
"""What a knee is bent by at least: a straight leg has no way to bend. It costs 8e-6 of the reach."""


@dataclass(frozen=True, eq=False)
class RobotLeg:
    """A leg of a standing robot in the walker's axes (x forward, y left, z up), the root at the origin.

    Attributes:
        side: `"left"` or `"right"`.
        foot: Name of the foot's link.
        joints: Those that move on their own, from the hip outwards.
        movements: Movement of a person's leg that each of them makes, e.g. `"knee_flexion"`.
        chain: Names of all joints that move: those and their followers (`<mimic>`), from the hip outwards.
        drive: What each joint of the chain moves by, over the motion of `joints` (K, k).
        chain_axes: Directions of the chain's joints (K, 3).
        chain_points: A point on each axis (K, 3) [m].
        chain_limits: Lower and upper limits (K, 2) [rad], from the standing pose.
        T: Pose of the foot's link (4, 4).
        branch: Which way the knee bends: in front of the line from hip to ankle, as a person's, or behind.
        held: Joints between hip and toes that stay as they stand, and why.
    """

    side: Side
    foot: str
    joints: tuple[str, ...]
    movements: tuple[Movement, ...]
    chain: tuple[str, ...]
    drive: Array
    chain_axes: Array
    chain_points: Array
    chain_limits: Array
    T: Array
    branch: KneeBranch = "front"
    held: Mapping[str, str] = field(default_factory=dict)

    @property
    def knee(self) -> int:
        """Index of the knee in `joints`."""
        return self.movements.index("knee_flexion")

    @property
    def axes(self) -> Array:
        """Directions of the joints that move on their own (k, 3)."""
        return self.chain_axes[self._rows]

    @property
    def points(self) -> Array:
        """A point on each of their axes (k, 3) [m]."""
        return self.chain_points[self._rows]

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
    def limits(self) -> Array:
        """Lower and upper limits (k, 2) of the joints and their followers, from the standing pose [rad]."""
        found = np.tile([-np.inf, np.inf], (len(self.joints), 1))
        for row, (lower, upper) in zip(self.drive, self.chain_limits, strict=True):
            k = int(np.flatnonzero(row)[0]) if row.any() else 0
            if row[k]:
                low, high = sorted((float(lower / row[k]), float(upper / row[k])))
                found[k] = max(found[k, 0], low), min(found[k, 1], high)
        return found

    @cached_property
    def allowed(self) -> Array:
        """The limits (k, 2) with the knee on its branch alone [rad]."""
        found = self.limits.copy()
        lower, upper = found[self.knee]
        bent = self.straight + (_BENT if self.flexes_upward else -_BENT)
        end = min(max(bent, float(lower)), float(upper))
        found[self.knee] = (end, upper) if self.flexes_upward else (lower, end)
        return found

    @property
    def flexes_upward(self) -> bool:
        """Whether the knee bends into its branch as its joint's value grows."""
        return bool((self.axes[self.knee, LATERAL] > 0) == (self.branch == "front"))

    @property
    def knee_range(self) -> tuple[float, float]:
        """How far the limits let the knee bend from the straight leg: in front, and behind [rad]."""
        lower, upper = self.limits[self.knee]
        up, down = max(0.0, float(upper) - max(self.straight, float(lower))), self.straight - float(lower)
        down = max(0.0, min(down, float(upper - lower)))
        return (up, down) if self.axes[self.knee, LATERAL] > 0 else (down, up)

    @cached_property
    def hip(self) -> Array:
        """The hip centre (3,): the point of the flexion axis above the ankle [m].

        Flexion decides how far a leg reaches; other hip axes may pass at a distance.
        """
        k = self.movements.index("hip_flexion")
        along = (self.ankle[LATERAL] - self.points[k, LATERAL]) / self.axes[k, LATERAL]
        return np.asarray(self.points[k] + along * self.axes[k])

    @cached_property
    def ankle(self) -> Array:
        """The ankle centre (3,): the point of the dorsiflexion axis nearest to the inversion axis [m].

        Without dorsiflexion it lies on the other axis; without an ankle it is the origin of the foot's link.
        """
        below = slice(self.knee + 1, None)
        axes, points = self.axes[below], self.points[below]
        if not len(points):
            return np.array(self.T[:3, 3])
        if "ankle_dorsiflexion" not in self.movements or len(points) == 1:
            return nearest_point(points, axes)
        k = self.movements[below].index("ankle_dorsiflexion")
        return _nearest_on(points[k], axes[k], points[1 - k], axes[1 - k])

    @cached_property
    def ankle_in_foot(self) -> Array:
        """The ankle in the axes of the foot's link (3,) [m]."""
        return np.asarray(self.T[:3, :3].T @ (self.ankle - self.T[:3, 3]))

    @cached_property
    def reach(self) -> float:
        """Largest distance from hip to ankle within the knee's limits [m]."""
        lower, upper = self.allowed[self.knee]
        return float(self._distance(np.linspace(float(lower), float(upper), _KNEE_STEPS)).max())

    @cached_property
    def straight(self) -> float:
        """Value of the knee's joint at which the leg is straight, from the standing pose [rad]."""
        angles = np.linspace(-math.pi, math.pi, _KNEE_STEPS)
        far = self._distance(angles)
        k = int(np.argmax(far))
        before, most, after = far[k - 1], far[k], far[(k + 1) % len(far)]
        bend = 2 * most - before - after
        return float(angles[k] + 0.5 * (after - before) / max(bend, 1e-12) * (angles[1] - angles[0]))

    @property
    def _rows(self) -> list[int]:
        """Where the joints that move on their own stand in the chain."""
        return [self.chain.index(name) for name in self.joints]

    def _distance(self, angles: Array) -> Array:
        """Distance (n,) from hip to ankle with the knee, and what follows it, at these angles [m]."""
        ankles = np.tile(self.ankle, (len(angles), 1))
        for k in reversed(range(len(self.chain))):
            ratio = self.drive[k, self.knee]
            if ratio:
                point = self.chain_points[k]
                turned = about(self.chain_axes[k], ratio * angles) @ (ankles - point)[..., None]
                ankles = point + turned[..., 0]
        return np.asarray(np.linalg.norm(ankles - self.hip, axis=1))


def robot_leg(known: Standing, side: Side, foot: str, limb: LimbJoints, rotation: Array) -> RobotLeg:
    """Read a leg.

    Args:
        known: The robot as it stands.
        side: `"left"` or `"right"`.
        foot: The foot's link.
        limb: The leg's joints from the hip outwards.
        rotation: Rotation matrix (3, 3) from the walker's axes to the root link's.

    Raises:
        DescriptionError: A joint is prismatic, or the joints are no leg: no hip flexion and knee, or two
            joints for one movement.
    """
    robot = known.robot
    axes, points = axes_and_points(known, limb.chain)
    own = [limb.chain.index(name) for name in limb.free]
    rows = [robot.joints.index(name) for name in limb.chain]
    limits = np.stack([robot.lower[rows], robot.upper[rows]], axis=1)
    T = poses(robot, known.stand, [foot])[0]
    placed = np.eye(4)
    placed[:3] = rotation.T @ T[:3]
    return RobotLeg(
        side=side,
        foot=foot,
        joints=limb.free,
        movements=movements(axes[own] @ rotation, points[own] @ rotation, limb.free),
        chain=limb.chain,
        drive=limb.drive,
        chain_axes=axes @ rotation,
        chain_points=points @ rotation,
        chain_limits=limits - known.stand[[robot.column(name) for name in limb.chain], None],
        T=placed,
        held=limb.held,
    )


def _nearest_on(point: Array, axis: Array, other: Array, other_axis: Array) -> Array:
    """The point of a line that is nearest to another line."""
    normal = np.cross(axis, other_axis)
    size = float(normal @ normal)
    if size < 1e-6:  # parallel
        return np.array(point)
    along = np.cross(other - point, other_axis) @ normal / size
    return np.asarray(point + along * axis)

"""`Robot`: a Pinocchio model addressed by the names of its joints and frames, its legs and subtrees."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.anatomy import JOINTS, Body
from exo_pin.anatomy.names import Base, HipOrder, Masses
from exo_pin.arguments import names, number, real, table
from exo_pin.arrays import Array, Mask
from exo_pin.devices import SLIDES, Device
from exo_pin.errors import LimitError, UnknownNameError
from exo_pin.gait import Gait
from exo_pin.robot.floating_base import FREE, base_coordinates, base_poses, unit_quaternion
from exo_pin.robot.gait_columns import gait_columns, in_hip_order
from exo_pin.robot.leg_axes import LegAxes, read_leg
from exo_pin.robot.subtree import (
    Subtree,
    frame_index,
    independent_groups,
    read_subtree,
    supporting_joints,
)
from exo_pin.short_repr import short_repr

LIMIT_TOLERANCE = 1e-9
"""A value this little beyond its limit is on it [rad, rad/s, rad/s^2, m]: the excess is rounding."""


@dataclass(frozen=True, eq=False)
class Robot:
    """A robot with two legs (or any URDF), every joint and frame addressed by its name.

    Attributes:
        model: Pinocchio's model. Its world is W; a fixed pelvis stands at `placement`.
        urdf: The text it was built from.
        joints: Names of the driven joints in the order of q (behind the floating base's 7 numbers, if any).
        lower: Lower joint limits (J,) [rad]; of prismatic joints [m].
        upper: Upper joint limits (J,) [rad]; of prismatic joints [m].
        velocity: Largest joint speeds (J,) [rad/s]; of prismatic joints [m/s].
        effort: Largest joint torques (J,) [N m]; of prismatic joints [N].
        placement: T_world_pelvis (4, 4) at rest: the longer leg's sole is on the ground at q = 0 (slides that
            carry the pelvis are in q, so at q = 0 this is the stand's pose too).
        base: `"fixed"` or `"floating"`.
        body: The body it was made for; None for a URDF from elsewhere.
        hip_order: Order of the hip joints from the pelvis outwards.
        device: The device it was made from; None for a URDF from elsewhere.
        path: The file that the URDF was read from, beside which its meshes are found; None for a text.
        masses: Whose masses its links have.
        remarks: What was changed in the URDF to have joints that move within limits, a plain sentence each.
    """

    model: Any
    urdf: str
    joints: tuple[str, ...]
    lower: Array
    upper: Array
    velocity: Array
    effort: Array
    placement: Array
    base: Base = "fixed"
    body: Body | None = None
    hip_order: HipOrder = "clinical"
    device: Device | None = None
    path: Path | None = None
    masses: Masses = "both"
    remarks: tuple[str, ...] = ()

    __repr__ = short_repr

    @property
    def name(self) -> str:
        """Name of the robot in its URDF."""
        return str(self.model.name)

    @property
    def frames(self) -> tuple[str, ...]:
        """Names of links and point frames, those of the feet and sole corners among them."""
        return tuple(f.name for f in self.model.frames if f.type == pin.FrameType.BODY)

    @property
    def nq(self) -> int:
        """Length of a configuration q."""
        return int(self.model.nq)

    @property
    def neutral(self) -> Array:
        """The configuration (nq,) with all joints at zero; a floating base stands at `placement`."""
        q = np.zeros(self.nq)
        if self.base == "floating":
            q[:FREE] = base_coordinates(self.placement)
        return q

    def frame(self, name: str) -> int:
        """Pinocchio's index of a link, point frame or joint (a locked one too).

        Raises:
            UnknownNameError: Nothing has that name.
        """
        index = frame_index(self.model, name) if isinstance(name, str) else self.model.nframes
        if index == self.model.nframes:
            raise UnknownNameError("frame", name, (*self.frames, *self.joints))
        return index

    def q(self, angles: Mapping[str, float] = MappingProxyType({})) -> Array:
        """A configuration (nq,) from joint angles [rad] by name; the others are zero.

        Raises:
            UnknownNameError: A joint is unknown.
            DescriptionError: An angle is no finite number.
        """
        q = self.neutral
        for name, angle in table("angles", angles).items():
            q[self.column(name)] = number(name, angle)
        return q

    def column(self, joint: str) -> int:
        """Where a joint's angle stands in q.

        Raises:
            UnknownNameError: The joint is unknown.
        """
        if joint not in self.joints:
            raise UnknownNameError("joint", joint, self.joints)
        return self.nq - len(self.joints) + self.joints.index(joint)

    def angles(self, q: npt.ArrayLike) -> Array:
        """The joint angles (..., J) of configurations (..., nq), in the order of `joints`.

        Raises:
            DescriptionError: The last axis does not fit, or an angle is no finite number.
        """
        return self.configurations(q)[..., self.nq - len(self.joints) :]

    def configurations(self, q: npt.ArrayLike, *, gaps: bool = False) -> Array:
        """Configurations (..., nq) as numbers, checked.

        Args:
            q: What was given, in the order of `joints`.
            gaps: Whether NaN is accepted.

        Raises:
            DescriptionError: The last axis does not fit, or a number is not finite.
        """
        return real("q", q, (..., self.nq), gaps=gaps)

    def unit_quaternion(self, q: Array) -> Array:
        """Configurations (..., nq) whose floating base has a quaternion of length 1, where they are not yet.

        Raises:
            DescriptionError: A quaternion is zero: it is no attitude; or q is no configuration.
        """
        q = self.configurations(q)
        return q if self.base == "fixed" else unit_quaternion(q)

    def outside(self, q: npt.ArrayLike, *, tolerance: float = LIMIT_TOLERANCE) -> Mask:
        """Which joints (..., J) of configurations (..., nq) lie more than `tolerance` beyond limits.

        Args:
            q: One configuration or many.
            tolerance: Allowed excess [rad].

        Raises:
            DescriptionError: A number is not finite, or the last axis does not fit.
        """
        angles, tolerance = self.angles(q), number("tolerance", tolerance)
        return np.asarray(~((angles >= self.lower - tolerance) & (angles <= self.upper + tolerance)))

    def check_limits(self, q: npt.ArrayLike, *, tolerance: float = LIMIT_TOLERANCE) -> None:
        """Refuse configurations (..., nq) outside the joint limits.

        Args:
            q: One configuration or many.
            tolerance: Allowed excess [rad]; the default forgives rounding only.

        Raises:
            LimitError: Names the joint that is furthest outside.
            DescriptionError: The last axis does not fit, or a number is infinite.
        """
        number("tolerance", tolerance)
        joints = self.configurations(q, gaps=True)[..., self.nq - len(self.joints) :]
        angles = joints.reshape(-1, len(self.joints))
        excess = np.maximum(angles - self.upper, self.lower - angles)
        excess[np.isnan(excess)] = np.inf  # not a number is outside every limit
        if not len(excess) or excess.max() <= tolerance:
            return
        frame, j = np.unravel_index(np.argmax(excess), excess.shape)
        where = f" in frame {frame}" if len(angles) > 1 else ""
        raise LimitError(
            self.joints[j], float(angles[frame, j]), float(self.lower[j]), float(self.upper[j]), where=where
        )

    def leg(self, frame: str) -> LegAxes | None:
        """The leg that carries a frame; None where that is not a chain of six revolute joints.

        Raises:
            UnknownNameError: The frame is unknown.
        """
        if not isinstance(frame, str) or frame not in self._legs:
            joints = sorted(self._joints_above(frame, base_moves=False))
            self._legs[frame] = read_leg(self.model, frame, self.frame(frame), joints, self.neutral)
        return self._legs[frame]

    def subtree(self, frames: Sequence[str], *, base_moves: bool = False) -> Subtree:
        """The joints that move any of the frames.

        Args:
            frames: Names of the frames.
            base_moves: Whether a floating base is one of the joints; otherwise it stays at `placement`.

        Raises:
            UnknownNameError: A frame is unknown.
        """
        key = names("frames", frames), base_moves
        if key not in self._subtrees:
            joints = set().union(*(self._joints_above(name, base_moves=base_moves) for name in frames))
            floating = self.base == "floating" and 1 in joints
            self._subtrees[key] = read_subtree(
                self.model, key[0], joints, rest=self.neutral, floating=floating
            )
        return self._subtrees[key]

    def subtrees(self, frames: Sequence[str], *, base_moves: bool = False) -> tuple[Subtree, ...]:
        """One subtree for each group of frames that share joints; arguments as for `subtree`."""
        key = names("frames", frames), base_moves
        if key not in self._groups:
            joints = {name: self._joints_above(name, base_moves=base_moves) for name in frames}
            groups = independent_groups(joints)
            self._groups[key] = tuple(self.subtree(names, base_moves=base_moves) for names in groups)
        return self._groups[key]

    def base_of(self, gait: Gait) -> Array | None:
        """The `base=` of a gait on this robot: the gait's own; None for a floating base, which q holds."""
        return gait.base if self.base == "fixed" else None

    def pelvis_poses(self, gait: Gait) -> Array:
        """T_world_pelvis (n, 4, 4) of a gait: its base, or `placement` where the gait has none."""
        return np.tile(self.placement, (len(gait), 1, 1)) if gait.base is None else np.array(gait.base)

    def from_gait(self, gait: Gait) -> Array:
        """The gait in this robot's own coordinates (n, nq): its joints, its hip order, its base.

        Joints that the device locks are dropped; joints that the device adds stay at zero.

        Raises:
            DescriptionError: The robot has one of the gait's joints neither moving nor locked.
        """
        q = np.tile(self.neutral, (len(gait.q), 1))
        if self.base == "floating" and gait.base is not None:
            q[:, :FREE] = base_coordinates(gait.base)
        mine, columns = gait_columns(self.model, self.joints)
        angles = in_hip_order(gait.q, source="clinical", target=self.hip_order)
        for k, column in zip(mine, columns, strict=True):
            q[:, column] = angles[:, k]
        return q

    def to_gait(self, q: npt.ArrayLike, like: Gait) -> Gait:
        """Configurations (n, nq) as a gait, the inverse of `from_gait`.

        Joints that the device locks are zero. Slides move the base: it is the pelvis's, not the stand's.

        Args:
            q: Configurations (n, nq) [rad, m].
            like: Gives time, events and, for a held pelvis, the base.

        Raises:
            DescriptionError: The shape of q does not fit, or a number is not finite.
        """
        q = real("q", q, (len(like), self.nq))
        base = like.base
        if self.base == "floating":
            base = base_poses(unit_quaternion(q))
        elif any(slide in self.joints for slide in SLIDES):
            base = (self.placement if base is None else base) @ self.slid(q)
        mine, columns = gait_columns(self.model, self.joints)
        angles = np.zeros((len(q), len(JOINTS)))
        angles[:, mine] = q[:, columns]
        clinical = in_hip_order(angles, source=self.hip_order, target="clinical")
        return dataclasses.replace(like, q=clinical, base=base)

    @cached_property
    def floating(self) -> dict[Masses, Robot]:
        """The same robot on a floating pelvis by whose masses it has, filled by `exo_pin.dynamics`."""
        return {}

    def slid(self, q: npt.ArrayLike) -> Array:
        """T_stand_pelvis (..., 4, 4): where the slides of q (..., nq) have carried the pelvis.

        Raises:
            DescriptionError: The shape of q does not fit, or a number is not finite.
        """
        q = self.configurations(q)
        T = np.tile(np.eye(4), (*q.shape[:-1], 1, 1))
        for axis, slide in enumerate(SLIDES):
            if slide in self.joints:
                T[..., axis, 3] = q[..., self.column(slide)]
        return T

    def __getstate__(self) -> dict[str, Any]:
        """The attributes alone: what is derived from them is made again where a copy needs it."""
        return {field.name: vars(self)[field.name] for field in dataclasses.fields(self)}

    def _joints_above(self, frame: str, *, base_moves: bool) -> set[int]:
        """Pinocchio's indices of the joints that move a frame."""
        joints = supporting_joints(self.model, self.frame(frame))
        return joints - {1} if self.base == "floating" and not base_moves else joints

    @cached_property
    def _legs(self) -> dict[str, LegAxes | None]:
        return {}

    @cached_property
    def _subtrees(self) -> dict[tuple[tuple[str, ...], bool], Subtree]:
        return {}

    @cached_property
    def _groups(self) -> dict[tuple[tuple[str, ...], bool], tuple[Subtree, ...]]:
        return {}

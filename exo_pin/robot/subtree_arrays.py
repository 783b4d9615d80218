"""Forward kinematics of a subtree by products of exponentials, for many samples at once.

Every joint is an axis and a point on it, in the world, at q = 0 (Brockett 1984). Samples stand on the last
axis. Legs of six joints have their own, quicker arithmetic in `exo_pin.robot.leg_forward`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Mask
from exo_pin.short_repr import short_repr


class SubtreePose(NamedTuple):
    """Where the joints of a subtree are, m samples.

    Attributes:
        axes: Directions of the joint axes (3, J, m).
        points: Points on the axes (3, J, m) [m].
        R: Rotation of each frame since q = 0 (F, 3, 3, m).
        p: Where the motion of each frame since q = 0 takes the world's origin (F, 3, m) [m].
    """

    axes: Array
    points: Array
    R: Array
    p: Array


@dataclass(frozen=True, eq=False)
class SubtreeArrays:
    """The joints of a subtree as arrays, each joint after those that carry it.

    Attributes:
        axes: Unit directions of the joint axes (J, 3).
        points: A point on each axis (J, 3) [m].
        revolute: Which joints are revolute (J,); the others are prismatic.
        parents: The joint that carries each joint (J,); -1: none.
        carriers: The joint that carries each frame (F,).
        moves: Which joints move which frame (F, J).
        frames: T_world_frame at q = 0 (F, 4, 4).
    """

    axes: Array
    points: Array
    revolute: Mask
    parents: tuple[int, ...]
    carriers: tuple[int, ...]
    moves: Mask
    frames: Array

    __repr__ = short_repr

    def pose(self, q: Array) -> SubtreePose:
        """Where axes and frames are at the configurations q (J, m) [rad, m]."""
        R, p = self._alone(q)
        before_R, before_p = [], []
        count, samples = q.shape
        still = np.broadcast_to(np.eye(3)[..., None], (3, 3, samples)), np.zeros((3, samples))
        done: list[tuple[Array, Array]] = []
        for j in range(count):
            parent = still if self.parents[j] < 0 else done[self.parents[j]]
            before_R.append(parent[0])
            before_p.append(parent[1])
            turned = times(parent[0], R[j]) if self.revolute[j] else parent[0]
            done.append((turned, _turned(parent[0], p[j]) + parent[1]))
        S, t = np.stack(before_R), np.stack(before_p)
        axes = np.einsum("jabm,jb->ajm", S, self.axes)
        points = np.einsum("jabm,jb->ajm", S, self.points) + t.swapaxes(0, 1)
        ends = [done[j] if j >= 0 else still for j in self.carriers]
        return SubtreePose(
            axes, points, np.stack([end[0] for end in ends]), np.stack([end[1] for end in ends])
        )

    def _alone(self, q: Array) -> tuple[Array, Array]:
        """Rotation (J, 3, 3, m) and shift (J, 3, m) by each joint, the others at zero (Rodrigues)."""
        K = np.zeros((len(self.axes), 3, 3))
        for i in range(3):
            a, b = (i + 1) % 3, (i + 2) % 3
            K[:, b, a], K[:, a, b] = self.axes[:, i], -self.axes[:, i]
        K[~self.revolute] = 0.0
        square = K @ K
        sine, rest = np.sin(q), 1.0 - np.cos(q)
        R = (
            np.eye(3)[..., None]
            + K[..., None] * sine[:, None, None]
            + square[..., None] * rest[:, None, None]
        )
        once, twice = ((A @ self.points[:, :, None]) for A in (K, square))
        shift = -(once * sine[:, None] + twice * rest[:, None])
        shift[~self.revolute] = (self.axes[..., None] * q[:, None])[~self.revolute]
        return R, shift


def read_arrays(model: Any, frames: tuple[int, ...]) -> SubtreeArrays | None:
    """The joints of Pinocchio's model, or None where one is neither revolute nor prismatic.

    Args:
        model: A model without a floating base.
        frames: Pinocchio's indices of the frames (F,).
    """
    ids = range(1, model.njoints)
    if any(model.nqs[j] != 1 or model.nvs[j] != 1 for j in ids):
        return None
    data, q = model.createData(), pin.neutral(model)
    pin.framesForwardKinematics(model, data, q)
    jacobians = pin.computeJointJacobians(model, data, q).reshape(6, -1)
    revolute = np.linalg.norm(jacobians[3:], axis=0) > 0.5
    carriers = tuple(model.frames[f].parentJoint - 1 for f in frames)
    above = [{int(i) - 1 for i in model.supports[carrier + 1]} for carrier in carriers]
    return SubtreeArrays(
        axes=np.where(revolute, jacobians[3:], jacobians[:3]).T,
        points=np.array([data.oMi[j].translation for j in ids]),
        revolute=revolute,
        parents=tuple(int(model.parents[j]) - 1 for j in ids),
        carriers=carriers,
        moves=np.array([[j in own for j in range(model.nv)] for own in above]),
        frames=np.array([data.oMf[f].homogeneous for f in frames]),
    )


def times(A: Array, B: Array) -> Array:
    """Matrices (3, 3, m) times matrices or rows of vectors (3, k, m)."""
    return np.asarray(A[:, 0, None] * B[0] + A[:, 1, None] * B[1] + A[:, 2, None] * B[2])


def _turned(R: Array, v: Array) -> Array:
    return np.asarray(R[:, 0] * v[0] + R[:, 1] * v[1] + R[:, 2] * v[2])

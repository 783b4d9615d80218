"""The joints of a limb as arrays: where axes and frames are, for many samples at once.

Products of exponentials (Brockett 1984): every joint is an axis and a point on it, in the world, at q = 0.
Legs of six joints have their own, quicker arithmetic in `chain`. Samples stand on the last axis.
"""

from __future__ import annotations

import weakref
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array, Mask
from exo_pin.ik.subtree import Limb

_KNOWN: weakref.WeakKeyDictionary[Limb, Branches | None] = weakref.WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Branches:
    """The joints of one limb, in an order in which every joint comes after those that carry it.

    Attributes:
        axes: Unit directions of the axes (J, 3).
        points: A point on each axis (J, 3) [m].
        turns: Which joints turn (J,); the others slide.
        parents: The joint that carries each joint (J,); -1: none.
        carriers: The joint that carries each frame (F,).
        moves: Which joints move which frame (F, J).
        frames: T_world_frame at q = 0 (F, 4, 4).
    """

    axes: Array
    points: Array
    turns: Mask
    parents: tuple[int, ...]
    carriers: tuple[int, ...]
    moves: Mask
    frames: Array


class SubtreePose(NamedTuple):
    """Where the joints of a limb are, m samples.

    Attributes:
        axes: Directions of the axes (3, J, m).
        points: Points on the axes (3, J, m) [m].
        R: What turned the frames since q = 0 (F, 3, 3, m).
        p: What shifted the world's origin with each frame (F, 3, m) [m].
    """

    axes: Array
    points: Array
    R: Array
    p: Array


def branches(limb: Limb) -> Branches | None:
    """The limb's joints, or None where a joint is neither a plain turn nor a plain slide."""
    if limb not in _KNOWN:
        _KNOWN[limb] = _read(limb)
    return _KNOWN[limb]


def _read(limb: Limb) -> Branches | None:
    model = limb.model
    ids = range(1, model.njoints)
    if limb.floats or any(model.nqs[j] != 1 or model.nvs[j] != 1 for j in ids):
        return None
    data, q = model.createData(), pin.neutral(model)
    pin.framesForwardKinematics(model, data, q)
    slopes = pin.computeJointJacobians(model, data, q).reshape(6, -1)
    turns = np.linalg.norm(slopes[3:], axis=0) > 0.5
    carriers = tuple(model.frames[f].parentJoint - 1 for f in limb.ids)
    above = [{int(i) - 1 for i in model.supports[carrier + 1]} for carrier in carriers]
    return Branches(
        axes=np.where(turns, slopes[3:], slopes[:3]).T,
        points=np.array([data.oMi[j].translation for j in ids]),
        turns=turns,
        parents=tuple(int(model.parents[j]) - 1 for j in ids),
        carriers=carriers,
        moves=np.array([[j in own for j in range(model.nv)] for own in above]),
        frames=np.array([data.oMf[f].homogeneous for f in limb.ids]),
    )


def motion(limb: Branches, q: Array) -> SubtreePose:
    """Where axes and frames are at the configurations q (J, m)."""
    R, p = _steps(limb, q)
    before_R, before_p = [], []
    count, samples = q.shape
    still = np.broadcast_to(np.eye(3)[..., None], (3, 3, samples)), np.zeros((3, samples))
    done: list[tuple[Array, Array]] = []
    for j in range(count):
        parent = still if limb.parents[j] < 0 else done[limb.parents[j]]
        before_R.append(parent[0])
        before_p.append(parent[1])
        turned = times(parent[0], R[j]) if limb.turns[j] else parent[0]
        done.append((turned, _turned(parent[0], p[j]) + parent[1]))
    S, t = np.stack(before_R), np.stack(before_p)
    axes = np.einsum("jabm,jb->ajm", S, limb.axes)
    points = np.einsum("jabm,jb->ajm", S, limb.points) + t.swapaxes(0, 1)
    ends = [done[j] if j >= 0 else still for j in limb.carriers]
    return SubtreePose(axes, points, np.stack([end[0] for end in ends]), np.stack([end[1] for end in ends]))


def times(A: Array, B: Array) -> Array:
    """Matrices (3, 3, m) times matrices or rows of vectors (3, k, m)."""
    return np.asarray(A[:, 0, None] * B[0] + A[:, 1, None] * B[1] + A[:, 2, None] * B[2])


def _steps(limb: Branches, q: Array) -> tuple[Array, Array]:
    """Rotation (J, 3, 3, m) and shift (J, 3, m) of each joint alone, the others at zero (Rodrigues)."""
    K = np.zeros((len(limb.axes), 3, 3))
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        K[:, b, a], K[:, a, b] = limb.axes[:, i], -limb.axes[:, i]
    K[~limb.turns] = 0.0
    square = K @ K
    sine, rest = np.sin(q), 1.0 - np.cos(q)
    R = np.eye(3)[..., None] + K[..., None] * sine[:, None, None] + square[..., None] * rest[:, None, None]
    once, twice = ((A @ limb.points[:, :, None]) for A in (K, square))
    shift = -(once * sine[:, None] + twice * rest[:, None])
    shift[~limb.turns] = (limb.axes[..., None] * q[:, None])[~limb.turns]
    return R, shift


def _turned(R: Array, v: Array) -> Array:
    return np.asarray(R[:, 0] * v[0] + R[:, 1] * v[1] + R[:, 2] * v[2])

"""What the targets of a subtree ask of its joints: cost, slope and curvature, for many samples at once.

Points on one rigid frame enter only through sums, however many they are: their weight W, centre c, and the
moments B = sum w^2 d e^T and D = sum w^2 d d^T of arms d = x - c and errors e. With l_j the velocity of c
and a_j the angular velocity that joint j causes, the cost f = 1/2 sum w^2 |e|^2 has

    -df/dq_j       = l_j . sum w^2 e + a_j . sum w^2 d x e
    Gauss-Newton   = W l_i . l_j + a_i . (tr D - D) a_j
    what it leaves = -a_i . (l_j x sum w^2 e + (B - tr B) a_j),   joint i carrying joint j

A rotation that is missed by the vector t adds t . a_j to the slope, a_i . a_j to the normal part, and
-k (t x a_i) . (t x a_j) - t . (a_i x a_j) / 2 to the rest, with k = (1 - |t|/2 cot |t|/2) / |t|^2, from the
inverse Jacobian of the rotation vector.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.arrays import Array, Index, Mask
from exo_pin.ik.least_squares.leg_kernel import turn
from exo_pin.ik.settings import Dls
from exo_pin.ik.targets import Goal
from exo_pin.robot.subtree_arrays import SubtreeArrays, SubtreePose, times


class Pull(NamedTuple):
    """Cost and its derivatives over J joints, m samples, F frames.

    Attributes:
        cost: Sum of squared weighted errors (m,).
        slope: Half its negative gradient (J, m).
        normal: The Gauss-Newton part of half its Hessian (J, J, m).
        rest: The other part (J, J, m).
        errors: Distance [m] and angle [rad] of each frame (2, F, m); NaN where no rotation is asked.
    """

    cost: Array
    slope: Array
    normal: Array
    rest: Array
    errors: Array

    def where(self, better: Mask, other: Pull) -> Pull:
        """The other's samples where they are better."""
        return Pull(*(np.where(better, new, old) for old, new in zip(self, other, strict=True)))

    def only(self, stay: Index) -> Pull:
        """Some of the samples."""
        return Pull(*(values[..., stay] for values in self))


class Aim(NamedTuple):
    """A goal of some samples, samples last: points (3, k, m), squared weights (k, m), rotation (3, 3, m)."""

    local: Array
    p: Array
    weight: Array
    R: Array | None
    rotation_weight: float

    def only(self, stay: Index) -> Aim:
        """Some of the samples."""
        R = None if self.R is None else self.R[..., stay]
        return self._replace(p=self.p[..., stay], weight=self.weight[..., stay], R=R)


def aims(arrays: SubtreeArrays, goals: list[Goal], part: slice, settings: Dls) -> list[Aim]:
    """The goals of some samples, their points seen from the world at q = 0."""
    out = []
    for goal, T in zip(goals, arrays.frames, strict=True):
        R = None if goal.R is None else np.ascontiguousarray(goal.R[part].transpose(1, 2, 0))
        out.append(
            Aim(
                local=T[:3, :3] @ goal.local.T + T[:3, 3:],
                p=np.ascontiguousarray(goal.p[part].transpose(2, 1, 0)),
                weight=np.ascontiguousarray((settings.position_weight * goal.weight[part]).T ** 2),
                R=None if R is None else np.einsum("abm,cb->acm", R, T[:3, :3]),
                rotation_weight=(settings.rotation_weight * goal.rotation_weight) ** 2,
            )
        )
    return out


def pull(arrays: SubtreeArrays, aimed: list[Aim], q: Array) -> Pull:
    """Cost and derivatives at the configurations q (J, m)."""
    now = arrays.pose(q)
    count, samples = q.shape
    total = Pull(
        np.zeros(samples),
        np.zeros((count, samples)),
        np.zeros((count, count, samples)),
        np.zeros((count, count, samples)),
        np.full((2, len(aimed), samples), np.nan),
    )
    for f, aim in enumerate(aimed):
        own = np.flatnonzero(arrays.moves[f])
        turns = arrays.revolute[own, None]
        spin = now.axes[:, own] * turns
        _add_points(total, arrays, now, aim, f, own, spin)
        if aim.R is not None:
            _add_rotation(total, now.R[f], aim, f, own, spin)
    return total


def _add_points(
    total: Pull, arrays: SubtreeArrays, now: SubtreePose, aim: Aim, f: int, own: Index, spin: Array
) -> None:
    x = np.einsum("abm,bk->akm", now.R[f], aim.local) + now.p[f][:, None]
    e = aim.p - x
    distance = np.sqrt((e * e).sum(axis=0))
    total.errors[0, f] = np.where(aim.weight > 0.0, distance, 0.0).max(axis=0)
    weighted = aim.weight * e
    total.cost[:] += (weighted * e).sum(axis=(0, 1))
    W, force = aim.weight.sum(axis=0), weighted.sum(axis=1)
    centre = (aim.weight * x).sum(axis=1) / np.where(W > 0.0, W, 1.0)
    d = x - centre[:, None]
    B = (d[:, None] * weighted).sum(axis=2)
    D = (d[:, None] * (aim.weight * d)).sum(axis=2)
    torque = np.stack([B[1, 2] - B[2, 1], B[2, 0] - B[0, 2], B[0, 1] - B[1, 0]])
    slide = np.where(
        arrays.revolute[own, None], cross(spin, centre[:, None] - now.points[:, own]), now.axes[:, own]
    )
    total.slope[own] += (slide * force[:, None]).sum(axis=0) + (spin * torque[:, None]).sum(axis=0)
    square = np.ix_(own, own)
    inertia = np.trace(D) * spin - times(D, spin)
    total.normal[square] += _dots(W * slide, slide) + _dots(spin, inertia)
    bent = cross(slide, np.broadcast_to(force[:, None], slide.shape)) + times(B, spin) - np.trace(B) * spin
    total.rest[square] -= _mirrored(_dots(spin, bent))


def _add_rotation(total: Pull, R: Array, aim: Aim, f: int, own: Index, spin: Array) -> None:
    assert aim.R is not None
    t = turn([list(row) for row in R], [list(row) for row in aim.R])
    angle = np.sqrt((t * t).sum(axis=0))
    total.errors[1, f] = angle
    weight = aim.rotation_weight
    total.cost[:] += weight * angle**2
    total.slope[own] += weight * (spin * t[:, None]).sum(axis=0)
    square = np.ix_(own, own)
    total.normal[square] += weight * _dots(spin, spin)
    k = bow(angle)
    twist = cross(np.broadcast_to(t[:, None], spin.shape), spin)
    total.rest[square] -= weight * (k * _dots(twist, twist) + 0.5 * _mirrored(_dots(spin, -twist)))


def bow(angle: npt.ArrayLike) -> Array:
    """The k of the module's formulas for missed rotations by these angles [rad]; 1/12 for small ones."""
    half = 0.5 * np.maximum(angle, 1e-4)
    return np.asarray((1.0 - half / np.tan(half)) / (4.0 * half * half))


def cross(a: Array, b: Array) -> Array:
    """The cross product along the first axis."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _dots(a: Array, b: Array) -> Array:
    """Every a with every b: (3, J, m), (3, J, m) -> (J, J, m)."""
    return np.asarray(a[0, :, None] * b[0] + a[1, :, None] * b[1] + a[2, :, None] * b[2])


def _mirrored(A: Array) -> Array:
    """The half above the diagonal on both sides: there, the first joint carries the second."""
    upper = np.triu(np.ones(A.shape[:2], dtype=bool))[..., None]
    return np.where(upper, A, A.swapaxes(0, 1))

"""Rigid poses in time: orthonormality, nearest rotation, Rodrigues' formula, angle, angular velocity."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array, Mask
from exo_pin.chunks import for_chunks

_ORTHONORMAL = 1e-6
"""Largest entry of R^T R - I that still counts as a rotation: seven digits, what files carry."""

_FARTHEST = 1e6
"""A position further away than this [m] is a mistake of units."""


def not_rigid(T: Array) -> int | None:
    """Index of the first of the `(n, 4, 4)` poses that is not rigid, or None if all are."""
    good = np.empty(len(T), dtype=bool)

    def of_chunk(part: slice) -> None:
        good[part] = _rigid(T[part])

    for_chunks(len(T), T, of_chunk)
    return None if good.all() else int(np.argmin(good))


def _rigid(T: Array) -> Mask:
    """`(n,)` whether the `(n, 4, 4)` poses are rigid."""
    R = T[:, :3, :3]
    with np.errstate(invalid="ignore", over="ignore"):  # NaN and huge numbers fail the comparisons below
        skew = np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max(axis=(1, 2))
        near = (np.abs(T[:, :3, 3]) <= _FARTHEST).all(axis=1)
        rotation = (skew <= _ORTHONORMAL) & (np.linalg.det(R) > 0)
    return np.asarray(rotation & near & (T[:, 3] == [0.0, 0.0, 0.0, 1.0]).all(axis=1))


def nearest_pose(T: Array) -> Array:
    """The `(n, 4, 4)` matrices with the nearest rotations (polar, by SVD) in them."""
    pose = np.tile(np.eye(4), (len(T), 1, 1))
    U, _, Vt = np.linalg.svd(T[:, :3, :3])
    U[:, :, 2] *= np.linalg.det(U @ Vt)[:, None]  # no reflections
    pose[:, :3, :3] = U @ Vt
    pose[:, :3, 3] = T[:, :3, 3]
    return pose


def about(axis: ArrayLike, angle: ArrayLike) -> Array:
    """`(n, 3, 3)` rotations about a unit axis `(3,)` by angles `(n,)` [rad], `(3, 3)` by one (Rodrigues)."""
    x, y, z = np.asarray(axis, dtype=float)
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.asarray(angle, dtype=float)[..., None, None]
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K))


def angle_of(R: Array) -> Array:
    """`(...)` angles of rotations `(..., 3, 3)` [rad], 0 to pi; exact near 0, unlike an arc cosine."""
    twist = R - np.swapaxes(R, -1, -2)
    sine = np.linalg.norm(twist[..., [2, 0, 1], [1, 2, 0]], axis=-1) / 2
    return np.asarray(np.arctan2(sine, (np.trace(R, axis1=-2, axis2=-1) - 1) / 2))


def angular_velocity(R: Array, dR: Array) -> Array:
    """`(n, 3)` angular velocity [rad/s], world axes, from `(n, 3, 3)` rotations and derivatives."""
    W = dR @ np.swapaxes(R, 1, 2)  # skew up to the differencing's error
    W = (W - np.swapaxes(W, 1, 2)) / 2
    return np.stack([W[:, 2, 1], W[:, 0, 2], W[:, 1, 0]], axis=1)


def in_own_axes(T: Array, velocity: Array, acceleration: Array) -> tuple[Array, Array]:
    """Velocity and spatial acceleration of a frame in its own axes, as Pinocchio's free joint has them.

    The spatial linear acceleration is not that of the origin: a_lin = R^T p'' - w x v_lin (Featherstone,
    Rigid Body Dynamics Algorithms, 2008, section 2.11).

    Args:
        T: `(n, 4, 4)` poses in the world.
        velocity: `(n, 6)` of the origin, then angular, world axes [m/s, rad/s].
        acceleration: `(n, 6)` of the origin, then angular, world axes [m/s^2, rad/s^2].
    """
    R = T[:, :3, :3]

    def own(x: Array) -> Array:
        return np.hstack([np.einsum("nji,nj->ni", R, part) for part in (x[:, :3], x[:, 3:])])

    v, a = own(velocity), own(acceleration)
    a[:, :3] -= np.cross(v[:, 3:], v[:, :3])
    return v, a

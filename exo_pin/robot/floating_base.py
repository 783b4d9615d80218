"""The floating base in q: from poses to position and quaternion and back, and quaternions of length 1."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait.quaternions import quaternions, rotations

FREE = 7
"""Numbers of a floating base in q: position [m], unit quaternion x, y, z, w (Pinocchio's order)."""

_UNIT, _NO_ATTITUDE = 1e-12, 1e-6  # of a quaternion: length 1 but for rounding; no direction is left


def base_coordinates(T: Array) -> Array:
    """The numbers `(n, 7)` of poses `(n, 4, 4)`, `(7,)` of one `(4, 4)`; w is never negative."""
    if T.ndim == 2:  # one pose of a control loop: Pinocchio takes 3 us, the arrays below 60 us
        q = np.asarray(pin.SE3ToXYZQUAT(pin.SE3(T)))
        q[3:] *= 1.0 if q[6] >= 0.0 else -1.0
        return q
    return np.hstack([T[:, :3, 3], np.roll(quaternions(T[:, :3, :3]), -1, axis=1)])


def base_poses(q: Array) -> Array:
    """The poses `(n, 4, 4)` of the first 7 numbers of configurations `(n, nq)`, `(4, 4)` of one `(nq,)`.

    Args:
        q: Position and quaternion of length 1 in front, as `unit_quaternion` leaves it.
    """
    if q.ndim == 1:
        return np.asarray(pin.XYZQUATToSE3(q[:FREE]).homogeneous)
    T = np.tile(np.eye(4), (len(q), 1, 1))
    T[:, :3, :3] = rotations(np.roll(q[:, 3:FREE], 1, axis=1))
    T[:, :3, 3] = q[:, :3]
    return T


def unit_quaternion(q: Array) -> Array:
    """Configurations `(..., nq)` whose quaternion has length 1: the same array where all have it already.

    Raises:
        DescriptionError: A quaternion is zero: it is no attitude.
    """
    length = np.linalg.norm(q[..., 3:FREE], axis=-1, keepdims=True)
    if (length < _NO_ATTITUDE).any():
        raise DescriptionError(
            "the quaternion of the floating base (q[3:7]: x y z w) is zero; 0 0 0 1 is upright"
        )
    if (np.abs(length - 1.0) <= _UNIT).all():
        return q
    return np.concatenate([q[..., :3], q[..., 3:FREE] / length, q[..., FREE:]], axis=-1)

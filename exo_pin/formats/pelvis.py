"""The pelvis of OpenSim (x forward, y up, z right) and ours (x forward, y left, z up)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

OURS = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
"""Takes a vector's OpenSim coordinates to ours."""


def from_opensim(angles: Array, translation: Array, mid_hip: ArrayLike) -> Array:
    """Poses of our pelvis, whose origin lies midway between the hips.

    Args:
        angles: `(n, 3)` tilt, list, rotation [rad]: turns about z, then x, then y of the turned pelvis.
        translation: `(n, 3)` origin of OpenSim's pelvis, OpenSim axes [m].
        mid_hip: `(3,)` where our origin lies in OpenSim's pelvis, OpenSim axes [m].

    Returns:
        `(n, 4, 4)` T_world_pelvis [m].
    """
    (ca, cb, cc), (sa, sb, sc) = np.cos(angles).T, np.sin(angles).T
    rows = [
        [ca * cc - sa * sb * sc, -sa * cb, ca * sc + sa * sb * cc],
        [sa * cc + ca * sb * sc, ca * cb, sa * sc - ca * sb * cc],
        [-cb * sc, sb, cb * cc],
    ]
    R = np.moveaxis(np.array(rows), -1, 0)  # Rz(tilt) Rx(list) Ry(rotation)
    base = np.tile(np.eye(4), (len(angles), 1, 1))
    base[:, :3, :3] = OURS @ R @ OURS.T
    base[:, :3, 3] = (translation + R @ np.asarray(mid_hip)) @ OURS.T
    return base


def to_opensim(base: Array, mid_hip: ArrayLike) -> tuple[Array, Array]:
    """The way back: `(n, 3)` tilt, list, rotation [rad], continuous in time, and `(n, 3)` translation [m]."""
    R = OURS.T @ base[:, :3, :3] @ OURS
    tilt = np.arctan2(-R[:, 0, 1], R[:, 1, 1])
    sideways = np.arctan2(R[:, 2, 1], np.hypot(R[:, 0, 1], R[:, 1, 1]))
    rotation = np.arctan2(-R[:, 2, 0], R[:, 2, 2])
    angles = np.unwrap(np.stack([tilt, sideways, rotation], axis=1), axis=0)
    return angles, base[:, :3, 3] @ OURS - R @ np.asarray(mid_hip)

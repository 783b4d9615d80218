"""Poses as columns: `<frame>_{x,y,z}_m` and the unit quaternion `<frame>_{qw,qx,qy,qz}`."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.formats.tables.numeric_table import NumericTable
from exo_pin.gait.quaternions import quaternions, rotations

_UNIT_LENGTH = 1e-6
"""How far a quaternion's length may lie from 1: six decimals, what careful files carry."""


def pose_names(frame: str) -> tuple[str, ...]:
    """The seven column names of a frame's pose."""
    return (*(f"{frame}_{axis}_m" for axis in "xyz"), *(f"{frame}_q{part}" for part in "wxyz"))


def pose_values(T: Array) -> Array:
    """`(n, 7)` position [m] and canonical unit quaternion (w, x, y, z; w >= 0) of `(n, 4, 4)` poses."""
    return np.hstack([T[:, :3, 3], quaternions(T[:, :3, :3])])


def read_poses(table: NumericTable, frame: str) -> Array:
    """`(n, 4, 4)` poses of the frame.

    Raises:
        FormatError: If a quaternion is not of unit length within 1e-6; the message names line and value.
    """
    values = table.columns(pose_names(frame))
    with np.errstate(over="ignore"):  # squares of absurd numbers: infinitely long is too long as well
        length = np.linalg.norm(values[:, 3:], axis=1)
    bad = np.zeros(values.shape, dtype=bool)
    bad[:, 3] = ~(np.abs(length - 1) <= _UNIT_LENGTH)
    table.refuse(
        bad, pose_names(frame), "its quaternion is not of length 1; expected qw, qx, qy, qz of a rotation"
    )
    T = np.tile(np.eye(4), (len(values), 1, 1))
    T[:, :3, :3] = rotations(values[:, 3:] / length[:, None])
    T[:, :3, 3] = values[:, :3]
    return T

"""Poses as columns: `<frame>_{x,y,z}_m` and the unit quaternion `<frame>_{qw,qx,qy,qz}`."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.formats.tables.numeric_table import NumericTable

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


def rotations(quaternion: Array) -> Array:
    """`(n, 3, 3)` rotation matrices of `(n, 4)` unit quaternions w, x, y, z."""
    w, x, y, z = quaternion.T
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def quaternions(R: Array) -> Array:
    """`(n, 4)` unit quaternions w, x, y, z of `(n, 3, 3)` rotations, the first part that is not 0 positive.

    Shepperd, J. Guidance and Control 1 (1978) 223-224: divide by the largest part, so nothing cancels.
    """
    trace = np.trace(R, axis1=1, axis2=2)
    w, x, y, z = trace, R[:, 0, 0], R[:, 1, 1], R[:, 2, 2]
    products = np.empty((len(R), 4, 4))  # four times the products of every two parts
    products[:, range(4), range(4)] = np.stack([1 + w, 1 + 2 * x - w, 1 + 2 * y - w, 1 + 2 * z - w], axis=1)
    for i, j, value in (
        (0, 1, R[:, 2, 1] - R[:, 1, 2]),
        (0, 2, R[:, 0, 2] - R[:, 2, 0]),
        (0, 3, R[:, 1, 0] - R[:, 0, 1]),
        (1, 2, R[:, 1, 0] + R[:, 0, 1]),
        (1, 3, R[:, 0, 2] + R[:, 2, 0]),
        (2, 3, R[:, 2, 1] + R[:, 1, 2]),
    ):
        products[:, i, j] = products[:, j, i] = value
    largest = np.stack([w, x, y, z], axis=1).argmax(axis=1)
    q = products[np.arange(len(R)), largest]
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    leading = q[np.arange(len(R)), (q != 0).argmax(axis=1)]
    return np.asarray(q * np.sign(leading)[:, None]) + 0.0  # + 0.0: no negative zeros in files

"""Unit quaternions w, x, y, z from rotation matrices and back."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array


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

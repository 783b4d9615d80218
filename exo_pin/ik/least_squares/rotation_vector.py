"""The rotation vector between two orientations, and the curvature of its square.

The rotation vector (axis times angle, the logarithm of a rotation) is the rotation error of a target. Samples
stand on the last axis.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pinocchio as pin

from exo_pin.arrays import Array, Index

_Rotation = Array | Sequence[Sequence[Array | float]]  # `R[i][j]` is an array (m,) or a number


def rotation_vector(R: _Rotation, S: _Rotation) -> Array:
    """The rotation vectors (3, m) in world axes that carry R to S, each given entry by entry."""
    v = np.zeros((3, *np.shape(S[0][0])))
    for i in range(3):
        a, b = (i + 1) % 3, (i + 2) % 3
        for c in range(3):
            v[i] += R[a][c] * S[b][c] - R[b][c] * S[a][c]
    v *= 0.5
    cosine = 0.5 * (sum(R[i][j] * S[i][j] for i in range(3) for j in range(3)) - 1.0)
    sine = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    angle = np.arctan2(sine, cosine)
    with np.errstate(divide="ignore", invalid="ignore"):
        v *= np.where(sine > 1e-9, angle / sine, 1.0)
    back = np.flatnonzero((cosine < -0.999) & (sine < 0.05))
    if len(back):
        v[:, back] = _near_half_turn(R, S, back)
    return v


def curvature_factor(angle: npt.ArrayLike) -> Array:
    """The factor k = (1 - |t|/2 cot |t|/2) / |t|^2 of rotation vectors t by their angles |t| [rad].

    It stands in the inverse Jacobian of the rotation vector, I + [t]x / 2 + k [t]x [t]x, and is 1/12 for
    small angles.
    """
    half = 0.5 * np.maximum(angle, 1e-4)
    return np.asarray((1.0 - half / np.tan(half)) / (4.0 * half * half))


def _near_half_turn(R: _Rotation, S: _Rotation, where: Index) -> Array:
    """Rotation vectors of nearly 180 degrees, where the skew part of the rotation vanishes.

    They are rare, so that one sample at a time is quick enough.
    """
    A = np.array([[np.broadcast_to(x, np.shape(S[0][0]))[where] for x in row] for row in R])
    B = np.array([[np.asarray(x)[where] for x in row] for row in S])
    return np.stack([pin.log3(B[:, :, k] @ A[:, :, k].T) for k in range(len(where))], axis=1)

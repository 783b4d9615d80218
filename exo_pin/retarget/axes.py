"""Rotations as angles about given axes: a person's hip and ankle on a robot's joints in any order."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait.rigid_poses import about

_LEAST_VOLUME = 0.1
"""Three axes with a smaller triple product are nearly coplanar: they do not make a hip."""

SIGNED_AXES = ("x", "-x", "y", "-y", "z", "-z")


def unit_vector(name: str) -> Array:
    """The unit vector `(3,)` of one of `SIGNED_AXES`."""
    v = np.zeros(3)
    v["xyz".index(name[-1])] = -1.0 if name.startswith("-") else 1.0
    return v


def nearest_axis(v: npt.ArrayLike) -> str:
    """The one of `SIGNED_AXES` that a vector `(3,)` is nearest to."""
    v = np.asarray(v, dtype=float)
    k = int(np.argmax(np.abs(v)))
    return ("-" if v[k] < 0 else "") + "xyz"[k]


def angles_about(axes: npt.ArrayLike, R: npt.ArrayLike) -> Array:
    """Angles about successive axes that compose a rotation: R = exp(a1 q1) exp(a2 q2) exp(a3 q3).

    Fewer than three axes are completed by perpendicular ones, whose angles are dropped: such joints make a
    part of the rotation only. (Paden and Kahan's second subproblem, see Murray, Li, Sastry 1994, section 3.3;
    of its two solutions the one that is zero at R = 1.)

    Args:
        axes: One to three unit vectors (k, 3), each seen at zero angles.
        R: Rotations (n, 3, 3).

    Returns:
        Angles (n, k) [rad]; of a nearby rotation where oblique axes cannot compose the given one.

    Raises:
        DescriptionError: The three axes are coplanar.
    """
    own = np.asarray(axes, dtype=float)
    a, b, c = _completed(own)
    R = np.asarray(R, dtype=float)
    end = R @ c
    normal, cosine = np.cross(a, b), float(a @ b)
    on_b, on_a = float(b @ c), end @ a
    alpha = (cosine * on_b - on_a) / (cosine**2 - 1.0)
    beta = (cosine * on_a - on_b) / (cosine**2 - 1.0)
    rest = 1.0 - alpha**2 - beta**2 - 2.0 * alpha * beta * cosine
    gamma = np.sign(c @ normal) * np.sqrt(np.maximum(rest, 0.0) / (normal @ normal))
    middle = alpha[:, None] * a + beta[:, None] * b + gamma[:, None] * normal
    second = _angle(b, np.broadcast_to(c, middle.shape), middle)
    first = _angle(a, middle, end)
    left = np.swapaxes(about(b, second), -1, -2) @ np.swapaxes(about(a, first), -1, -2) @ R
    across = np.cross(c, a if abs(a @ c) < 0.9 else b)
    third = _angle(c, np.broadcast_to(across, middle.shape), left @ across)
    return np.stack([first, second, third], axis=-1)[:, : len(own)]


def _completed(axes: Array) -> tuple[Array, Array, Array]:
    """Three axes: missing ones are appended, perpendicular to the others."""
    rows = list(axes)
    if len(rows) == 1:
        unit = np.eye(3)[int(np.argmin(np.abs(rows[0])))]
        across = unit - (unit @ rows[0]) * rows[0]
        rows.append(across / np.linalg.norm(across))
    if len(rows) == 2:
        across = np.cross(rows[0], rows[1])
        rows.append(across / max(float(np.linalg.norm(across)), _LEAST_VOLUME))
    if abs(np.linalg.det(rows)) < _LEAST_VOLUME:
        raise DescriptionError("the axes of a hip or ankle lie nearly in a plane")
    return rows[0], rows[1], rows[2]


def _angle(axis: Array, start: Array, end: Array) -> Array:
    """Angles (n,) about an axis from vectors (n, 3) to others, projected along the axis."""
    start = start - (start @ axis)[:, None] * axis
    end = end - (end @ axis)[:, None] * axis
    return np.asarray(np.arctan2(np.cross(start, end) @ axis, np.einsum("ni,ni->n", start, end)))

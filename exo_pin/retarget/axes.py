"""Rotations as turns about given axes: a person's hip and ankle on a robot's axes, whatever their order."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait.rigid import about

FLAT = 0.1
"""Three axes whose triple product is smaller than this lie nearly in a plane: they do not make a hip."""

SIGNED = ("x", "-x", "y", "-y", "z", "-z")


def direction(name: str) -> Array:
    """The unit vector `(3,)` of one of `SIGNED`."""
    v = np.zeros(3)
    v["xyz".index(name[-1])] = -1.0 if name.startswith("-") else 1.0
    return v


def named(v: npt.ArrayLike) -> str:
    """The one of `SIGNED` that a direction `(3,)` is nearest to."""
    v = np.asarray(v, dtype=float)
    k = int(np.argmax(np.abs(v)))
    return ("-" if v[k] < 0 else "") + "xyz"[k]


def turns(axes: npt.ArrayLike, R: npt.ArrayLike) -> Array:
    """Angles about axes, one after the other, that make a rotation: R = exp(a1 q1) exp(a2 q2) exp(a3 q3).

    Axes that are missing to three are added behind, each square to the others, and their angles left away:
    what remains of the rotation is what such joints can do of it. (Paden and Kahan's second subproblem, see
    Murray, Li, Sastry 1994, section 3.3; of its two answers the one near zero at R = 1.)

    Args:
        axes: One to three unit vectors (k, 3), each seen at zero angles.
        R: Rotations (n, 3, 3).

    Returns:
        Angles (n, k) [rad]. A rotation out of the axes' reach (only if they are oblique) gets a near one.

    Raises:
        DescriptionError: Three axes lie in a plane.
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
    """Three axes: those that are missing added behind, square to the others."""
    rows = list(axes)
    if len(rows) == 1:
        unit = np.eye(3)[int(np.argmin(np.abs(rows[0])))]
        across = unit - (unit @ rows[0]) * rows[0]
        rows.append(across / np.linalg.norm(across))
    if len(rows) == 2:
        across = np.cross(rows[0], rows[1])
        rows.append(across / max(float(np.linalg.norm(across)), FLAT))
    if abs(np.linalg.det(rows)) < FLAT:
        raise DescriptionError("the axes of a hip or ankle lie nearly in a plane")
    return rows[0], rows[1], rows[2]


def _angle(axis: Array, start: Array, end: Array) -> Array:
    """Angles (n,) about an axis that bring vectors (n, 3) to others, as seen along the axis."""
    start = start - (start @ axis)[:, None] * axis
    end = end - (end @ axis)[:, None] * axis
    return np.asarray(np.arctan2(np.cross(start, end) @ axis, np.einsum("ni,ni->n", start, end)))

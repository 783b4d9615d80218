"""Forward kinematics, Jacobian and reach of a leg, for many samples at once: the check of every answer.

Numbers are kept component by component, `x[i][j]` an array over the samples, so that NumPy works on long
contiguous rows. Nothing here knows how the closed form is derived; tests compare it with Pinocchio.
"""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from exo_pin.arrays import Array
from exo_pin.robot.leg_axes import LegAxes

Number = Array | float
Matrix = list[list[Number]]
_ZERO = 1e-15  # an entry of a constant this small is rounding of zero (lengths in m, unit vectors)
_IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


class Tip(NamedTuple):
    """Poses of the leg's frame: rotation `R[i][j]` and position `p[i]`, each an array (m,)."""

    R: Matrix
    p: list[Number]


def sine_cosine(q: Array) -> tuple[Array, Array]:
    """Sine and cosine by the tangent of half the angle, one call instead of two."""
    t = np.tan(0.5 * q)
    square = t * t
    share = 1.0 / (1.0 + square)
    return 2.0 * t * share, (1.0 - square) * share


def pose(leg: LegAxes, q: Array) -> Tip:
    """Poses of the leg's frame in the world for joint angles (6, m), the robot at its own placement."""
    s, c = sine_cosine(q)
    R, p = _IDENTITY, _row(leg.points[0])
    for j in range(len(q)):
        if j:
            p = _plus(p, _rotated(R, leg.points[j] - leg.points[j - 1]))
        R = _then_about(R, leg.axes[j], s[j], c[j])
    p = _plus(p, _rotated(R, leg.tip[:3, 3] - leg.points[-1]))
    return Tip(times(R, leg.tip[:3, :3]), p)


def pose_and_jacobian(leg: LegAxes, q: Array) -> tuple[Tip, Array]:
    """The poses and the Jacobian (6, 6, m): linear, then angular, in world axes."""
    s, c = sine_cosine(q)
    R, p = _IDENTITY, _row(leg.points[0])
    axes, points = [], []
    for j in range(len(q)):
        if j:
            p = _plus(p, _rotated(R, leg.points[j] - leg.points[j - 1]))
        points.append(p)
        axes.append(_rotated(R, leg.axes[j]))
        R = _then_about(R, leg.axes[j], s[j], c[j])
    p = _plus(p, _rotated(R, leg.tip[:3, 3] - leg.points[-1]))
    J = np.empty((6, *q.shape))
    for j, (axis, point) in enumerate(zip(axes, points, strict=True)):
        arm = [p[i] - point[i] for i in range(3)]
        for i in range(3):
            a, b = (i + 1) % 3, (i + 2) % 3
            J[i, j] = axis[a] * arm[b] - axis[b] * arm[a]
            J[3 + i, j] = axis[i]
    return Tip(times(R, leg.tip[:3, :3]), p), J


def errors(tip: Tip, R: Matrix, p: list[Number]) -> tuple[Array, Array]:
    """Distance [m] and angle [rad] between poses and targets, each (m,).

    The angle follows from the Frobenius norm, |R - S| = sqrt(8) sin(angle / 2), which loses no digits where
    the angle is small.

    Args:
        tip: Poses that were reached, m samples.
        R: Rotations of the targets, each entry (m,).
        p: Positions of the targets, each entry (m,) [m].
    """
    distance = np.sqrt(_squares([tip.p[i] - p[i] for i in range(3)]))
    chord = np.sqrt(_squares([tip.R[i][j] - R[i][j] for i in range(3) for j in range(3)]))
    return distance, 2.0 * np.arcsin(np.minimum(chord * (0.5 / np.sqrt(2.0)), 1.0))


def reach_slack(leg: LegAxes, R: Matrix, p: list[Number]) -> Array:
    """How far targets are inside the leg's reach (m,) [m]; negative where the leg is too short.

    Args:
        leg: The leg.
        R: Rotations of the targets, each entry (m,).
        p: Positions of the targets, each entry (m,) [m].

    Returns:
        Reach minus distance from the hip centre to the ankle of the target pose.
    """
    ankle = [float(x) for x in leg.ankle_in_frame]
    apart = [x - float(hip) + mix(row, ankle) for x, hip, row in zip(p, leg.hip, R, strict=True)]
    distance: Array = np.sqrt(_squares(apart))
    return leg.reach - distance


def components(R: Array, p: Array) -> tuple[Matrix, list[Number]]:
    """Rotations (m, 3, 3) and positions (m, 3) component by component."""
    return (
        [[np.ascontiguousarray(R[:, i, j], like=R) for j in range(3)] for i in range(3)],
        [np.ascontiguousarray(p[:, i], like=p) for i in range(3)],
    )


def mix(values: list[Number], weights: list[float]) -> Number:
    """The sum of values with constant weights; zeros and ones cost nothing."""
    total: Number = 0.0
    for value, weight in zip(values, weights, strict=True):
        if abs(weight) <= _ZERO:
            continue
        term = value if weight == 1.0 else -value if weight == -1.0 else weight * value
        total = term if isinstance(total, float) and total == 0.0 else total + term
    return total


def transposed(A: Matrix) -> Matrix:
    """Rows for columns."""
    return [list(column) for column in zip(*A, strict=True)]


def times(A: Matrix, B: Array) -> Matrix:
    """Product of a variable matrix with a constant one (3, 3)."""
    columns = [[float(x) for x in column] for column in np.asarray(B).T]
    return [[mix(row, column) for column in columns] for row in A]


def _row(values: Array) -> list[Number]:
    return [float(x) for x in values]


def _rotated(R: Matrix, b: Array) -> list[Number]:
    weights = [float(x) for x in b]
    return [mix(row, weights) for row in R]


def _plus(a: list[Number], b: list[Number]) -> list[Number]:
    return [x if isinstance(y, float) and y == 0.0 else x + y for x, y in zip(a, b, strict=True)]


def _then_about(R: Matrix, axis: Array, s: Array, c: Array) -> Matrix:
    """R times the rotation about an axis; only two columns change where that is a coordinate axis."""
    x = [float(v) for v in axis]
    k = max(range(3), key=lambda i: abs(x[i]))
    a, b = (k + 1) % 3, (k + 2) % 3
    if abs(abs(x[k]) - 1.0) > _ZERO or abs(x[a]) > _ZERO or abs(x[b]) > _ZERO:
        return _rodrigues(R, axis, s, c)
    if x[k] < 0:
        a, b = b, a
    minus = -s
    out = [list(row) for row in R]
    for row, old in zip(out, R, strict=True):
        row[a] = _dot2(old[a], c, old[b], s)
        row[b] = _dot2(old[b], c, old[a], minus)
    return out


def _rodrigues(R: Matrix, axis: Array, s: Array, c: Array) -> Matrix:
    x, y, z = (float(v) for v in axis)
    d = 1.0 - c
    rotation: Matrix = [
        [c + d * (x * x), d * (x * y) - s * z, d * (x * z) + s * y],
        [d * (x * y) + s * z, c + d * (y * y), d * (y * z) - s * x],
        [d * (x * z) - s * y, d * (y * z) + s * x, c + d * (z * z)],
    ]
    if R is _IDENTITY:
        return rotation
    columns = list(zip(*rotation, strict=True))
    return [[_dot3(row, column) for column in columns] for row in R]


def _dot2(x: Number, a: Array, y: Number, b: Array) -> Number:
    """The sum of x a and y b, where x or y may be a plain 0 or 1."""
    if _is_zero(x):
        return 0.0 if _is_zero(y) else y * b
    total = x * a
    if not _is_zero(y):
        total += y * b
    return total


def _is_zero(x: Number) -> bool:
    return isinstance(x, float) and x == 0.0


def _dot3(a: list[Number], b: tuple[Number, ...]) -> Number:
    total = a[0] * b[0]
    total += a[1] * b[1]
    total += a[2] * b[2]
    return total


def _squares(parts: list[Number]) -> Array:
    total = cast("Array", parts[0] * parts[0])
    for part in parts[1:]:
        total += part * part
    return total

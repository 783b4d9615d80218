"""The closed form of a leg for many samples at once, and approximate seeds from it (docs/ik.md derives it).

In canonical axes the leg is R_hip Ry(knee + ankle) Rx(roll), straight down at zero:
1. the knee from the distance between hip and ankle (law of cosines);
2. the roll of the ankle from the hip as the foot sees it, folded into (-90, 90] degrees;
3. the ankle's pitch from the angle between that direction and the same seen from the shank; the component
   that remains keeps its sign (it is negative in about 7 % of all poses within human limits);
4. the three hip angles from the rotation that is left.
Each answer has to be checked by forward kinematics: a target out of reach gets the straight leg.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numpy as np

from exo_pin.arrays import Array, filled
from exo_pin.ik.leg.geometry import ClosedFormGeometry
from exo_pin.robot import LegAxes
from exo_pin.robot.leg_forward import Matrix, Number, Tip, errors, mix, pose, times, transposed

_CIRCLE = 2.0 * np.pi
_ROUNDS = 4  # of an approximate seed
_LEAST_FLEXION = 0.06  # of its knee [rad]: from a straight leg the iteration would only creep
STRAIGHT_COSINE = 1.0 - 1e-13
"""A knee whose cosine is above this is straight: the rounding of the target would bend it by 1e-7 rad, which
costs nothing in the pose until a hip joint on its limit is cut off. It is 2e-14 m of the leg's length."""


def angles(geometry: ClosedFormGeometry, R: Matrix, p: list[Number]) -> Array:
    """Joint angles (6, m) [rad] for targets of the leg's frame, neither checked nor within the limits.

    Args:
        geometry: Constants of the leg.
        R: Rotations of the targets, each entry (m,) (`forward.components`).
        p: Positions of the targets, each entry (m,) [m].
    """
    G = _canonical(geometry, R)
    v = _hip_to_ankle(geometry, G, p)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _angles(geometry, G, v)


def approximate_seed(leg: LegAxes, geometry: ClosedFormGeometry, R: Matrix, p: list[Number]) -> Array:
    """Joint angles (6, m) [rad] near the solution of a leg whose axes are calibrated.

    The true leg misses the target by a motion that hardly changes with the angles, so the formula is
    evaluated again for the target moved by that error. Each round leaves about a 25th of the error for axes
    off by 2 degrees and 10 mm; damped least squares does the rest.

    Args:
        leg: The leg.
        geometry: Constants of the nearest closed form.
        R: Rotations of the targets, each entry (m,).
        p: Positions of the targets, each entry (m,) [m].

    Returns:
        The best of a few rounds; neither exact nor within the limits.
    """
    R_shifted, p_shifted = R, p
    first = cast("Array", p[0])
    best, least = np.empty((6, len(first)), like=first), filled(len(first), np.inf, like=first)
    for k in range(_ROUNDS):
        q = angles(geometry, R_shifted, p_shifted)
        tip = pose(leg, q)
        distance, angle = errors(tip, R, p)
        better = distance + angle < least
        best, least = np.where(better, q, best), np.where(better, distance + angle, least)
        if k + 1 < _ROUNDS:
            R_shifted, p_shifted = _moved(R, p, tip, R_shifted, p_shifted)
    knee = geometry.knee_sign * (best[3] - geometry.offset[3])
    best[3] = geometry.offset[3] + geometry.knee_sign * np.maximum(knee, _LEAST_FLEXION)
    return best


def _angles(geometry: ClosedFormGeometry, G: Matrix, v: list[Array]) -> Array:
    q = np.empty((6, len(v[0])), like=v[0])
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    scale = 0.5 / (geometry.thigh * geometry.shank)
    cos_k = square * scale - (geometry.lateral**2 + geometry.thigh**2 + geometry.shank**2) * scale
    np.maximum(cos_k, -1.0, out=cos_k)
    cos_k[cos_k > STRAIGHT_COSINE] = 1.0
    sin_k = np.sqrt((1.0 - cos_k) * (1.0 + cos_k))
    np.arccos(cos_k, out=q[3])
    if geometry.knee_sign < 0:
        sin_k, q[3] = -sin_k, -q[3]
    h = [-(v[0] * G[0][j] + v[1] * G[1][j] + v[2] * G[2][j]) for j in range(3)]
    q[5], sin_i, cos_i, g = _roll(geometry, h)
    q[4], sin_p, cos_p = _pitch(geometry, sin_k, cos_k, h[0], g)
    _hip(geometry, _remaining(geometry, G, (sin_i, cos_i), (sin_p, cos_p)), q)
    return _joint_angles(geometry, q)


def _canonical(geometry: ClosedFormGeometry, R: Matrix) -> Matrix:
    """Left R right; for a leg along the coordinate axes this only picks entries and signs."""
    S = transposed(times(transposed(R), geometry.left.T))
    return times(S, geometry.right)


def _hip_to_ankle(geometry: ClosedFormGeometry, G: Matrix, p: list[Number]) -> list[Array]:
    """The ankle as the hip sees it, in the axes of the hip."""
    apart: list[Number] = [p[j] - geometry.hip[j] for j in range(3)]
    hip = [mix(apart, [float(x) for x in row]) for row in geometry.left]
    foot = [mix(row, [float(x) for x in geometry.ankle]) for row in G]
    return [cast("Array", a + b) for a, b in zip(hip, foot, strict=True)]


def _roll(geometry: ClosedFormGeometry, h: list[Array]) -> tuple[Array, Array, Array, Array]:
    """Ankle roll, its sine and cosine, and what remains of the hip's direction along z."""
    rho = np.copysign(np.sqrt(h[1] * h[1] + h[2] * h[2]), h[2])
    roll = np.arctan(h[1] / h[2])
    if geometry.lateral == 0.0:
        return roll, h[1] / rho, h[2] / rho, rho
    roll -= np.arcsin(np.clip(-geometry.lateral / rho, -1.0, 1.0))
    rest = np.copysign(np.sqrt(np.maximum(rho * rho - geometry.lateral**2, 0.0)), rho)
    return roll, np.sin(roll), np.cos(roll), rest


def _pitch(
    geometry: ClosedFormGeometry, sin_k: Array, cos_k: Array, x: Array, z: Array
) -> tuple[Array, Array, Array]:
    """Ankle pitch, and sine and cosine of knee and pitch together."""
    w_x, w_z = -geometry.thigh * sin_k, geometry.shank + geometry.thigh * cos_k
    across, along = w_x * z - x * w_z, w_x * x + w_z * z
    share = 1.0 / np.sqrt(across * across + along * along)
    sin_a, cos_a = across * share, along * share
    return np.arctan2(across, along), sin_k * cos_a + cos_k * sin_a, cos_k * cos_a - sin_k * sin_a


def _remaining(
    geometry: ClosedFormGeometry, G: Matrix, roll: tuple[Array, Array], pitch: tuple[Array, Array]
) -> Callable[[int, int], Number]:
    """Entries of the hip's rotation: the target's with ankle roll and pitch undone."""
    columns = [[float(geometry.spread[c, j]) for c in range(3)] for j in range(3)]
    known: dict[tuple[int, int], Number] = {}

    def entry(i: int, c: int) -> Number:
        """Component i of column c of the thigh's axes."""
        if c == 1:
            return roll[1] * G[i][1] - roll[0] * G[i][2]
        if (i, 3) not in known:
            known[i, 3] = roll[0] * G[i][1] + roll[1] * G[i][2]
        z = known[i, 3]
        return pitch[1] * G[i][0] + pitch[0] * z if c == 0 else pitch[1] * z - pitch[0] * G[i][0]

    def at(i: int, j: int) -> Number:
        for c in range(3):
            if columns[j][c] != 0.0 and (i, c) not in known:
                known[i, c] = entry(i, c)
        return mix([known.get((i, c), 0.0) for c in range(3)], columns[j])

    return at


def _hip(geometry: ClosedFormGeometry, at: Callable[[int, int], Number], q: Array) -> None:
    """The three hip angles of Rx Ry Rz."""
    s, a, b = at(0, 2), at(1, 2), at(2, 2)
    np.arctan2(-a, b, out=q[0])
    if geometry.steep:
        np.arctan2(s, np.hypot(a, b), out=q[1])
    else:
        np.arcsin(np.clip(s, -1.0, 1.0), out=q[1])
    np.arctan2(-at(0, 1), at(0, 0), out=q[2])


def _joint_angles(geometry: ClosedFormGeometry, q: Array) -> Array:
    """Canonical angles as the joints count them."""
    for j in range(6):
        if geometry.sign[j] < 0:
            np.negative(q[j], out=q[j])
        if geometry.offset[j]:
            q[j] += geometry.offset[j]
    for j in geometry.wraps:
        q[j] -= _CIRCLE * np.round((q[j] - geometry.middle[j]) / _CIRCLE)
    return q


def _moved(
    R: Matrix, p: list[Number], tip: Tip, R_shifted: Matrix, p_shifted: list[Number]
) -> tuple[Matrix, list[Number]]:
    """The next shifted target: target times inverse of the pose reached times the present one."""
    back = transposed(tip.R)
    rotation = [[_dot(row, column) for column in zip(*R_shifted, strict=True)] for row in back]
    shift = [_dot(row, [a - b for a, b in zip(p_shifted, tip.p, strict=True)]) for row in back]
    R_next = [[_dot(row, column) for column in zip(*rotation, strict=True)] for row in R]
    return R_next, [x + _dot(row, shift) for x, row in zip(p, R, strict=True)]


def _dot(a: list[Number] | tuple[Number, ...], b: list[Number] | tuple[Number, ...]) -> Number:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

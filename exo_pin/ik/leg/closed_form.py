"""The closed form of a leg, for many samples at once (docs/ik.md derives it; `ideal` says when it holds).

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

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.leg.constants import IdealLeg
from exo_pin.ik.leg.forward import Matrix, Number, mix, times, transposed

_TURN = 2.0 * np.pi
STRAIGHT = 1.0 - 1e-13
"""A knee whose cosine is above this is straight: the rounding of the target would bend it by 1e-7 rad, which
costs nothing in the pose until a hip joint on its limit is cut off. It is 2e-14 m of the leg's length."""


def angles(leg: IdealLeg, R: Matrix, p: list[Number]) -> Array:
    """Joint angles (6, m) for targets of the leg's frame, component by component (`chain.components`)."""
    G = _canonical(leg, R)
    v = _hip_to_ankle(leg, G, p)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _angles(leg, G, v)


def _angles(leg: IdealLeg, G: Matrix, v: list[Array]) -> Array:
    q = np.empty((6, len(v[0])))
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    scale = 0.5 / (leg.thigh * leg.shank)
    cos_k = square * scale - (leg.lateral**2 + leg.thigh**2 + leg.shank**2) * scale
    np.maximum(cos_k, -1.0, out=cos_k)
    cos_k[cos_k > STRAIGHT] = 1.0
    sin_k = np.sqrt((1.0 - cos_k) * (1.0 + cos_k))
    np.arccos(cos_k, out=q[3])
    if leg.bend < 0:
        sin_k, q[3] = -sin_k, -q[3]
    h = [-(v[0] * G[0][j] + v[1] * G[1][j] + v[2] * G[2][j]) for j in range(3)]
    q[5], sin_i, cos_i, g = _roll(leg, h)
    q[4], sin_p, cos_p = _pitch(leg, sin_k, cos_k, h[0], g)
    _hip(leg, _remaining(leg, G, (sin_i, cos_i), (sin_p, cos_p)), q)
    return _joint_angles(leg, q)


def _canonical(leg: IdealLeg, R: Matrix) -> Matrix:
    """Left R right; where the leg stands along the axes this only picks entries and signs."""
    S = transposed(times(transposed(R), leg.left.T))
    return times(S, leg.right)


def _hip_to_ankle(leg: IdealLeg, G: Matrix, p: list[Number]) -> list[Array]:
    """The ankle as the hip sees it, in the axes of the hip."""
    apart: list[Number] = [p[j] - leg.hip[j] for j in range(3)]
    hip = [mix(apart, [float(x) for x in row]) for row in leg.left]
    foot = [mix(row, [float(x) for x in leg.ankle]) for row in G]
    return [np.asarray(a + b) for a, b in zip(hip, foot, strict=True)]


def _roll(leg: IdealLeg, h: list[Array]) -> tuple[Array, Array, Array, Array]:
    """Ankle roll, its sine and cosine, and what remains of the hip's direction along z."""
    rho = np.copysign(np.sqrt(h[1] * h[1] + h[2] * h[2]), h[2])
    roll = np.arctan(h[1] / h[2])
    if leg.lateral == 0.0:
        return roll, h[1] / rho, h[2] / rho, rho
    roll -= np.arcsin(np.clip(-leg.lateral / rho, -1.0, 1.0))
    rest = np.copysign(np.sqrt(np.maximum(rho * rho - leg.lateral**2, 0.0)), rho)
    return roll, np.sin(roll), np.cos(roll), rest


def _pitch(leg: IdealLeg, sin_k: Array, cos_k: Array, x: Array, z: Array) -> tuple[Array, Array, Array]:
    """Ankle pitch, and sine and cosine of knee and pitch together."""
    w_x, w_z = -leg.thigh * sin_k, leg.shank + leg.thigh * cos_k
    across, along = w_x * z - x * w_z, w_x * x + w_z * z
    share = 1.0 / np.sqrt(across * across + along * along)
    sin_a, cos_a = across * share, along * share
    return np.arctan2(across, along), sin_k * cos_a + cos_k * sin_a, cos_k * cos_a - sin_k * sin_a


def _remaining(
    leg: IdealLeg, G: Matrix, roll: tuple[Array, Array], pitch: tuple[Array, Array]
) -> Callable[[int, int], Number]:
    """Entries of the hip's rotation: what is left of the target when roll and pitch are taken off."""
    columns = [[float(leg.spread[c, j]) for c in range(3)] for j in range(3)]
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


def _hip(leg: IdealLeg, at: Callable[[int, int], Number], q: Array) -> None:
    """The three hip angles of Rx Ry Rz."""
    s, a, b = at(0, 2), at(1, 2), at(2, 2)
    np.arctan2(-a, b, out=q[0])
    if leg.steep:
        np.arctan2(s, np.hypot(a, b), out=q[1])
    else:
        np.arcsin(np.clip(s, -1.0, 1.0), out=q[1])
    np.arctan2(-at(0, 1), at(0, 0), out=q[2])


def _joint_angles(leg: IdealLeg, q: Array) -> Array:
    """Canonical angles as the joints count them."""
    for j in range(6):
        if leg.sign[j] < 0:
            np.negative(q[j], out=q[j])
        if leg.offset[j]:
            q[j] += leg.offset[j]
    for j in leg.wraps:
        q[j] -= _TURN * np.round((q[j] - leg.middle[j]) / _TURN)
    return q

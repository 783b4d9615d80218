"""The closed form of a leg for one sample, in plain `math`: an array of one costs ten times as much.

The same steps as `closed_form`, for legs whose axes are parallel to the coordinate axes; the others go
through `closed_form` as an array of one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import acos, asin, atan, atan2, copysign, sqrt

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.leg import closed_form
from exo_pin.ik.leg.closed_form import STRAIGHT_COSINE
from exo_pin.ik.leg.geometry import ClosedFormGeometry, approximate_geometry, exact_geometry
from exo_pin.robot import LegAxes
from exo_pin.robot.leg_forward import Matrix

Angles = tuple[float, float, float, float, float, float]
Formula = Callable[[Sequence[float]], Angles]
_HIPS = {(1, 0, 2): "z", (2, 0, 1): "y"}  # which thigh axes make the hip's columns 0, 1, 2


def exact_formula(leg: LegAxes) -> Formula | None:
    """The closed form of the leg within its limits, kept with the leg; None where it has none."""
    return leg.derived(_exact)


def approximate_formula(leg: LegAxes) -> Formula | None:
    """The closed form nearest to the leg, within its limits, kept with the leg; None where none is near."""
    return leg.derived(_approximate)


def _exact(leg: LegAxes) -> Formula | None:
    geometry = exact_geometry(leg)
    return None if geometry is None else formula(geometry, leg.lower, leg.upper)


def _approximate(leg: LegAxes) -> Formula | None:
    geometry = approximate_geometry(leg)
    return None if geometry is None else formula(geometry, leg.lower, leg.upper)


def formula(geometry: ClosedFormGeometry, lower: Array, upper: Array) -> Formula:
    """A function from the 16 numbers of a target pose, row by row, to the joint angles within limits.

    Args:
        geometry: Constants of the leg.
        lower: Lower joint limits (6,) [rad].
        upper: Upper joint limits (6,) [rad].
    """
    order = tuple(int(np.argmax(np.abs(geometry.spread[:, j]))) for j in range(3))
    along_axes = all(_signed_permutation(x) for x in (geometry.left, geometry.right, geometry.spread))
    plain = geometry.lateral == 0.0 and not (geometry.wraps or geometry.steep or geometry.ankle[:2].any())
    if along_axes and plain and order in _HIPS:
        return _straight_line(geometry, lower.tolist(), upper.tolist(), third=_HIPS[order])
    return _by_arrays(geometry, lower, upper)


def _signed_permutation(rotation: Array) -> bool:
    return bool((np.sort(np.abs(rotation), axis=1) == [0.0, 0.0, 1.0]).all())


def _by_arrays(geometry: ClosedFormGeometry, lower: Array, upper: Array) -> Formula:
    def angles(T: Sequence[float]) -> Angles:
        R: Matrix = [[np.array([T[4 * i + j]]) for j in range(3)] for i in range(3)]
        q = closed_form.angles(geometry, R, [np.array([T[4 * i + 3]]) for i in range(3)])
        a, b, c, d, e, f = np.clip(q[:, 0], lower, upper).tolist()
        return a, b, c, d, e, f

    return angles


def _straight_line(
    geometry: ClosedFormGeometry, lower: list[float], upper: list[float], *, third: str
) -> Formula:
    """The formula with the leg's constants bound; `third`: the thigh's axis that is the third hip axis."""
    row = [int(np.argmax(np.abs(x))) for x in geometry.left]
    column = [int(np.argmax(np.abs(x))) for x in geometry.right.T]
    places = [4 * i + j for i in row for j in column]
    s00, s01, s02, s10, s11, s12, s20, s21, s22 = (
        float(geometry.left[i, row[i]] * geometry.right[column[j], j]) for i in range(3) for j in range(3)
    )
    k00, k01, k02, k10, k11, k12, k20, k21, k22 = places
    t0, t1, t2 = (4 * i + 3 for i in row)
    u0, u1, u2 = (float(geometry.left[i, row[i]]) for i in range(3))
    h0, h1, h2 = (float(geometry.hip[i]) for i in row)
    drop = float(geometry.ankle[2])
    scale = 0.5 / (geometry.thigh * geometry.shank)
    shift = (geometry.thigh**2 + geometry.shank**2) * scale
    thigh, shank, bend = geometry.thigh, geometry.shank, geometry.knee_sign
    m0, m1, m2 = (float(geometry.spread[:, j].sum()) for j in range(3))
    f0, f1, f2, f3, f4, f5 = geometry.sign
    (l0, l1, l2, l3, l4, l5), (g0, g1, g2, g3, g4, g5) = lower, upper
    by_z = third == "z"
    straight = STRAIGHT_COSINE

    def angles(T: Sequence[float]) -> Angles:
        x0, y0, z0 = s00 * T[k00], s01 * T[k01], s02 * T[k02]
        x1, y1, z1 = s10 * T[k10], s11 * T[k11], s12 * T[k12]
        x2, y2, z2 = s20 * T[k20], s21 * T[k21], s22 * T[k22]
        v0 = u0 * (T[t0] - h0) + drop * z0
        v1 = u1 * (T[t1] - h1) + drop * z1
        v2 = u2 * (T[t2] - h2) + drop * z2
        ck = (v0 * v0 + v1 * v1 + v2 * v2) * scale - shift
        ck = 1.0 if ck > straight else -1.0 if ck < -1.0 else ck
        sk = bend * sqrt((1.0 - ck) * (1.0 + ck))
        hx = -(v0 * x0 + v1 * x1 + v2 * x2)
        hy = -(v0 * y0 + v1 * y1 + v2 * y2)
        hz = -(v0 * z0 + v1 * z1 + v2 * z2)
        g = copysign(sqrt(hy * hy + hz * hz), hz) or 1e-300
        si, ci = hy / g, hz / g
        wx, wz = -thigh * sk, shank + thigh * ck
        across, along = wx * g - hx * wz, wx * hx + wz * g
        n = 1.0 / (sqrt(across * across + along * along) or 1e-300)
        sa, ca = across * n, along * n
        sp, cp = sk * ca + ck * sa, ck * ca - sk * sa
        b0 = si * y0 + ci * z0
        if by_z:
            b1, b2 = si * y1 + ci * z1, si * y2 + ci * z2
            e0 = m2 * (cp * b0 - sp * x0)
            e1 = m2 * (cp * b1 - sp * x1)
            e2 = m2 * (cp * b2 - sp * x2)
            c0 = m0 * (ci * y0 - si * z0)
        else:
            e0, e1, e2 = m2 * (ci * y0 - si * z0), m2 * (ci * y1 - si * z1), m2 * (ci * y2 - si * z2)
            c0 = m0 * (cp * b0 - sp * x0)
        a0 = f0 * atan2(-e1, e2)
        a1 = f1 * asin(1.0 if e0 > 1.0 else -1.0 if e0 < -1.0 else e0)
        a2 = f2 * atan2(-m1 * (cp * x0 + sp * b0), c0)
        a3 = f3 * bend * acos(ck)
        a4 = f4 * atan2(across, along)
        a5 = f5 * (atan(hy / hz) if hz else copysign(1.5707963267948966, hy))
        if (
            l0 <= a0 <= g0
            and l1 <= a1 <= g1
            and l2 <= a2 <= g2
            and l3 <= a3 <= g3
            and l4 <= a4 <= g4
            and l5 <= a5 <= g5
        ):
            return a0, a1, a2, a3, a4, a5
        return _within((a0, a1, a2, a3, a4, a5), lower, upper)

    return angles


def _within(q: Angles, lower: list[float], upper: list[float]) -> Angles:
    a, b, c, d, e, f = (min(max(x, low), high) for x, low, high in zip(q, lower, upper, strict=True))
    return a, b, c, d, e, f

"""Geometry of the closed form: when a leg has one, and its lengths, centres and offsets.

Conditions: the three hip axes meet in one point, neighbours at right angles; the knee's axis is parallel to
the ankle's first; the two ankle axes meet at right angles; and the limits leave one branch: the knee bends to
one side, the middle of the hip's second and of the ankle's second joint is less than 90 degrees from where
the formula folds. Everything is read from the leg's own axes; docs/ik.md derives the formula.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array
from exo_pin.robot.leg_axes import LegAxes

_EXACT = 1e-9  # how exactly axes must meet [m] or be parallel or at right angles [sine]
_APPROXIMATE = 0.2  # the same for a leg whose approximate closed form is a seed [m, sine]
_ARCSINE = math.radians(80.0)  # below this the arc sine of a hip angle is as exact as the arc tangent


@dataclass(frozen=True, eq=False)
class ClosedFormGeometry:
    """Constants of the closed form of a leg, `exo_pin.ik.leg.closed_form`.

    Attributes:
        left: Rotation (3, 3) from world axes to the hip's own (first axis, second axis, their normal).
        right: Rotation (3, 3) from the canonical axes of the foot (ankle axes along x and y) to its own.
        hip: Hip centre in the world (3,).
        ankle: Ankle centre in the canonical axes of the foot (3,).
        spread: Rotation (3, 3) between the canonical thigh and the frame of the third hip axis.
        thigh: Length [m].
        shank: Length [m].
        lateral: Distance of the hip from the ankle along the knee's axis [m].
        knee_sign: +1 or -1, the side to which the knee bends.
        sign: Sense of each joint (6,).
        offset: Angle of each joint where its canonical angle is zero (6,) [rad].
        middle: Middle of each joint's range (6,) [rad].
        wraps: Joints whose angle may leave (-180, 180] degrees before it is folded to the range.
        steep: Whether the second hip joint comes near +-90 degrees.
        complete: Whether the limits hold no other branch: there is no answer but the formula's.
    """

    left: Array
    right: Array
    hip: Array
    ankle: Array
    spread: Array
    thigh: float
    shank: float
    lateral: float
    knee_sign: float
    sign: tuple[float, ...]
    offset: tuple[float, ...]
    middle: tuple[float, ...]
    wraps: tuple[int, ...]
    steep: bool
    complete: bool


def exact_geometry(leg: LegAxes) -> ClosedFormGeometry | None:
    """The geometry of a leg that has a closed form, kept with the leg; None where it has none."""
    return leg.derived(_exact)


def approximate_geometry(leg: LegAxes) -> ClosedFormGeometry | None:
    """The geometry of the closed form nearest to the leg, a seed for a leg whose axes are calibrated.

    It is kept with the leg; None where the axes are too far from the conditions.
    """
    return leg.derived(_approximate)


def _exact(leg: LegAxes) -> ClosedFormGeometry | None:
    return _geometry(leg) if _deviation(leg) <= _EXACT else None


def _approximate(leg: LegAxes) -> ClosedFormGeometry | None:
    return _geometry(leg) if _deviation(leg) <= _APPROXIMATE else None


def _geometry(leg: LegAxes) -> ClosedFormGeometry | None:
    hip, ankle, a = leg.hip, leg.ankle, leg.axes
    y = a[3]
    to_knee, to_ankle = leg.points[3] - hip, ankle - leg.points[3]
    lateral = float((to_knee + to_ankle) @ y)
    down, shin = (v - (v @ y) * y for v in (to_knee, to_ankle))
    thigh, shank = float(np.linalg.norm(down)), float(np.linalg.norm(shin))
    if min(thigh, shank) < 1e-6:
        return None
    z = -down / thigh
    C = np.array([np.cross(y, z), y, z])  # rows: the canonical axes
    straight = _angle_about_y(C @ shin)
    roll = a[5] - (a[5] @ y) * y
    roll /= np.linalg.norm(roll)
    roll_sign = 1.0 if roll @ C[0] >= 0 else -1.0
    pitch = math.atan2(-roll_sign * float(roll @ z), roll_sign * float(roll @ C[0]))
    H, third_sign, third = _hip_frame(a)
    sign = (1.0, 1.0, third_sign, 1.0, 1.0 if a[4] @ y > 0 else -1.0, roll_sign)
    middle = 0.5 * (leg.lower + leg.upper)
    offset = (0.0, -third, 0.0, -straight, sign[4] * (straight - pitch), 0.0)
    right = leg.tip[:3, :3].T @ C.T @ _about_y(pitch)
    if not _one_branch(leg, offset):
        return None
    return ClosedFormGeometry(
        left=_clean(H.T),
        right=_clean(right),
        hip=hip,
        ankle=_clean(right.T @ leg.ankle_in_frame),
        spread=_clean(C @ H @ _about_y(third)),
        thigh=thigh,
        shank=shank,
        lateral=lateral if abs(lateral) > 1e-12 else 0.0,
        knee_sign=1.0 if middle[3] > offset[3] else -1.0,
        sign=sign,
        offset=tuple(0.0 if abs(x) < 1e-12 else x for x in offset),
        middle=tuple(float(x) for x in middle),
        wraps=tuple(
            j for j in range(6) if offset[j] or abs(leg.lower[j]) > math.pi or abs(leg.upper[j]) > math.pi
        ),
        steep=bool(max(abs(leg.lower[1] + third), abs(leg.upper[1] + third)) > _ARCSINE),
        complete=_complete(leg, offset),
    )


def _deviation(leg: LegAxes) -> float:
    """How far the axes are from meeting [m], being parallel and at right angles [sine]."""
    a, p = leg.axes, leg.points
    apart = [np.linalg.norm(np.cross(a[j], leg.hip - p[j])) for j in range(3)]
    apart += [np.linalg.norm(np.cross(a[j], leg.ankle - p[j])) for j in (4, 5)]
    apart += [abs(a[0] @ a[1]), abs(a[1] @ a[2]), abs(a[4] @ a[5]), np.linalg.norm(np.cross(a[3], a[4]))]
    return float(max(apart))


def _one_branch(leg: LegAxes, offset: tuple[float, ...]) -> bool:
    knee = sorted((float(leg.lower[3] - offset[3]), float(leg.upper[3] - offset[3])))
    middle = 0.5 * (leg.lower + leg.upper)
    one_side = max(knee[0], -knee[1]) > -1e-9 or abs(knee[0] + knee[1]) > 0.5 * (knee[1] - knee[0])
    folds = abs(middle[1] - offset[1]) < math.pi / 2 and abs(middle[5]) < math.pi / 2
    return bool(one_side and folds and np.isfinite(middle).all())


def _complete(leg: LegAxes, offset: tuple[float, ...]) -> bool:
    """Whether the limits leave no other branch at all, `_one_branch` being true."""
    knee = sorted((float(leg.lower[3] - offset[3]), float(leg.upper[3] - offset[3])))
    folds = [abs(limit[j] - offset[j]) for j in (1, 5) for limit in (leg.lower, leg.upper)]
    turns = (leg.upper - leg.lower).max() < 2.0 * math.pi  # no angle twice
    return bool(max(knee[0], -knee[1]) > -1e-9 and max(folds) < math.pi / 2 and turns)


def _hip_frame(a: Array) -> tuple[Array, float, float]:
    """Columns: first axis, second axis, normal; then sign and angle of the third axis in that frame."""
    second = a[1] - (a[1] @ a[0]) * a[0]
    second /= np.linalg.norm(second)
    H = np.stack([a[0], second, np.cross(a[0], second)], axis=1)
    third = H.T @ a[2]
    sign = 1.0 if third[2] >= 0 else -1.0
    return H, sign, math.atan2(sign * third[0], sign * third[2])


def _angle_about_y(shin: Array) -> float:
    """The angle of the rotation about y that takes -z to the shin."""
    return math.atan2(-shin[0], -shin[2])


def _about_y(angle: float) -> Array:
    s, c = math.sin(angle), math.cos(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _clean(values: Array) -> Array:
    """Rounding of 0 and +-1 taken out, so that the kernel can skip those entries."""
    whole = np.round(values)
    return np.where(np.abs(values - whole) < 1e-13, whole, values)

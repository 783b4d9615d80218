"""Craig's modified Denavit-Hartenberg table of each leg, for both hip orders."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy.body import Body
from exo_pin.anatomy.names import JOINTS, SIDES, HipOrder, Side
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.dh.leg_chain import chain, soles


class DHRow(NamedTuple):
    """A row of Craig's table: angles in rad, lengths in m; theta = q + offset."""

    joint: str
    alpha: float
    a: float
    offset: float
    d: float


_BASE_FRAMES = {
    ("clinical", "left"): ((0, -1, 0), (0, 0, -1), (1, 0, 0)),
    ("clinical", "right"): ((0, -1, 0), (0, 0, -1), (1, 0, 0)),
    ("yaw_roll_pitch", "left"): ((0, 1, 0), (1, 0, 0), (0, 0, -1)),
    ("yaw_roll_pitch", "right"): ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
}
"""Rotation of frame 0, at the hip centre, in the pelvis."""

_TABLES: dict[tuple[str, str], tuple[tuple[int, str, int, str], ...]] = {
    ("clinical", "left"): (
        (0, "", 0, ""),
        (-90, "", -90, ""),
        (90, "", 90, "thigh"),
        (-90, "", -90, ""),
        (180, "shank", 180, ""),
        (-90, "", 0, ""),
    ),
    ("clinical", "right"): (
        (0, "", 0, ""),
        (90, "", 90, ""),
        (90, "", -90, "-thigh"),
        (90, "", -90, ""),
        (180, "shank", 180, ""),
        (90, "", 0, ""),
    ),
    ("yaw_roll_pitch", "left"): (
        (0, "", 0, ""),
        (90, "", -90, ""),
        (90, "", 180, ""),
        (180, "thigh", 0, ""),
        (180, "shank", 0, ""),
        (90, "", 0, ""),
    ),
    ("yaw_roll_pitch", "right"): (
        (0, "", 0, ""),
        (90, "", 90, ""),
        (-90, "", 180, ""),
        (180, "thigh", 0, ""),
        (180, "shank", 0, ""),
        (-90, "", 0, ""),
    ),
}
"""alpha_{i-1} [deg], a_{i-1}, theta offset [deg], d of each row; lengths by the name of a leg's size."""


def table(body: Body, side: Side, *, hip_order: HipOrder = "clinical") -> list[DHRow]:
    """Craig's modified D-H table of one leg of this body; frame 0 lies at the hip centre.

    Args:
        body: Sizes of the exoskeleton.
        side: `"left"` or `"right"`.
        hip_order: Order of the hip joints.

    Raises:
        UnknownNameError: Side or hip order is unknown.
    """
    leg = body.leg(side)
    lengths = {"": 0.0, "thigh": leg.thigh, "-thigh": -leg.thigh, "shank": leg.shank}
    rows = zip(chain(hip_order), _TABLES[hip_order, side], strict=True)
    return [
        DHRow(f"{side}_{movement}", math.radians(alpha), lengths[a], math.radians(offset), lengths[d])
        for movement, (alpha, a, offset, d) in rows
    ]


def modified_dh(body: Body, q: npt.ArrayLike, *, hip_order: HipOrder = "clinical") -> dict[str, Array]:
    """Poses by Craig's table, relative to the pelvis.

    Args:
        body: Sizes of the exoskeleton.
        q: Joint angles (..., 12) [rad]: left, then right leg, each in the order of `chain(hip_order)`.
        hip_order: Order of the hip joints.

    Returns:
        T_pelvis_link (..., 4, 4) by joint name, and by `left_foot` and `right_foot` on the soles.

    Raises:
        DescriptionError: The shape of q does not fit, or an angle is not finite.
        UnknownNameError: The hip order is unknown.
    """
    q = real("q", q, (..., len(JOINTS)))
    poses: dict[str, Array] = {}
    for k, side in enumerate(SIDES):
        rows = table(body, side, hip_order=hip_order)
        raw = _product(body, side, rows, q[..., 6 * k : 6 * k + 6], hip_order)
        zero = _product(body, side, rows, np.zeros(6), hip_order)
        for row, T, T0, place in zip(rows, raw, zero, _places(body, side), strict=True):
            poses[row.joint] = T @ np.linalg.inv(T0) @ place  # from the D-H frame to one parallel at zero
    return poses | soles(body, poses)


def ends(body: Body, side: Side, *, hip_order: HipOrder = "clinical") -> tuple[Array, Array]:
    """The constant transforms before and behind the table: T_pelvis_0 and T_6_foot (4, 4), to the sole.

    Args:
        body: Sizes of the exoskeleton.
        side: `"left"` or `"right"`.
        hip_order: Order of the hip joints.
    """
    rows = table(body, side, hip_order=hip_order)
    last = _product(body, side, rows, np.zeros(6), hip_order)[-1]
    sole = _places(body, side)[-1].copy()
    sole[2, 3] -= body.leg(side).ankle_height
    return _base(body, side, hip_order), np.linalg.inv(last) @ sole


def _base(body: Body, side: Side, hip_order: HipOrder) -> Array:
    """T_pelvis_0: frame 0 lies at the hip centre."""
    T = np.eye(4)
    T[:3, :3] = _BASE_FRAMES[hip_order, side]
    T[1, 3] = (1 if side == "left" else -1) * body.hip_width / 2
    return T


def _product(body: Body, side: Side, rows: list[DHRow], q: Array, hip_order: HipOrder) -> list[Array]:
    """Poses of the D-H frames 1 to 6 in the pelvis."""
    T = _base(body, side, hip_order)
    poses = []
    for i, row in enumerate(rows):
        T = T @ _craig(row, q[..., i])
        poses.append(T)
    return poses


def _craig(row: DHRow, angle: Array) -> Array:
    """Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d), Craig, Introduction to Robotics, Eq. (3.6)."""
    theta = angle + row.offset
    ca, sa, ct, st = math.cos(row.alpha), math.sin(row.alpha), np.cos(theta), np.sin(theta)
    T = np.zeros((*theta.shape, 4, 4))
    T[..., 0, 0], T[..., 0, 1], T[..., 0, 3] = ct, -st, row.a
    T[..., 1, 0], T[..., 1, 1], T[..., 1, 2], T[..., 1, 3] = st * ca, ct * ca, -sa, -sa * row.d
    T[..., 2, 0], T[..., 2, 1], T[..., 2, 2], T[..., 2, 3] = st * sa, ct * sa, ca, ca * row.d
    T[..., 3, 3] = 1.0
    return T


def _places(body: Body, side: Side) -> list[Array]:
    """Where the six joints of a leg are at q = 0, as frames parallel to the pelvis."""
    leg = body.leg(side)
    y = (1 if side == "left" else -1) * body.hip_width / 2
    heights = [0.0, 0.0, 0.0, -leg.thigh, -leg.thigh - leg.shank, -leg.thigh - leg.shank]
    places = []
    for z in heights:
        place = np.eye(4)
        place[:3, 3] = 0.0, y, z
        places.append(place)
    return places

"""The witness: forward kinematics by hand in NumPy, twice, without Pinocchio and without the URDF.

1. `recursion`: the paper's Eq. (1) to (6) over its family tree of links, Rodrigues' formula for each joint.
2. `modified_dh`: Craig's modified Denavit-Hartenberg table of each leg.

Both know only a `Body` and the meaning of the joint names. All frames are parallel to the pelvis at q = 0.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy.body import Body
from exo_pin.anatomy.names import HIP_ORDERS, MOVEMENTS, SIDES
from exo_pin.errors import UnknownNameError

Array = npt.NDArray[np.float64]

RIGHT_AXES = {
    "hip_flexion": (0.0, -1.0, 0.0),
    "hip_adduction": (1.0, 0.0, 0.0),
    "hip_rotation": (0.0, 0.0, 1.0),
    "knee_flexion": (0.0, 1.0, 0.0),
    "ankle_dorsiflexion": (0.0, -1.0, 0.0),
    "ankle_inversion": (1.0, 0.0, 0.0),
}
"""Axis of each movement of the right leg; the left leg's x and z components are negated (mirror image)."""


class Link(NamedTuple):
    """A link of the family tree: `b_j` and `a_j` of the paper, in the mother's frame."""

    name: str
    mother: str
    offset: Array
    axis: Array


class Row(NamedTuple):
    """A row of Craig's table: angles in rad, lengths in m; theta = q + offset."""

    joint: str
    alpha: float
    a: float
    offset: float
    d: float


def chain(hip_order: str = "clinical") -> tuple[str, ...]:
    """The movements of a leg from the pelvis outwards.

    Raises:
        UnknownNameError: The hip order is unknown.
    """
    if hip_order not in HIP_ORDERS:
        raise UnknownNameError("hip order", hip_order, HIP_ORDERS)
    return (*HIP_ORDERS[hip_order], *MOVEMENTS[3:])


def tree(body: Body, hip_order: str = "clinical") -> list[Link]:
    """The paper's family tree: pelvis, then each leg's joints outwards; a joint's link bears its name."""
    links = []
    for side, s in zip(SIDES, (1.0, -1.0), strict=True):
        leg = body.leg(side)
        offsets = {
            0: (0.0, s * body.hip_width / 2, 0.0),
            3: (0.0, 0.0, -leg.thigh),
            4: (0.0, 0.0, -leg.shank),
        }
        mother = "pelvis"
        for i, movement in enumerate(chain(hip_order)):
            x, y, z = RIGHT_AXES[movement]
            axis = np.array([-s * x, y, -s * z])
            name = f"{side}_{movement}"
            links.append(Link(name, mother, np.array(offsets.get(i, (0.0, 0.0, 0.0))), axis))
            mother = name
    return links


def recursion(body: Body, q: npt.ArrayLike, *, hip_order: str = "clinical") -> dict[str, Array]:
    """Poses by the paper's recursion, relative to the pelvis.

    Args:
        body: Sizes of the exoskeleton.
        q: Joint angles (..., 12) [rad]: left, then right leg, each in the order of `chain(hip_order)`.
        hip_order: Order of the hip joints.

    Returns:
        T_pelvis_link (..., 4, 4) by joint name, and by `left_foot` and `right_foot` on the soles.
    """
    q = np.asarray(q, dtype=float)
    poses = {"pelvis": np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))}
    for column, link in enumerate(tree(body, hip_order)):
        poses[link.name] = poses[link.mother] @ _joint(link, q[..., column])  # Eq. 3
    del poses["pelvis"]
    return poses | _feet(body, poses)


def _joint(link: Link, angle: Array) -> Array:
    """Eq. 1: [e^(a^ q), b; 0, 1] with Rodrigues' I + a^ sin q + a^2 (1 - cos q); a^ is Eq. 2."""
    x, y, z = link.axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    T = np.zeros((*angle.shape, 4, 4))
    sin, cos = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    T[..., :3, :3] = np.eye(3) + skew * sin + skew @ skew * (1 - cos)
    T[..., :3, 3] = link.offset
    T[..., 3, 3] = 1.0
    return T


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


def table(body: Body, side: str, *, hip_order: str = "clinical") -> list[Row]:
    """Craig's modified D-H table of one leg of this body; frame 0 lies at the hip centre.

    Raises:
        UnknownNameError: Side or hip order is unknown.
    """
    leg = body.leg(side)
    lengths = {"": 0.0, "thigh": leg.thigh, "-thigh": -leg.thigh, "shank": leg.shank}
    rows = zip(chain(hip_order), _TABLES[hip_order, side], strict=True)
    return [
        Row(f"{side}_{movement}", math.radians(alpha), lengths[a], math.radians(offset), lengths[d])
        for movement, (alpha, a, offset, d) in rows
    ]


def modified_dh(body: Body, q: npt.ArrayLike, *, hip_order: str = "clinical") -> dict[str, Array]:
    """Poses by Craig's table; arguments and result as those of `recursion`."""
    q = np.asarray(q, dtype=float)
    poses: dict[str, Array] = {}
    for k, side in enumerate(SIDES):
        rows = table(body, side, hip_order=hip_order)
        raw = _product(body, side, rows, q[..., 6 * k : 6 * k + 6], hip_order)
        zero = _product(body, side, rows, np.zeros(6), hip_order)
        for row, T, T0, place in zip(rows, raw, zero, _places(body, side), strict=True):
            poses[row.joint] = T @ np.linalg.inv(T0) @ place  # from the D-H frame to one parallel at zero
    return poses | _feet(body, poses)


def _product(body: Body, side: str, rows: list[Row], q: Array, hip_order: str) -> list[Array]:
    """Poses of the D-H frames 1 to 6 in the pelvis."""
    T = np.eye(4)
    T[:3, :3] = _BASE_FRAMES[hip_order, side]
    T[1, 3] = (1 if side == "left" else -1) * body.hip_width / 2
    poses = []
    for i, row in enumerate(rows):
        T = T @ _craig(row, q[..., i])
        poses.append(T)
    return poses


def _craig(row: Row, angle: Array) -> Array:
    """Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d), Craig, Introduction to Robotics, Eq. (3.6)."""
    theta = angle + row.offset
    ca, sa, ct, st = math.cos(row.alpha), math.sin(row.alpha), np.cos(theta), np.sin(theta)
    T = np.zeros((*theta.shape, 4, 4))
    T[..., 0, 0], T[..., 0, 1], T[..., 0, 3] = ct, -st, row.a
    T[..., 1, 0], T[..., 1, 1], T[..., 1, 2], T[..., 1, 3] = st * ca, ct * ca, -sa, -sa * row.d
    T[..., 2, 0], T[..., 2, 1], T[..., 2, 2], T[..., 2, 3] = st * sa, ct * sa, ca, ca * row.d
    T[..., 3, 3] = 1.0
    return T


def _places(body: Body, side: str) -> list[Array]:
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


def _feet(body: Body, poses: dict[str, Array]) -> dict[str, Array]:
    """The frames on the soles, straight under the ankles."""
    feet = {}
    for side in SIDES:
        below = np.eye(4)
        below[2, 3] = -body.leg(side).ankle_height
        feet[f"{side}_foot"] = poses[f"{side}_{MOVEMENTS[-1]}"] @ below
    return feet

"""Recursive forward kinematics over a tree of links: the paper's Eq. (1) to (6), Rodrigues' formula."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from exo_pin.anatomy.body import Body
from exo_pin.anatomy.names import JOINTS, SIDES, HipOrder
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.dh.leg_chain import chain, soles
from exo_pin.short_repr import short_repr

_RIGHT_AXES = {
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

    def __repr__(self) -> str:
        return short_repr(self)


def tree(body: Body, hip_order: HipOrder = "clinical") -> list[Link]:
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
            x, y, z = _RIGHT_AXES[movement]
            axis = np.array([-s * x, y, -s * z])
            name = f"{side}_{movement}"
            links.append(Link(name, mother, np.array(offsets.get(i, (0.0, 0.0, 0.0))), axis))
            mother = name
    return links


def recursion(body: Body, q: npt.ArrayLike, *, hip_order: HipOrder = "clinical") -> dict[str, Array]:
    """Poses by the paper's recursion, relative to the pelvis.

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
    poses = {"pelvis": np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))}
    for column, link in enumerate(tree(body, hip_order)):
        poses[link.name] = poses[link.mother] @ joint_pose(link, q[..., column])  # Eq. 3
    del poses["pelvis"]
    return poses | soles(body, poses)


def joint_pose(link: Link, angle: Array) -> Array:
    """Eq. 1: [e^(a^ q), b; 0, 1] with Rodrigues' I + a^ sin q + a^2 (1 - cos q); a^ is Eq. 2."""
    x, y, z = link.axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    T = np.zeros((*angle.shape, 4, 4))
    sin, cos = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    T[..., :3, :3] = np.eye(3) + skew * sin + skew @ skew * (1 - cos)
    T[..., :3, 3] = link.offset
    T[..., 3, 3] = 1.0
    return T

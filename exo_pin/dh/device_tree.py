"""Reference kinematics of devices that lock some of the 12 joints, slide the pelvis or have toes."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from exo_pin.anatomy.body import Body
from exo_pin.anatomy.names import JOINTS, MOVEMENTS, SIDES, HipOrder, Side
from exo_pin.arguments import real, table, word
from exo_pin.arrays import Array
from exo_pin.dh.leg_chain import chain
from exo_pin.dh.recursion import recursion

Witness = Callable[..., dict[str, Array]]

_SLIDES = ("pelvis_forward", "pelvis_left", "pelvis_up")


def of_device(
    body: Body, angles: Mapping[str, Array], *, hip_order: HipOrder = "clinical", witness: Witness = recursion
) -> dict[str, Array]:
    """Poses of a device, from the stand that its slides move on (the pelvis, if it has none).

    Args:
        body: Sizes of the exoskeleton.
        angles: Values (...) by joint name [rad], slides [m]; a joint that is left out is locked at zero.
        hip_order: Order of the hip joints.
        witness: `recursion` or `modified_dh`.

    Returns:
        T_stand_link (..., 4, 4) by name of the joint that moves the link, and by `left_foot`, `right_foot`;
        slides are not among them.

    Raises:
        DescriptionError: Shapes differ, or a value is not finite.
        UnknownNameError: A joint or the hip order is unknown.
    """
    angles = _checked(angles)
    still = np.zeros(np.shape(next(iter(angles.values()), 0.0)))
    order = [f"{side}_{movement}" for side in SIDES for movement in chain(hip_order)]
    q = np.stack([angles.get(name, still) for name in order], axis=-1)
    poses = witness(body, q, hip_order=hip_order)
    for side in SIDES:
        toe = f"{side}_toe_dorsiflexion"
        if toe in angles:
            poses[toe] = poses[f"{side}_{MOVEMENTS[-1]}"] @ _toe(body, side, angles[toe])
    slid = np.tile(np.eye(4), (*still.shape, 1, 1))
    for axis, slide in enumerate(_SLIDES):
        slid[..., axis, 3] = angles.get(slide, still)
    return {name: slid @ T for name, T in poses.items()}


def _checked(angles: Mapping[str, Array]) -> dict[str, Array]:
    """Values by joint name, all of one shape."""
    found = {name: real(name, values) for name, values in table("angles", angles).items()}
    known = (*JOINTS, *_SLIDES, *(f"{side}_toe_dorsiflexion" for side in SIDES))
    for name, values in found.items():
        word("joint", name, known)
        real(name, values, next(iter(found.values())).shape)
    return found


def _toe(body: Body, side: Side, angle: Array) -> Array:
    """T_sole_toe: at the ball of the foot, on the sole; toes up is a turn about -y."""
    leg = body.leg(side)
    T = np.zeros((*np.shape(angle), 4, 4))
    T[..., 0, 0], T[..., 0, 2] = np.cos(angle), -np.sin(angle)
    T[..., 2, 0], T[..., 2, 2] = np.sin(angle), np.cos(angle)
    T[..., 1, 1] = T[..., 3, 3] = 1.0
    T[..., 0, 3], T[..., 2, 3] = leg.ball, -leg.ankle_height
    return T

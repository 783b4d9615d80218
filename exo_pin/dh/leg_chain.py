"""The leg as a serial chain: order of its joints, and the sole frame under the ankle."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy.body import Body
from exo_pin.anatomy.names import HIP_ORDERS, MOVEMENTS, SIDES, HipOrder
from exo_pin.arguments import word
from exo_pin.arrays import Array


def chain(hip_order: HipOrder = "clinical") -> tuple[str, ...]:
    """The movements of a leg from the pelvis outwards.

    Raises:
        UnknownNameError: The hip order is unknown.
    """
    return (*HIP_ORDERS[word("hip order", hip_order, HIP_ORDERS)], *MOVEMENTS[3:])


def soles(body: Body, poses: dict[str, Array]) -> dict[str, Array]:
    """The frames `left_foot` and `right_foot` on the soles, straight under the ankles."""
    feet = {}
    for side in SIDES:
        below = np.eye(4)
        below[2, 3] = -body.leg(side).ankle_height
        feet[f"{side}_foot"] = poses[f"{side}_{MOVEMENTS[-1]}"] @ below
    return feet

"""A gait's joints and a robot's: which columns, in which order, and the order of the hip's axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import HIP_ORDERS, JOINTS, SIDES
from exo_pin.anatomy.hip_cardan_angles import reorder
from exo_pin.anatomy.names import HipOrder
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError

_HIPS = HIP_ORDERS["clinical"]


def gait_columns(model: Any, joints: Sequence[str]) -> tuple[list[int], list[int]]:
    """The columns of `Gait.q` that a robot has, and where they stand in its q.

    Args:
        model: Pinocchio's model.
        joints: Names of the driven joints, the last ones of q.

    Raises:
        DescriptionError: The robot has one of the gait's joints neither moving nor locked.
    """
    for name in JOINTS:
        if name not in joints and not model.existFrame(name, pin.FrameType.FIXED_JOINT):
            raise DescriptionError(
                f"{model.name} has no joint {name!r}, which every exoskeleton of this package has; "
                "`exo_pin.retarget.retarget(gait, robot)` brings a walk to other robots (docs/robots.md)"
            )
    mine = [k for k, name in enumerate(JOINTS) if name in joints]
    first = model.nq - len(joints)
    return mine, [first + joints.index(JOINTS[k]) for k in mine]


def in_joint_order(joints: Sequence[str], values: Array, *, missing: float = 0.0) -> Array:
    """Values (..., J) of a robot's joints in the order of `JOINTS` (..., 12).

    Args:
        joints: Names of the robot's joints; those that are not in `JOINTS` are left out.
        values: One for each of them.
        missing: Stands for joints that the robot lacks.
    """
    out = np.full((*values.shape[:-1], len(JOINTS)), missing)
    for k, name in enumerate(joints):
        if name in JOINTS:
            out[..., JOINTS.index(name)] = values[..., k]
    return out


def in_hip_order(q: Array, *, source: HipOrder, target: HipOrder) -> Array:
    """Angles (n, 12) in the order of `JOINTS` with the hips converted from one order of axes to another."""
    if source == target:
        return q
    q = q.copy()
    for side in SIDES:
        hips = [JOINTS.index(f"{side}_{movement}") for movement in _HIPS]
        q[:, hips] = reorder(q[:, hips], side, source=source, target=target)
    return q

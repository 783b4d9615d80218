"""Weighted error of one sample's targets and its Jacobian, on Pinocchio."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.ik.targets import Goal
from exo_pin.robot import Subtree

WORLD_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
_SKEW = np.array([pin.skew(axis).ravel() for axis in np.eye(3)])
"""Takes vectors (m, 3) to their cross-product matrices (m, 9)."""


def residual(
    subtree: Subtree,
    data: Any,
    q: Array,
    goals: list[Goal],
    k: int,
    scale: tuple[float, float] = (1.0, 1.0),
) -> tuple[Array, Array, Array]:
    """Weighted error (m,) in world axes, its Jacobian (m, nv), and per frame distance and angle (2, F).

    Args:
        subtree: The joints.
        data: Pinocchio's data of the subtree's model; it holds the Jacobians afterwards.
        q: Configuration (nq,) of the subtree.
        goals: One for each frame of the subtree.
        k: The sample.
        scale: Factors of position errors [1/m] and rotation errors [1/rad].
    """
    pin.computeJointJacobians(subtree.model, data, q)
    parts, jacobians, errors = [], [], np.full((2, len(goals)), np.nan)
    for f, (index, goal) in enumerate(zip(subtree.ids, goals, strict=True)):
        M = pin.updateFramePlacement(subtree.model, data, index)
        J = pin.getFrameJacobian(subtree.model, data, index, WORLD_ALIGNED).reshape(6, -1)  # one joint: (6,)
        R = M.rotation
        e, J_points, errors[0, f] = _points(goal, k, R, M.translation, J)
        parts.append(scale[0] * e)
        jacobians.append(scale[0] * J_points)
        if goal.R is not None:
            rotation = pin.log3(goal.R[k] @ R.T)
            errors[1, f] = np.sqrt(rotation @ rotation)
            parts.append(scale[1] * goal.rotation_weight * rotation)
            jacobians.append(scale[1] * goal.rotation_weight * J[3:])
    return np.concatenate(parts), np.concatenate(jacobians), errors


def _points(goal: Goal, k: int, R: Array, origin: Array, J: Array) -> tuple[Array, Array, float]:
    """Weighted error (3m,) of a frame's m points, its Jacobian (3m, nv), and the largest distance."""
    if len(goal.local) == 1 and not goal.local.any():  # a pose or a position: the frame's own origin
        e, weight = goal.p[k, 0] - origin, goal.weight[k, 0]
        return weight * e, weight * J[:3], float(np.sqrt(e @ e)) if weight else 0.0
    arms, weight = goal.local @ R.T, goal.weight[k]
    e = goal.p[k] - origin - arms
    distance = np.sqrt(np.einsum("ij,ij->i", e, e))
    J_points = J[:3] - (arms @ _SKEW).reshape(-1, 3, 3) @ J[3:]  # a rotation w moves an arm's end by w x arm
    J_points *= weight[:, None, None]
    worst = float((distance * (weight > 0)).max())
    return (weight[:, None] * e).ravel(), J_points.reshape(-1, J.shape[1]), worst

"""The second derivative that Gauss-Newton steps leave out, for one sample; `pull` has it for many.

Where targets are met it vanishes. At a compromise it does not, and without it the steps only creep.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from exo_pin.arrays import Array
from exo_pin.ik.least_squares.cost import bow
from exo_pin.ik.least_squares.residual import WORLD_ALIGNED
from exo_pin.ik.targets import Goal
from exo_pin.robot import Subtree


def bend(subtree: Subtree, data: Any, goals: list[Goal], k: int, scale: tuple[float, float]) -> Array:
    """Half the Hessian of the sum of squares, less J^T J (nv, nv), where `residual` was just asked.

    The formulas stand in `exo_pin.ik.pull`; the subtree has a fixed base.
    """
    H = np.zeros((subtree.model.nv, subtree.model.nv))
    for index, goal in zip(subtree.ids, goals, strict=True):
        J = pin.getFrameJacobian(subtree.model, data, index, WORLD_ALIGNED).reshape(6, -1)
        M, spin = data.oMf[index], J[3:]
        across = np.zeros_like(spin)
        for point, target, weight in zip(goal.local, goal.p[k], goal.weight[k], strict=True):
            arm = M.rotation @ point
            force = (scale[0] * weight) ** 2 * (target - M.translation - arm)
            across -= pin.skew(force) @ (J[:3] - pin.skew(arm) @ spin)
        H -= _mirrored(spin.T @ across)
        if goal.R is not None:
            turn = pin.log3(goal.R[k] @ M.rotation.T)
            twist = pin.skew(turn) @ spin
            weight = (scale[1] * goal.rotation_weight) ** 2
            H -= weight * (bow(np.linalg.norm(turn)) * (twist.T @ twist) - 0.5 * _mirrored(spin.T @ twist))
    return H


def definite(A: Array, g: Array, rest: Array, down: Array, up: Array) -> tuple[Array, Array]:
    """The equations of a step with the whole second derivative, or those of Gauss-Newton.

    Joints pressed against their limits are left where they are, as in `batch_limb`.

    Args:
        A: The damped Gauss-Newton matrix (nv, nv).
        g: Half the negative gradient (nv,).
        rest: What `bend` says.
        down: How far a step may go down (nv,).
        up: How far it may go up.
    """
    free = ((down < 0.0) | (g > 0.0)) & ((up > 0.0) | (g < 0.0))
    block = np.outer(free, free)
    whole = np.where(block, A + rest, np.eye(len(g)))
    try:
        np.linalg.cholesky(whole)
    except np.linalg.LinAlgError:
        return A, g
    return whole, np.where(free, g, 0.0)


def _mirrored(A: Array) -> Array:
    upper = np.triu(A)
    return np.asarray(upper + np.triu(A, 1).T)

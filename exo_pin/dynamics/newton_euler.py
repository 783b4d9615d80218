"""Inverse dynamics sample by sample: Pinocchio's recursive Newton-Euler algorithm, wrenches at the feet."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import FEET
from exo_pin.arguments import real
from exo_pin.arrays import Array
from exo_pin.dynamics.base_motion import Motion
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot

_FREE = 6
"""Degrees of freedom of the pelvis, in front of the joints'."""


def generalized_forces(robot: Robot, motion: Motion, wrench: Array | None = None) -> Array:
    """What must act on the pelvis and in the joints for this motion, besides gravity and the ground.

    Args:
        robot: A floating robot.
        motion: Its motion, n samples.
        wrench: `(n, 2, 6)` of the ground on the feet, force first, about the world's origin, world axes
            [N, N m]; no ground if left out.

    Returns:
        `(n, nv)`: force and moment on the pelvis in its own axes, then the joint torques [N, N m].

    Raises:
        DescriptionError: `wrench` has another shape, or a number is not finite.
    """
    if wrench is not None:
        wrench = real("wrench", wrench, (len(motion.q), len(FEET), 6))
    model, data = robot.model, robot.model.createData()
    feet = [model.frames[robot.frame(foot)].parentJoint for foot in FEET]
    forces = pin.StdVec_Force([pin.Force.Zero() for _ in range(model.njoints)])
    tau = np.empty((len(motion.q), model.nv))
    for k, (q, v, a) in enumerate(zip(motion.q, motion.v, motion.a, strict=True)):
        if wrench is None:
            tau[k] = pin.rnea(model, data, q, v, a)
            continue
        pin.forwardKinematics(model, data, q)
        for foot, joint in enumerate(feet):
            forces[joint] = data.oMi[joint].actInv(pin.Force(wrench[k, foot]))
        tau[k] = pin.rnea(model, data, q, v, a, forces)
    return tau


def in_world_axes(base: Array, tau: Array) -> Array:
    """`(n, 6)` the part that acts on the pelvis, in world axes, its moment about mid-hip [N, N m].

    Args:
        base: `(n, 4, 4)` pose of the pelvis.
        tau: `(n, nv)` generalised forces, those of the pelvis first; NaN where unknown.

    Raises:
        DescriptionError: A shape differs, or a number is infinite.
    """
    base = real("base", base, ("n", 4, 4))
    tau = real("tau", tau, (len(base), "nv"), gaps=True)
    if tau.shape[1] < _FREE:
        raise DescriptionError(f"tau has shape {tau.shape}; ({len(base)}, 6 or more) is accepted")
    R = base[:, :3, :3]
    return np.hstack([np.einsum("nij,nj->ni", R, part) for part in (tau[:, :3], tau[:, 3:6])])

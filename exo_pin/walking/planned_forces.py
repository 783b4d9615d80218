"""Ground forces of a planned walk, and the joint torques under them: nothing holds the pelvis."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.dynamics import Dynamics, GroundForces, generalized_forces, in_world_axes, mass_of
from exo_pin.robot import Robot
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.walking.course import Course
from exo_pin.walking.whole_body import WholeBody

_FREE = 6
"""Degrees of freedom of the pelvis, in front of the joints'."""


def ground_forces(plan: Course, body: WholeBody) -> GroundForces:
    """What the ground does to the feet: all that the motion takes, each foot its share.

    Each foot's force acts at its anchor point; what the whole body's ZMP is off the line between these moves
    both points alike. So no moment is left over but that about the vertical, which the feet share as well.

    Args:
        plan: The course of the walk.
        body: The walk of the whole body.
    """
    force, moment = body.wrench[:, :3], body.wrench[:, 3:]
    point = plan.anchors.copy()
    between = np.einsum("nf,nfk->nk", plan.share, plan.anchors[..., :2])
    point[..., :2] += (body.zmp - between)[:, None]
    arm = np.append(body.zmp, np.zeros((len(force), 1)), axis=1) - body.motion.base[:, :3, 3]
    twist = moment[:, 2] - np.cross(arm, force)[:, 2]
    share = plan.share[..., None]
    free = np.zeros((*plan.share.shape, 3))
    free[..., 2] = plan.share * twist[:, None]
    return GroundForces(share * force[:, None], np.where(share > 0.0, point, np.nan), free)


def planned_dynamics(robot: Robot, plan: Course, body: WholeBody) -> Dynamics:
    """Joint torques of a planned walk under its own ground forces.

    Args:
        robot: The floating robot.
        plan: The course of the walk.
        body: The walk of the whole body.
    """
    ground = ground_forces(plan, body)
    tau = generalized_forces(robot, body.motion, ground.wrench)
    mass = mass_of(robot)
    return Dynamics(
        time=plan.time,
        torque=_by_joint(robot, tau),
        velocity=_by_joint(robot, body.motion.v),
        support_wrench=in_world_axes(body.motion.base, tau),
        ground=ground,
        valid=np.ones(len(plan.time), dtype=bool),
        reaction="planned",
        masses="both",
        mass=mass,
        body_weight_support=0.0,
        robot=robot,
        motion=body.motion,
        weight=None,
        source=f"inverse dynamics of a planned walk; ground reaction as planned; {mass:.1f} kg",
        remarks=(),
    )


def _by_joint(robot: Robot, values: Array) -> Array:
    return in_joint_order(robot.joints, values[:, _FREE:], missing=np.nan)

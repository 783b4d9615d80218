"""The whole body of a walk: joint angles under a pelvis that carries the centre of mass along its path.

The cart-table model leaves out that limbs swing. The dynamics filter (Kajita et al., Proc. ICRA 2003) makes
up for it: the ZMP error of the whole body goes through the same pendulum, and the pelvis moves by the
result.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import FEET, JOINTS
from exo_pin.arrays import Array
from exo_pin.dynamics import Motion, generalized_forces, in_world_axes, motion
from exo_pin.gait import Gait
from exo_pin.ik import ClosedForm, Track, track
from exo_pin.kinematics import center_of_mass
from exo_pin.robot import Robot
from exo_pin.walking.course import Course
from exo_pin.walking.pendulum import com_of_zmp, resting_zmp


class WholeBody(NamedTuple):
    """A walk of the whole body.

    Attributes:
        gait: Joint angles, pelvis and events.
        track: How the inverse kinematics met the feet.
        motion: Of the floating robot.
        wrench: `(n, 6)` that the ground must exert, its moment about mid-hip, world axes [N, N m].
        zmp: `(n, 2)` zero-moment point of this motion [m].
    """

    gait: Gait
    track: Track
    motion: Motion
    wrench: Array
    zmp: Array


def pelvis_poses(xy: Array, height: float, heading: Array) -> Array:
    """`(n, 4, 4)` an upright pelvis.

    Args:
        xy: `(n, 2)` of mid-hip [m].
        height: Of mid-hip above the ground [m].
        heading: `(n,)` counter-clockwise from x [rad].
    """
    T = np.tile(np.eye(4), (len(xy), 1, 1))
    T[:, 0, 0] = T[:, 1, 1] = np.cos(heading)
    T[:, 1, 0] = np.sin(heading)
    T[:, 0, 1] = -T[:, 1, 0]
    T[:, :2, 3], T[:, 2, 3] = xy, height
    return T


def moving_body(robot: Robot, floating: Robot, plan: Course, base: Array) -> WholeBody:
    """The walk with this pelvis, and what the ground must exert for it.

    Args:
        robot: With a fixed pelvis.
        floating: The same with a free one.
        plan: The course of the walk.
        base: `(n, 4, 4)` pose of the pelvis.
    """
    targets = {foot: plan.paths.feet[:, k] for k, foot in enumerate(FEET)}
    answer = track(robot, targets, base=base, settings=ClosedForm())
    still = Gait(plan.time, np.zeros((len(plan.time), len(JOINTS))), base=base, events=plan.events)
    walk = robot.to_gait(answer.q, still)
    moving = motion(floating, walk, cutoff=None)
    wrench = in_world_axes(moving.base, generalized_forces(floating, moving))
    return WholeBody(walk, answer, moving, wrench, zmp_of_wrench(wrench, base[:, :3, 3]))


def filtered(
    robot: Robot, floating: Robot, plan: Course, base: Array, *, rest: float, passes: int
) -> WholeBody:
    """The walk whose whole body has the ZMP that is asked for, after some passes of the dynamics filter.

    Args:
        robot: With a fixed pelvis.
        floating: The same with a free one.
        plan: The course of the walk.
        base: `(n, 4, 4)` pose of the pelvis by the pendulum alone.
        rest: Time of standing still before and after [s].
        passes: Of the filter.
    """
    dt = float(plan.time[1] - plan.time[0])
    body = moving_body(robot, floating, plan, base)
    height = float(center_of_mass(floating, body.motion.q[0]).position[2])
    for _ in range(passes):
        base = base.copy()
        error = resting_zmp(body.zmp - plan.zmp, dt, height, rest)
        base[:, :2, 3] -= com_of_zmp(error, dt, height)
        body = moving_body(robot, floating, plan, base)
    return body


def zmp_of_wrench(wrench: Array, point: Array) -> Array:
    """`(n, 2)` point of the ground about which a wrench has no tilting moment [m].

    Args:
        wrench: `(n, 6)` force, then moment about `point`, world axes [N, N m].
        point: `(n, 3)` [m].
    """
    force, moment = wrench[:, :3], wrench[:, 3:]
    tilting = np.stack([-moment[:, 1], moment[:, 0]], axis=1)
    return np.asarray(point[:, :2] + (tilting - point[:, 2:] * force[:, :2]) / force[:, 2:])

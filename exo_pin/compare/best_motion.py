"""Motion of a device through a walk: the best towards the recorded feet, and the plain copy of its joints.

The best motion minimises, sample by sample, the sum of squared distances of the four sole corners of each
foot from their recorded places: weighted least squares over position and rotation. The weights need no
choice, because both are distances of points on the sole. The motion keeps the device's joint limits. Where
the best configurations of the samples would exceed a limit of speed or acceleration, the best motion as a
whole is found that keeps these limits, too, between the samples as well.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from exo_pin import ik
from exo_pin.anatomy import FEET, JOINTS, SIDES, Body
from exo_pin.anatomy.hip_cardan_angles import hip_angles
from exo_pin.arrays import Array
from exo_pin.compare.recorded_walk import DEFAULT_CONDITIONS, Conditions, Walk, corners, sole_targets
from exo_pin.demand import acceleration_limits
from exo_pin.devices import Device
from exo_pin.gait import Gait
from exo_pin.ik.least_squares.rate_limited import RateLimits, rate_limited
from exo_pin.ik.least_squares.rate_rows import Clock
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.kinematics.resting_stance import stand
from exo_pin.robot import Robot, load_robot
from exo_pin.short_repr import short_repr

SOLVER = ik.Dls(tolerance=1e-10, restarts=0, warm_start=False)
"""Every sample starts from the plain copy, then from its neighbours' solutions; no other restarts."""

MOST_SWEEPS = 10
"""Largest number of passes through all samples, in which each starts from its neighbours' solutions."""

LEAST_DECREASE = 1e-10
"""A squared error that decreases by less does so by rounding [m^2]."""


@dataclass(frozen=True, eq=False)
class DeviceMotion:
    """The motion of a device.

    Attributes:
        robot: The device under the conditions of the comparison.
        q: Configurations (n, nq) [rad, of prismatic joints m].
        gait: The same as a gait: locked joints at zero, prismatic joints included in its base.
        feet: T_world_foot (n, 2, 4, 4).
        corners: Sole corners (n, 2, 4, 3) [m].
        com: Centre of mass (n, 3) [m].
        required: Angles (n, 12) that would keep the attitude of the recorded legs [rad]: the gait's own where
            the pelvis moves as recorded; where it is held, the hips include the rotation of the pelvis.
    """

    robot: Robot
    q: Array
    gait: Gait
    feet: Array
    corners: Array
    com: Array
    required: Array

    __repr__ = short_repr


def robot_for(device: Device, body: Body, conditions: Conditions) -> Robot:
    """The robot of a device under given conditions.

    Args:
        device: The device.
        body: Who wears it.
        conditions: Who moves the pelvis, and whether passive joints are held.
    """
    if conditions.passive == "released":
        device = device.released()
    return load_robot(body, device=device.carried() if conditions.pelvis == "recorded" else device)


def projected(recorded: Walk, robot: Robot, conditions: Conditions = DEFAULT_CONDITIONS) -> DeviceMotion:
    """The plain copy: the device's joints take the required angles within their limits; others stay at zero.

    Args:
        recorded: The walk.
        robot: The device, as `robot_for` loads it under the same conditions.
        conditions: Who moves the pelvis.
    """
    base = _stand(recorded, robot, conditions)
    required = _required(recorded, base)
    return _motion(recorded, robot, plain_copy(recorded, robot, required), base, required)


def best(
    recorded: Walk, robot: Robot, conditions: Conditions = DEFAULT_CONDITIONS, *, settings: ik.Dls = SOLVER
) -> DeviceMotion:
    """The device's best motion towards the recorded feet, within its ranges, speeds and accelerations.

    Args:
        recorded: The walk.
        robot: The device, as `robot_for` loads it under the same conditions.
        conditions: Who moves the pelvis.
        settings: Of the least squares for the samples.
    """
    base = _stand(recorded, robot, conditions)
    required = _required(recorded, base)
    start = plain_copy(recorded, robot, required)
    targets = sole_targets(robot, recorded.corners)

    def solved(seed: Array) -> tuple[Array, Array]:
        q = ik.track(robot, targets, seed, base=base, settings=settings).q
        missed = corners(robot, poses(robot, q, FEET, base=base)) - recorded.corners
        return q, (missed**2).sum(axis=(1, 2, 3))

    q = _improved_by_neighbours(solved, start)
    q = rate_limited(robot, targets, q, rate_limits(recorded.gait, robot), base=base)
    return _motion(recorded, robot, q, base, required)


def _improved_by_neighbours(solved: Callable[[Array], tuple[Array, Array]], start: Array) -> Array:
    """Solutions (n, nq) that no start from a neighbour's solution improves: fewer stay in poor minima."""
    q, cost = solved(start)
    for _ in range(MOST_SWEEPS):
        before = cost
        for shift in (1, -1):
            other, other_cost = solved(np.roll(q, shift, axis=0))
            better = other_cost < cost - LEAST_DECREASE
            q, cost = np.where(better[:, None], other, q), np.where(better, other_cost, cost)
        if np.array_equal(cost, before):
            break
    return q


def rate_limits(gait: Gait, robot: Robot) -> RateLimits:
    """The largest speeds and accelerations of a device's joints, on the clock of a walk."""
    clock = Clock(gait.time, gait.duration if gait.periodic else None)
    return RateLimits(clock, robot.velocity, acceleration_limits(robot))


def plain_copy(recorded: Walk, robot: Robot, required: Array) -> Array:
    """Configurations (n, nq) that take required angles within the joint limits.

    Args:
        recorded: The walk.
        robot: The device.
        required: Angles (n, 12) [rad]; those of locked joints are dropped.
    """
    q = robot.from_gait(dataclasses.replace(recorded.gait, q=required))
    return np.clip(q, robot.lower, robot.upper)


def _required(recorded: Walk, base: Array) -> Array:
    """The gait's angles with the hips relative to another pelvis: the thighs keep their attitude."""
    required = np.array(recorded.gait.q)
    if base is recorded.base:
        return required
    q = recorded.robot.from_gait(recorded.gait)
    thighs = poses(recorded.robot, q, [f"{side}_thigh" for side in SIDES], base=recorded.base)
    R = base[:, None, :3, :3].swapaxes(-1, -2) @ thighs[..., :3, :3]
    for k, side in enumerate(SIDES):
        first = JOINTS.index(f"{side}_hip_flexion")  # flexion, adduction, rotation follow each other
        required[:, first : first + 3] = hip_angles(R[:, k], side)
    return required


def _stand(recorded: Walk, robot: Robot, conditions: Conditions) -> Array:
    """T_world_stand (n, 4, 4): the base of the device's joints, its prismatic ones included."""
    if conditions.pelvis == "recorded" or (robot.device is not None and robot.device.pelvis == "free"):
        return recorded.base
    return stand(recorded.gait.time, recorded.base, periodic=recorded.gait.periodic)


def _motion(recorded: Walk, robot: Robot, q: Array, base: Array, required: Array) -> DeviceMotion:
    feet = poses(robot, q, FEET, base=base)
    like = Gait(
        recorded.gait.time,
        recorded.gait.q,
        base=base,
        events=recorded.gait.events,
        periodic=recorded.gait.periodic,
        source=f"{robot.name} after {recorded.gait.source or 'a gait'}",
    )
    com = center_of_mass(robot, q, base=base).position
    return DeviceMotion(robot, q, robot.to_gait(q, like), feet, corners(robot, feet), com, required)


def dressed(robot: Robot) -> Robot:
    """The full 12-joint model with the appearance of a device, for the viewer, which plots all twelve joints.

    A gait with the locked joints at zero brings both into the same pose.
    """
    return dataclasses.replace(load_robot(robot.body), urdf=robot.urdf)

"""The walk that a simulation is to follow, at every step: joints, pelvis, required torques."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import CORNERS, JOINTS
from exo_pin.arrays import Array
from exo_pin.dynamics import Dynamics
from exo_pin.gait import Gait
from exo_pin.gait.rigid_poses import nearest_pose
from exo_pin.gait.time_series import at_phase, derivative, resampled
from exo_pin.ground import belt_speed
from exo_pin.kinematics import poses

_POSE = 16
"""Numbers of a pose."""


@dataclass(frozen=True, eq=False)
class ReferenceMotion:
    """A walk at the times of a simulation, N steps.

    A treadmill's belt stands still, the pelvis moves over it.

    Attributes:
        time: `(N,)` from 0 [s].
        phase: `(N,)` of the cycle, 0 to 1; of a recording its part that is over.
        q: `(N, 12)` joint angles, order of `JOINTS`, the robot's hip axes; zero for joints it lacks [rad].
        dq: `(N, 12)` joint velocities [rad/s].
        ddq: `(N, 12)` joint accelerations [rad/s^2].
        torque: `(N, 12)` by inverse dynamics [N m].
        base: `(N, 4, 4)` pose of the pelvis.
        base_velocity: `(N, 6)` linear, then angular, world axes [m/s, rad/s].
        belt_speed: Of the treadmill that the walk belongs to; 0 over ground [m/s].
    """

    time: Array
    phase: Array
    q: Array
    dq: Array
    ddq: Array
    torque: Array
    base: Array
    base_velocity: Array
    belt_speed: float


def reference_motion(gait: Gait, dynamics: Dynamics, *, cycles: int, timestep: float) -> ReferenceMotion:
    """The walk of an inverse dynamics at the steps of a simulation.

    Args:
        gait: The walk as given: its times and whether it repeats.
        dynamics: Its inverse dynamics: motion of joints and pelvis, torques (zero where not valid).
        cycles: How often a walk that repeats is walked; a recording is walked once.
        timestep: Of the simulation [s].
    """
    moving, robot = dynamics.motion, dynamics.robot
    n, free = len(gait), robot.model.nv - len(robot.joints)
    columns = [JOINTS.index(name) for name in robot.joints if name in JOINTS]
    own = [k for k, name in enumerate(robot.joints) if name in JOINTS]
    curves = np.zeros((n, 4 * len(JOINTS) + _POSE))
    for part, values in enumerate((moving.q[:, free + 1 :], moving.v[:, free:], moving.a[:, free:])):
        curves[:, part * len(JOINTS) + np.array(columns)] = values[:, own]
    curves[:, 3 * len(JOINTS) : 4 * len(JOINTS)] = np.nan_to_num(dynamics.torque)
    curves[:, 4 * len(JOINTS) :] = moving.base.reshape(n, _POSE)
    rates = derivative(gait.time, curves[:, 4 * len(JOINTS) :], 1, gait.duration if gait.periodic else None)
    corners = poses(robot, moving.q, CORNERS)[..., :3, 3]
    speed = belt_speed(gait, moving.base, corners)
    time, phase, both = _sampled(gait, np.hstack([curves, rates]), cycles, timestep)
    q, dq, ddq, torque = np.split(both[:, : 4 * len(JOINTS)], 4, axis=1)
    flat = both[:, 4 * len(JOINTS) :]
    base, velocity = _moving(flat[:, :_POSE].reshape(-1, 4, 4), flat[:, _POSE:].reshape(-1, 4, 4))
    base[:, 0, 3] += speed * time
    velocity[:, 0] += speed
    return ReferenceMotion(time, phase, q, dq, ddq, torque, base, velocity, speed)


def _sampled(gait: Gait, curves: Array, cycles: int, timestep: float) -> tuple[Array, Array, Array]:
    """Times, phases and the curves at every step."""
    start = gait.time[0]
    steps = round(gait.duration * (cycles if gait.periodic else 1) / timestep)
    time = timestep * np.arange(steps + 1, dtype=float)
    phase: Array = np.asarray(time / gait.duration)
    if gait.periodic:
        phase = np.mod(phase, 1.0)
        return time, phase, at_phase(curves, phase)
    inside = phase <= 1.0
    values = resampled(gait.time, curves, start + time[inside], periodic=False)
    return time[inside], phase[inside], values


def _moving(T: Array, dT: Array) -> tuple[Array, Array]:
    """Poses and their velocities (N, 6) from interpolated entries and their rates."""
    base = nearest_pose(T)
    W = dT[:, :3, :3] @ np.swapaxes(base[:, :3, :3], 1, 2)
    skew = W - np.swapaxes(W, 1, 2)
    turning = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1) / 2
    return base, np.hstack([dT[:, :3, 3], turning])

"""The engine's witness: Pinocchio's forward dynamics of a run's forces against MuJoCo's accelerations."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from exo_pin.anatomy import FEET, JOINTS
from exo_pin.arrays import Array
from exo_pin.control.held_legs import with_rotors
from exo_pin.robot import Robot
from exo_pin.simulation.contact_forces import FloorForces
from exo_pin.simulation.engine_forces import stop_torques
from exo_pin.simulation.recording import Recording

_FREE = 6


def witness(robot: Robot, record: Recording, floor: FloorForces, timestep: float) -> float:
    """Largest difference of the accelerations, relative to the largest acceleration of the run.

    MuJoCo's acceleration is (v_next - v) / dt, the one that it has stepped with. Pinocchio computes its own
    from the state before the step and from the forces alone: floor, support, motors, person, friction, stops.

    Args:
        robot: The floating robot that was simulated.
        record: The run, N steps.
        floor: Its forces of the floor.
        timestep: Of the run [s].
    """
    if len(record.qvel) < 2:
        return 0.0
    q, v = pinocchio_state(record, robot)
    tau = np.zeros(v.shape)
    columns = [JOINTS.index(name) for name in robot.joints if name in JOINTS]
    own = _FREE + np.array([k for k, name in enumerate(robot.joints) if name in JOINTS])
    tau[:, own] = (record.motor + record.person + record.friction)[:, columns]
    tau[:, _FREE:] += stop_torques(record.sensed, record.qpos[:, _FREE + 1 :], robot)
    R = rotations(record)
    tau[:, :3] = np.einsum("nji,nj->ni", R, record.support[:, :3])
    tau[:, 3:_FREE] = np.einsum("nji,nj->ni", R, record.support[:, 3:])
    ours = _accelerations(robot, q, v, tau, np.concatenate([floor.force, floor.moment], axis=2))
    ours[:, :3] += np.cross(v[:, 3:_FREE], v[:, :3])  # of the origin, not spatial
    ours[:, :3] = np.einsum("nij,nj->ni", R, ours[:, :3])
    theirs = np.diff(record.qvel, axis=0) / timestep
    return float(np.abs(ours[:-1] - theirs).max() / np.abs(theirs).max())


def pinocchio_state(record: Recording, robot: Robot) -> tuple[Array, Array]:
    """Positions (N, nq) and velocities (N, nv) of a run in Pinocchio's order and axes."""
    q, v = record.qpos.copy(), record.qvel.copy()
    q[:, 3:7] = record.qpos[:, [4, 5, 6, 3]]  # MuJoCo's quaternion begins with its real part
    v[:, :3] = np.einsum("nji,nj->ni", rotations(record), record.qvel[:, :3])
    return q, v


def rotations(record: Recording) -> Array:
    """Attitude of the pelvis (N, 3, 3)."""
    w, x, y, z = record.qpos[:, 3:7].T
    R = np.empty((len(w), 3, 3))
    R[:, 0] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], axis=1)
    R[:, 1] = np.stack([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], axis=1)
    R[:, 2] = np.stack([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)], axis=1)
    return R


def _accelerations(robot: Robot, q: Array, v: Array, tau: Array, wrench: Array) -> Array:
    """Pinocchio's forward dynamics with wrenches (N, 2, 6) on the feet about the world's origin."""
    model, data = with_rotors(robot), robot.model.createData()
    feet = [model.frames[robot.frame(foot)].parentJoint for foot in FEET]
    forces = pin.StdVec_Force([pin.Force.Zero() for _ in range(model.njoints)])
    out = np.empty(v.shape)
    for k in range(len(q)):
        pin.forwardKinematics(model, data, q[k])
        for foot, joint in enumerate(feet):
            forces[joint] = data.oMi[joint].actInv(pin.Force(wrench[k, foot]))
        out[k] = pin.aba(model, data, q[k], v[k], tau[k], forces)
    return out

"""Inverse dynamics by MuJoCo: its own reading of the URDF and its own algorithm."""

from __future__ import annotations

from typing import Any

import numpy as np

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.crosscheck.random_states import States
from exo_pin.robot import Robot

_COMPILER = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco>'


def generalized_forces(robot: Robot, states: States) -> Array:
    """`(n, 6 + J)` force and moment on the pelvis in world axes, then joint torques [N, N m].

    Limits, contacts, friction and damping are switched off: `mj_inverse` would count their forces.

    Args:
        robot: A floating robot.
        states: n states.
    """
    import mujoco  # 0.3 s, needed here only

    model = _model(mujoco, robot)
    data = mujoco.MjData(model)
    columns = np.array([model.joint(name).dofadr[0] for name in robot.joints])
    feet = [model.body(foot).id for foot in FEET]
    out = np.empty((len(states.q), 6 + len(columns)))
    for k in range(len(out)):
        R = states.base[k, :3, :3]
        data.qpos[:3] = states.base[k, :3, 3]
        mujoco.mju_mat2Quat(data.qpos[3:7], R.ravel())
        data.qpos[columns + 1] = states.q[k]
        for values, pelvis, joints in (
            (data.qvel, states.velocity[k], states.dq[k]),
            (data.qacc, states.acceleration[k], states.ddq[k]),
        ):
            values[:3], values[3:6] = pelvis[:3], R.T @ pelvis[3:]  # of the world, and of the pelvis
            values[columns] = joints
        mujoco.mj_inverse(model, data)
        ground = np.zeros(model.nv)
        for foot, wrench in zip(feet, states.wrench[k], strict=True):
            mujoco.mj_applyFT(model, data, wrench[:3], wrench[3:], np.zeros(3), foot, ground)
        tau = data.qfrc_inverse - ground
        out[k] = np.concatenate([tau[:3], R @ tau[3:6], tau[columns]])
    return out


def _model(mujoco: Any, robot: Robot) -> Any:
    """The URDF with a free pelvis; nothing but inertia and gravity acts in it."""
    head, tail = robot.urdf.rsplit("</robot>", 1)
    spec = mujoco.MjSpec.from_string(f"{head}{_COMPILER}</robot>{tail}")
    spec.worldbody.first_body().add_freejoint()
    model = spec.compile()
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    model.dof_damping[:] = 0.0
    model.dof_armature[:] = 0.0
    model.dof_frictionloss[:] = 0.0
    return model

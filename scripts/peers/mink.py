"""Mink: task-based differential inverse kinematics on MuJoCo, solved by the QP solver DAQP."""

import numpy as np


class Mink:
    name = "Mink (daqp)"
    package = "mink"

    def __init__(self, robot, tolerance):
        import mink
        import mujoco

        self.mink, self.tolerance = mink, tolerance
        model = mujoco.MjModel.from_xml_string(robot.urdf)
        self.robot = robot
        self.order = [model.joint(name).qposadr[0] for name in robot.joints]
        self.configuration = mink.Configuration(model)
        self.tasks = [mink.FrameTask(f"{side}_sole_plate", "body", 1.0, 1.0) for side in ("left", "right")]
        self.limits = [mink.ConfigurationLimit(model, gain=1.0)]
        self.world = np.linalg.inv(robot.placement)  # MuJoCo's world is the pelvis
        drop = {side: getattr(robot.body, f"{side}_ankle_height") for side in ("left", "right")}
        self.offsets = []
        for side in ("left", "right"):
            up = np.eye(4)
            up[2, 3] = drop[side]  # MuJoCo keeps no fixed frames: its sole plate stands in the ankle
            self.offsets.append(up)

    def single(self, left, right, seed):
        q = np.empty(12)
        q[self.order] = np.clip(seed, self.robot.lower, self.robot.upper)
        self.configuration.update(q)
        for task, T, up in zip(self.tasks, (left, right), self.offsets, strict=True):
            task.set_target(self.mink.SE3.from_matrix(self.world @ T @ up))
        for _ in range(100):
            if all(np.linalg.norm(t.compute_error(self.configuration)) < self.tolerance for t in self.tasks):
                break
            v = self.mink.solve_ik(self.configuration, self.tasks, 1.0, "daqp", limits=self.limits)
            self.configuration.integrate_inplace(v, 1.0)
        return self.configuration.q[self.order]

"""Pink: task-based differential inverse kinematics on Pinocchio, solved by the QP solver DAQP."""

import numpy as np


class Pink:
    name = "Pink (daqp)"
    package = "pink"

    def __init__(self, robot, tolerance):
        import pink
        from pink.limits import ConfigurationLimit
        from pink.tasks import FrameTask

        self.pink, self.tolerance = pink, tolerance
        self.robot = robot
        self.tasks = [FrameTask(f"{side}_foot", 1.0, 1.0) for side in ("left", "right")]
        self.limits = [ConfigurationLimit(robot.model, config_limit_gain=1.0)]
        self.configuration = pink.Configuration(robot.model, robot.model.createData(), robot.neutral)

    def single(self, left, right, seed):
        import pinocchio as pin

        self.configuration.update(np.clip(seed, self.robot.lower, self.robot.upper))
        for task, T in zip(self.tasks, (left, right), strict=True):
            task.set_target(pin.SE3(T))
        for _ in range(100):
            if all(np.linalg.norm(t.compute_error(self.configuration)) < self.tolerance for t in self.tasks):
                break
            v = self.pink.solve_ik(
                self.configuration, self.tasks, 1.0, solver="daqp", limits=self.limits, safety_break=False
            )
            self.configuration.integrate_inplace(v, 1.0)
        return self.configuration.q

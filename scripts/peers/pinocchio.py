"""Pinocchio: the closed-loop inverse kinematics of its documentation, once as printed, once with DT = 1."""

import numpy as np
import pinocchio as pin


class Clik:
    name = "Pinocchio's documented CLIK loop"
    package = "pinocchio"
    dt = 0.1

    def __init__(self, robot, tolerance):
        self.robot, self.model, self.data = robot, robot.model, robot.model.createData()
        self.tips = [
            (
                self.model.frames[robot.frame(f"{side}_foot")].parentJoint,
                self.model.frames[robot.frame(f"{side}_foot")].placement,
            )
            for side in ("left", "right")
        ]
        self.eps = tolerance

    def single(self, left, right, seed):
        q = seed.copy()
        for (joint, placement), T in zip(self.tips, (left, right), strict=True):
            q = self._descend(joint, pin.SE3(T) * placement.inverse(), q)
        return q

    def _descend(self, joint, target, q):
        model, data = self.model, self.data
        for _ in range(1000):
            pin.forwardKinematics(model, data, q)
            iMd = data.oMi[joint].actInv(target)
            err = pin.log(iMd).vector
            if np.linalg.norm(err) < self.eps:
                break
            J = pin.computeJointJacobian(model, data, q, joint)
            J = -np.dot(pin.Jlog6(iMd.inverse()), J)
            v = -J.T.dot(np.linalg.solve(J.dot(J.T) + 1e-12 * np.eye(6), err))
            q = pin.integrate(model, q, v * self.dt)
        return q


class ClikFullStep(Clik):
    name = "the same with DT = 1"
    dt = 1.0

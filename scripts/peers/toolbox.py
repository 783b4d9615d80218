"""Robotics Toolbox for Python: ETS.ik_LM, Levenberg-Marquardt in C++."""

import numpy as np


class Toolbox:
    name = "Robotics Toolbox ik_LM"
    package = "roboticstoolbox"

    def __init__(self, robot, tolerance):
        self.legs = [robot.leg(f"{side}_foot") for side in ("left", "right")]
        self.ets = [_sequence(own) for own in self.legs]
        self.tol = tolerance**2  # it is compared with half the squared error

    def single(self, left, right, seed):
        q = np.empty(12)
        for own, ets, T in zip(self.legs, self.ets, (left, right), strict=True):
            q[own.columns] = ets.ik_LM(T, q0=seed[own.columns], tol=self.tol, joint_limits=True).q
        return q


def _sequence(own):
    import roboticstoolbox as rtb
    from roboticstoolbox import ET
    from spatialmath import SE3

    parts, before = [], np.zeros(3)
    for j in range(6):
        parts.append(ET.SE3(SE3(*(own.points[j] - before))))
        before = own.points[j]
        axis = int(np.argmax(np.abs(own.axes[j])))
        limits = np.array([own.lower[j], own.upper[j]])
        parts.append((ET.Rx, ET.Ry, ET.Rz)[axis](flip=bool(own.axes[j].sum() < 0), qlim=limits))
    parts.append(ET.SE3(SE3(*(own.tip[:3, 3] - before))))
    return rtb.ETS(parts)

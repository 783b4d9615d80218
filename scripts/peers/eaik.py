"""EAIK: general analytic inverse kinematics by subproblem decomposition (C++), batched."""

import numpy as np


class Eaik:
    name = "EAIK batch"
    package = "eaik"

    def __init__(self, robot, tolerance):
        from eaik.IK_HP import HPRobot

        self.legs = [robot.leg(f"{side}_foot") for side in ("left", "right")]
        # It answers wrongly for axes that are anti-parallel, so they are turned along +x, +y, +z by hand.
        self.signs = [np.where(own.axes.sum(axis=1) < 0, -1.0, 1.0) for own in self.legs]
        self.solvers = [
            HPRobot(
                own.axes * sign[:, None],
                np.vstack([own.points[0], np.diff(own.points, axis=0), own.tip[:3, 3] - own.points[-1]]),
            )
            for own, sign in zip(self.legs, self.signs, strict=True)
        ]

    def batch(self, left, right):
        q = np.empty((len(left), 12))
        for own, sign, answers in zip(self.legs, self.signs, self.call(left, right), strict=True):
            q[:, own.columns] = _within(own, sign, answers)
        return q

    def call(self, left, right):
        """The package's own work: all solutions of both legs."""
        return [
            solver.IK_batched(np.ascontiguousarray(T))
            for solver, T in zip(self.solvers, (left, right), strict=True)
        ]


def _within(own, sign, answers):
    """The one of each pose's answers that is nearest to the limits' inside."""
    found = [answer.Q for answer in answers]
    rows = np.array([len(Q) for Q in found])
    Q = np.concatenate(found) * sign
    out = np.maximum(own.lower - Q, Q - own.upper).max(axis=1)
    first = np.concatenate([[0], np.cumsum(rows)[:-1]])
    if (rows == rows[0]).all():
        best = first + out.reshape(-1, rows[0]).argmin(axis=1)
    else:
        best = np.array([a + np.argmin(out[a : a + k]) for a, k in zip(first, rows, strict=True)])
    return np.clip(Q[best], own.lower, own.upper)

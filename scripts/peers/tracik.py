"""TRAC-IK by the binding pytracik: two solvers race in C++ within a time limit."""

import tempfile
from pathlib import Path

import numpy as np


class TracIk:
    name = "TRAC-IK"
    package = "trac_ik"

    def __init__(self, robot, tolerance):
        from trac_ik import TracIK

        self.legs = [robot.leg(f"{side}_foot") for side in ("left", "right")]
        self.world = np.linalg.inv(robot.placement)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "exo.urdf"
            path.write_text(robot.urdf)
            self.solvers = [
                TracIK("pelvis", f"{side}_foot", str(path), timeout=0.005, epsilon=tolerance)
                for side in ("left", "right")
            ]

    def single(self, left, right, seed):
        q = np.full(12, np.nan)
        for own, solver, T in zip(self.legs, self.solvers, (left, right), strict=True):
            T = self.world @ T
            found = solver.ik(T[:3, 3], T[:3, :3], seed[own.columns])
            if found is not None:
                q[own.columns] = found
        return q

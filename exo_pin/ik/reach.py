"""How far inside the leg's reach a target lies."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.ik.chain import mix
from exo_pin.ik.leg import Leg, leg
from exo_pin.ik.problem import Problem
from exo_pin.ik.targets import CHUNK

Array = npt.NDArray[np.float64]


def slack(task: Problem) -> Array:
    """Reach minus distance from the hip centre to the ankle of the target pose (n, F) [m].

    Negative where the leg is too short by that much. NaN for targets without a rotation, for frames that are
    not carried by six joints, and for a floating base that is solved too.
    """
    out = np.full((task.n, len(task.goals)), np.nan)
    if any(limb.floats for limb in task.limbs):
        return out
    for f, goal in enumerate(task.goals):
        chain = leg(task.robot, goal.frame)
        if chain is None or goal.R is None:
            continue
        for a in range(0, task.n, CHUNK):
            part = slice(a, a + CHUNK)
            out[part, f] = chain.reach - _distance(chain, goal.R[part], goal.p[part, 0])
    return out


def _distance(chain: Leg, R: Array, p: Array) -> Array:
    """From the hip centre to the ankle of each target (m,) [m]."""
    ankle, hip = [float(x) for x in chain.ankle_in_frame], chain.hip
    apart = [p[:, i] - hip[i] + mix([R[:, i, j] for j in range(3)], ankle) for i in range(3)]
    return np.asarray(np.sqrt(apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]))

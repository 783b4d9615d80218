"""How far inside the leg's reach a target lies."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from exo_pin.ik.leg import leg
from exo_pin.ik.problem import Problem

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
        ankle = goal.p[:, 0] + goal.R @ chain.ankle_in_frame
        out[:, f] = chain.reach - np.linalg.norm(ankle - chain.hip, axis=1)
    return out

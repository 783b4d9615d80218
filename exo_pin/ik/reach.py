"""How far inside the leg's reach a target lies."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.leg.forward import Matrix, Number, components, mix
from exo_pin.ik.targets import CHUNK, Goal
from exo_pin.robot.leg_axes import LegAxes


def slack(leg: LegAxes, R: Matrix, p: list[Number]) -> Array:
    """Reach minus distance from the hip centre to the ankle of the target pose (m,) [m].

    Negative where the leg is too short by that much.
    """
    ankle = [float(x) for x in leg.ankle_in_frame]
    apart = [x - float(hip) + mix(row, ankle) for x, hip, row in zip(p, leg.hip, R, strict=True)]
    return np.asarray(leg.reach - np.sqrt(apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]))


def slack_of(leg: LegAxes | None, goal: Goal) -> Array:
    """The slack of all samples (n,); NaN for targets without a rotation and frames that no leg carries."""
    out = np.full(len(goal.p), np.nan)
    if leg is None or goal.R is None:
        return out
    for a in range(0, len(out), CHUNK):
        part = slice(a, a + CHUNK)
        out[part] = slack(leg, *components(goal.R[part], goal.p[part, 0]))
    return out

"""How far joints may move from one sample to the next where targets cannot be met.

The compromise with the least error may cease to be one from a sample to the next (the fold of a local
minimum): whoever then takes the next best jumps, however slowly the target moves. So a joint whose target
is missed goes at most `HASTE` times as fast as it would have to if it followed the target alone.
"""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.targets import Goal
from exo_pin.robot import SubtreeArrays

HASTE = 2.0
"""Room for joints that share the work; with 1, compromises near a straight knee come late."""
ARM = 0.05
"""Shorter lever arms count as this long [m]: a joint that hardly moves its frame has nothing to follow."""


def pace(joints: SubtreeArrays, goals: list[Goal]) -> Array:
    """The largest move of each joint to each sample from the one before (n, J) [rad], slides [m].

    It is `HASTE` times what the target's largest move so far asks of the joint: the way of its points over
    the lever arm, and the angle that it turns; of a slide, the way. The first sample has none before it:
    infinite.
    """
    most = np.zeros((len(goals[0].p), len(joints.axes)))
    for f, goal in enumerate(goals):
        centre = joints.frames[f, :3, :3] @ goal.local.mean(axis=0) + joints.frames[f, :3, 3]
        arms = np.linalg.norm(np.cross(joints.axes, centre - joints.points), axis=1)
        arms = np.where(joints.revolute, np.maximum(arms, ARM), 1.0)
        need = _ways(goal)[:, None] / arms + _turns(goal)[:, None] * joints.revolute
        np.maximum(most, np.where(joints.moves[f], need, 0.0), out=most)
    most = HASTE * np.maximum.accumulate(most, axis=0)
    most[0] = np.inf
    return most


def _ways(goal: Goal) -> Array:
    """How far the points move to each sample from the one before (n,) [m], those seen in both."""
    way = np.linalg.norm(np.diff(goal.p, axis=0), axis=2)
    seen = (goal.weight[1:] > 0.0) & (goal.weight[:-1] > 0.0)
    return np.append(0.0, np.where(seen, way, 0.0).max(axis=1))


def _turns(goal: Goal) -> Array:
    """How far the target turns to each sample from the one before (n,) [rad]."""
    if goal.R is None:
        return np.zeros(len(goal.p))
    chord = np.linalg.norm(np.diff(goal.R, axis=0), axis=(1, 2))
    return np.append(0.0, 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0)))

"""Step limits: how far joints may move from one sample to the next where targets cannot be met.

The compromise with the least error may cease to be one from a sample to the next (the fold of a local
minimum), and the next best jumps, however slowly the target moves. So a joint whose target is missed moves
at most `_SPEED_RATIO` times as fast as it would have to if it followed the target alone.
"""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.ik.targets import Goal
from exo_pin.robot import SubtreeArrays

_SPEED_RATIO = 2.0  # room for joints that share the work; with 1, compromises near a straight knee come late
_SHORTEST_ARM = 0.05  # [m] of a lever arm: a joint that hardly moves its frame has nothing to follow


def step_limits(arrays: SubtreeArrays, goals: list[Goal]) -> Array:
    """The largest move of each joint to each sample from the one before (n, J) [rad], prismatic [m].

    It is `_SPEED_RATIO` times what the target's largest move so far requires of the joint: the path of its
    points over the lever arm, and the angle that it turns; of a prismatic joint, the path. The first sample
    has none before it: infinite.

    Args:
        arrays: The joints.
        goals: One for each frame, n samples.
    """
    most = np.zeros((len(goals[0].p), len(arrays.axes)))
    for f, goal in enumerate(goals):
        centre = arrays.frames[f, :3, :3] @ goal.local.mean(axis=0) + arrays.frames[f, :3, 3]
        arms = np.linalg.norm(np.cross(arrays.axes, centre - arrays.points), axis=1)
        arms = np.where(arrays.revolute, np.maximum(arms, _SHORTEST_ARM), 1.0)
        need = _paths(goal)[:, None] / arms + _angles(goal)[:, None] * arrays.revolute
        np.maximum(most, np.where(arrays.moves[f], need, 0.0), out=most)
    most = _SPEED_RATIO * np.maximum.accumulate(most, axis=0)
    most[0] = np.inf
    return most


def _paths(goal: Goal) -> Array:
    """How far the points move to each sample from the one before (n,) [m], those seen in both."""
    path = np.linalg.norm(np.diff(goal.p, axis=0), axis=2)
    seen = (goal.weight[1:] > 0.0) & (goal.weight[:-1] > 0.0)
    return np.append(0.0, np.where(seen, path, 0.0).max(axis=1))


def _angles(goal: Goal) -> Array:
    """How far the target turns to each sample from the one before (n,) [rad]."""
    if goal.R is None:
        return np.zeros(len(goal.p))
    chord = np.linalg.norm(np.diff(goal.R, axis=0), axis=(1, 2))
    return np.append(0.0, 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0)))

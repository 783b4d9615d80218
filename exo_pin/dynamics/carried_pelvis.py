"""Pelvis of a walk without force plates: recorded in the world, or carried by the balance support."""

from __future__ import annotations

import dataclasses

import numpy as np

from exo_pin.gait import Gait
from exo_pin.gait.time_series import low_harmonics
from exo_pin.ground import Intervals, place_walk
from exo_pin.robot import Robot

_HARMONICS = 3
"""Of the cycle that the carried pelvis keeps: with 8 the vertical force has five humps, with 3 a walk's
two (a choice)."""


def carried(robot: Robot, gait: Gait) -> tuple[Gait, Intervals, str]:
    """The walk with a pelvis that moves, its stance, and how in words.

    A recording keeps its own pelvis. Joint angles alone, and one cycle that repeats, get that of the balance
    support (`exo_pin.ground`), smoothed.

    Args:
        robot: The floating robot.
        gait: The walk.
    """
    placed = place_walk(robot, gait, "carried")
    predicted = "ground reaction predicted (virtual pivot), not measured"
    if gait.base is not None and not gait.periodic:
        return gait, placed.stance, predicted
    base = np.array(placed.base)
    if gait.periodic:
        base[:, :3, 3] = low_harmonics(base[:, :3, 3], _HARMONICS * _cycles(gait))
    words = f"{predicted}; pelvis carried by the balance support"
    return dataclasses.replace(gait, base=base), placed.stance, words


def _cycles(gait: Gait) -> int:
    """How often the left heel strikes in a periodic walk."""
    return max(sum((e.side, e.kind) == ("left", "heel_strike") for e in gait.events), 1)

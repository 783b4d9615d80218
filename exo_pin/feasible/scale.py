"""How much of a walk is possible: its joints' movement about their means made smaller or larger."""

from __future__ import annotations

import dataclasses

from exo_pin.feasible.collision import nearest
from exo_pin.feasible.limits import JointDemand
from exo_pin.gait import Gait
from exo_pin.robot import Robot

MOST = 3.0
"""Amplitudes are sought up to this factor."""

_STEPS = 12  # halvings of the interval of amplitudes: to a thousandth


def scaled(gait: Gait, factor: float) -> Gait:
    """The walk with every joint's movement about its mean made larger or smaller."""
    middle = gait.q.mean(axis=0)
    return dataclasses.replace(gait, q=middle + factor * (gait.q - middle))


def amplitude(robot: Robot, gait: Gait, asked: list[JointDemand], gap: float) -> float:
    """The largest factor on the movement about the mean that joints and gap allow, at most `MOST`.

    The limits are linear in the factor; of the collisions it is assumed that more movement is no safer.
    """
    high = min(MOST, *(demand.amplitude for demand in asked))
    if _apart(robot, gait, high, gap):
        return high
    if not _apart(robot, gait, 0.0, gap):
        return 0.0
    low = 0.0
    for _ in range(_STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if _apart(robot, gait, middle, gap) else (low, middle)
    return low


def _apart(robot: Robot, gait: Gait, factor: float, gap: float) -> bool:
    q = robot.from_gait(scaled(gait, factor))
    return bool((nearest(robot, q).distance >= gap).all())

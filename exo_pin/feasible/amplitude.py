"""How much of a walk is possible: its joints' movement about their means made smaller or larger."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

from exo_pin.demand import JointDemand
from exo_pin.feasible.collision import nearest
from exo_pin.gait import Gait
from exo_pin.robot import Robot

MOST = 3.0
"""Amplitudes are sought up to this factor."""

_STEPS = 12  # halvings of the interval of amplitudes: to a thousandth


def scaled(gait: Gait, factor: float) -> Gait:
    """The walk with every joint's movement about its mean made larger or smaller."""
    middle = gait.q.mean(axis=0)
    return dataclasses.replace(gait, q=middle + factor * (gait.q - middle))


def amplitude(
    robot: Robot, gait: Gait, asked: list[JointDemand], gap: float, others: Sequence[Callable[[Gait], bool]]
) -> float:
    """The largest factor on the movement about the mean that joints, gap and others allow, at most `MOST`.

    The limits are linear in the factor; of the collisions and the others it is assumed that more movement is
    no safer.
    """

    def possible(factor: float) -> bool:
        walk = scaled(gait, factor)
        return all(other(walk) for other in others) and _apart(robot, walk, gap)

    high = min(MOST, *(demand.amplitude for demand in asked))
    if possible(high):
        return high
    if not possible(0.0):
        return 0.0
    low = 0.0
    for _ in range(_STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if possible(middle) else (low, middle)
    return low


def _apart(robot: Robot, gait: Gait, gap: float) -> bool:
    return bool((nearest(robot, robot.from_gait(gait)).distance >= gap).all())

"""Largest possible amplitude of a walk: its joints' movement about their means, scaled by one factor."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

from exo_pin.demand import JointDemand
from exo_pin.feasible.collision import nearest
from exo_pin.gait import Gait
from exo_pin.robot import Robot

LARGEST_AMPLITUDE = 3.0
"""The search for an amplitude ends at this factor."""

_BISECTIONS = 12  # of the interval of amplitudes: to a thousandth


def with_amplitude(gait: Gait, factor: float) -> Gait:
    """The walk with the movement of every joint about its mean scaled by a factor."""
    mean = gait.q.mean(axis=0)
    return dataclasses.replace(gait, q=mean + factor * (gait.q - mean))


def largest_amplitude(
    robot: Robot,
    gait: Gait,
    demands: Sequence[JointDemand],
    gap: float,
    conditions: Sequence[Callable[[Gait], bool]],
) -> float:
    """The largest factor on the movement about the mean that is possible, at most `LARGEST_AMPLITUDE`.

    The joint limits are linear in the factor. Collisions and the other conditions are searched by bisection,
    assuming that more movement is no safer.

    Args:
        robot: The device.
        gait: The walk at factor 1.
        demands: The walk's demand on each joint.
        gap: Distance that parts of the device must keep [m].
        conditions: Further conditions that the scaled walk must meet.
    """

    def possible(factor: float) -> bool:
        walk = with_amplitude(gait, factor)
        return all(condition(walk) for condition in conditions) and _apart(robot, walk, gap)

    high = min(LARGEST_AMPLITUDE, *(demand.amplitude_factor for demand in demands))
    if possible(high):
        return high
    if not possible(0.0):
        return 0.0
    low = 0.0
    for _ in range(_BISECTIONS):
        middle = (low + high) / 2
        low, high = (middle, high) if possible(middle) else (low, middle)
    return low


def _apart(robot: Robot, gait: Gait, gap: float) -> bool:
    return bool((nearest(robot, robot.from_gait(gait)).distance >= gap).all())

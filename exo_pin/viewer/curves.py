"""The joint curves beside the picture: which plots there are, and the samples that they draw."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.gait import Gait
from exo_pin.robot import Robot
from exo_pin.viewer.facts import Plot, PlotGroup, Series

Array = NDArray[np.float64]

PLOTTED = (
    "hip_flexion",
    "knee_flexion",
    "ankle_dorsiflexion",
    "hip_adduction",
    "hip_rotation",
    "ankle_inversion",
)
"""The plots from top to bottom: the sagittal plane first."""

DEGREES = 180 / math.pi

NO_LIMIT = 1e6
"""Stands for an infinite limit, which JSON does not know."""


def groups(robot: Robot, *, reference: bool) -> tuple[PlotGroup, ...]:
    """The tabs of plots: joint angles and joint velocities, with the robot's limits.

    Args:
        robot: Whose limits are drawn.
        reference: Whether there are dashed curves.
    """
    angles = tuple(_plot(robot, name, robot.lower, robot.upper, "°", 1, 20.0) for name in PLOTTED)
    speeds = tuple(_plot(robot, name, -robot.velocity, robot.velocity, "°/s", 0, 60.0) for name in PLOTTED)
    return (
        PlotGroup("Angles", "angles", "reference" if reference else "", angles),
        PlotGroup("Velocities", "speeds", "reference_speeds" if reference else "", speeds),
    )


def arrays(gait: Gait, reference: Gait | None) -> dict[str, Array]:
    """The curves by name, `(n, 12)` in the order of `JOINTS` [rad, rad/s], and the reference's own time."""
    curves = {"angles": gait.q, "speeds": gait.dq}
    if reference is not None:
        time = reference.time - reference.time[0]
        curves |= {"reference": reference.q, "reference_time": time}
        curves |= {"reference_speeds": reference.dq, "reference_speeds_time": time}
    return curves


def _plot(
    robot: Robot, movement: str, lower: Array, upper: Array, unit: str, digits: int, least: float
) -> Plot:
    series = []
    for side in SIDES:
        name = f"{side}_{movement}"
        k = robot.joints.index(name)
        low, high = (float(np.clip(limit[k], -NO_LIMIT, NO_LIMIT)) for limit in (lower, upper))
        series.append(Series(side, JOINTS.index(name), low, high))
    return Plot(movement.replace("_", " ").capitalize(), tuple(series), DEGREES, unit, digits, least)

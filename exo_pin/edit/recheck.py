"""What a walk asks of the joints after an adjustment: ranges, velocities, accelerations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.robot import Robot

ROUNDING = 1e-9
"""Excess that is rounding [rad, rad/s]."""

JOLT = 200.0
"""Joint acceleration that no usual walk reaches [rad/s^2]: the fastest of Schwartz 2008 stays below 150."""


@dataclass(frozen=True, eq=False)
class Recheck:
    """The joints that leave what is allowed, each with its worst value, and how near the others come.

    Attributes:
        angle: Joint -> furthest angle beyond its limits [rad]; empty where all is well.
        velocity: Joint -> largest speed beyond the robot's [rad/s].
        acceleration: Joint -> largest acceleration beyond `JOLT` [rad/s^2].
        closest: The joint that comes closest to a limit or furthest beyond, and its distance inside [rad].
        fastest: The joint that needs most of its speed, that speed, and what it has [rad/s].
        hardest: The joint with the largest acceleration, and that acceleration [rad/s^2].
    """

    angle: dict[str, float]
    velocity: dict[str, float]
    acceleration: dict[str, float]
    closest: tuple[str, float]
    fastest: tuple[str, float, float]
    hardest: tuple[str, float]

    @property
    def ok(self) -> bool:
        """Whether nothing is beyond."""
        return not (self.angle or self.velocity or self.acceleration)

    def lines(self) -> list[str]:
        """One sentence per joint and kind, in degrees."""
        kinds = (
            ("angle", "deg", "its limits"),
            ("velocity", "deg/s", "its motor's speed"),
            ("acceleration", "deg/s^2", "any usual walk"),
        )
        return [
            f"{joint}: {kind} {np.degrees(value):.4g} {unit} is beyond {what}"
            for kind, unit, what in kinds
            for joint, value in getattr(self, kind).items()
        ]


def recheck(robot: Robot, gait: Gait) -> Recheck:
    """Check a gait against the robot's limits and velocities, and against jolts.

    Angles are in the robot's own hip order; rates are the clinical angles', by the gait's own derivatives.
    """
    angles = robot.angles(robot.from_gait(gait))
    over = np.where(
        angles > robot.upper + ROUNDING, angles, np.where(angles < robot.lower - ROUNDING, angles, 0)
    )
    excess = np.maximum(angles - robot.upper, robot.lower - angles)
    return Recheck(
        {
            joint: float(angles[excess[:, k].argmax(), k])
            for k, joint in enumerate(robot.joints)
            if over[:, k].any() and excess[:, k].max() > ROUNDING
        },
        _fast(robot, gait.dq, robot.velocity + ROUNDING),
        _fast(robot, gait.ddq, np.full(len(robot.joints), JOLT)),
        _closest(robot, excess),
        _fastest(robot, gait),
        _hardest(robot, gait),
    )


def _closest(robot: Robot, excess: Array) -> tuple[str, float]:
    k = int(excess.max(axis=0).argmax())
    return robot.joints[k], float(-excess[:, k].max())


def _fastest(robot: Robot, gait: Gait) -> tuple[str, float, float]:
    speeds = dict(zip(JOINTS, np.abs(gait.dq).max(axis=0).tolist(), strict=True))
    limits = zip(robot.joints, robot.velocity.tolist(), strict=True)
    known = [(joint, speeds[joint], limit) for joint, limit in limits if joint in speeds]
    return max(known, key=lambda x: x[1] / x[2])


def _hardest(robot: Robot, gait: Gait) -> tuple[str, float]:
    peaks = zip(JOINTS, np.abs(gait.ddq).max(axis=0).tolist(), strict=True)
    return max((pair for pair in peaks if pair[0] in robot.joints), key=lambda x: x[1])


def _fast(robot: Robot, rates: Array, limit: Array) -> dict[str, float]:
    peaks = np.abs(rates).max(axis=0)
    limits = dict(zip(robot.joints, limit.tolist(), strict=True))
    found = zip(JOINTS, peaks.tolist(), strict=True)
    return {joint: peak for joint, peak in found if joint in limits and peak > limits[joint]}

"""Gear ratios of a motor at a joint: reflected inertia, speed-torque line, thermal limit, and what fits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exo_pin.arguments import number, several
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.sizing.joint_load import JointLoad
from exo_pin.sizing.motor import Motor

LEAST_RATIO, LARGEST_RATIO = 1.0, 1000.0
"""Bounds of the ratios that are looked at (a choice)."""

_STEPS = 400
"""Ratios between them, each 1.7 % above the last; a range of fitting ratios narrower than that is missed."""

_BISECTIONS = 40  # a step is refined to rounding


@dataclass(frozen=True)
class GearedUse:
    """What a motor with one gear ratio has to give at a joint, as parts of what it can.

    Attributes:
        ratio: Turns of the motor for one of the joint.
        line: Use of the speed-torque line by the sample that comes nearest to it (`Motor.line_use`).
        thermal: Rms torque of the motor as a part of its continuous torque.
        inertia: Reflected inertia ratio^2 x rotor inertia at the joint [kg m^2].
    """

    ratio: float
    line: float
    thermal: float
    inertia: float

    @property
    def worst(self) -> float:
        """The larger of both uses."""
        return max(self.line, self.thermal)

    @property
    def fits(self) -> bool:
        """Whether the motor can do it: every point below the line and the rms below the continuous torque."""
        return self.worst <= 1.0

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {
            "ratio": self.ratio,
            "line_use": self.line,
            "thermal_use": self.thermal,
            "reflected_inertia_kgm2": self.inertia,
            "fits": self.fits,
        }


@dataclass(frozen=True)
class Ratios:
    """The gear ratios with which a motor fits a joint.

    Attributes:
        ranges: Lowest and highest ratio of every range that fits; none where no ratio does.
        best: Of them the ratio with the smallest thermal use; where none fits, that which comes nearest: the
            larger of both uses is smallest.
    """

    ranges: tuple[tuple[float, float], ...]
    best: GearedUse

    def facts(self) -> dict[str, Any]:
        """Plain values for JSON."""
        key = "best" if self.ranges else "nearest"
        return {"fitting_ratios": [list(pair) for pair in self.ranges], key: self.best.facts()}


def motor_torque(load: JointLoad, motor: Motor, ratio: float) -> Array:
    """Torque of the motor's shaft `(n,)`: the joint's and that which turns the rotor itself [N m].

    At the joint the rotor weighs ratio^2 J; the gear itself has no loss and no inertia here.

    Args:
        load: Of the joint.
        motor: The motor.
        ratio: Turns of the motor for one of the joint.

    Raises:
        DescriptionError: The ratio is not positive.
    """
    number("ratio", ratio, above=0.0)
    return load.torque / ratio + ratio * motor.rotor_inertia * load.acceleration


def geared(loads: JointLoad | Sequence[JointLoad], motor: Motor, ratio: float) -> GearedUse:
    """What a motor has to give with one ratio; of several loads the worst counts.

    Args:
        loads: Of one joint, or of the same joint on several walks.
        motor: The motor.
        ratio: Turns of the motor for one of the joint.

    Raises:
        DescriptionError: The ratio is not positive, or there is no load.
    """
    number("ratio", ratio, above=0.0)
    line = thermal = 0.0
    for load in _several(loads):
        torque = motor_torque(load, motor, ratio)
        line = max(line, float(motor.line_use(torque, ratio * load.speed).max()))
        thermal = max(thermal, load.rms(torque) / motor.continuous_torque)
    return GearedUse(ratio, line, thermal, ratio**2 * motor.rotor_inertia)


def fitting_ratios(loads: JointLoad | Sequence[JointLoad], motor: Motor) -> Ratios:
    """The ratios from `LEAST_RATIO` to `LARGEST_RATIO` with which a motor fits, and the best one.

    Args:
        loads: Of one joint, or of the same joint on several walks; a ratio must fit them all.
        motor: The motor.

    Raises:
        DescriptionError: There is no load.
    """
    walks = _several(loads)
    tried = np.geomspace(LEAST_RATIO, LARGEST_RATIO, _STEPS).tolist()
    uses = [geared(walks, motor, ratio) for ratio in tried]
    ranges = []
    for start, end in _runs([use.fits for use in uses]):
        low = tried[start] if start == 0 else _edge(walks, motor, tried[start - 1], tried[start])
        high = tried[end] if end == _STEPS - 1 else _edge(walks, motor, tried[end + 1], tried[end])
        ranges.append((low, high))
    if not ranges:
        return Ratios((), min(uses, key=lambda use: use.worst))
    edges = [geared(walks, motor, ratio) for pair in ranges for ratio in pair]
    inside = [use for use in uses if use.fits]
    return Ratios(tuple(ranges), min(inside + edges, key=lambda use: use.thermal))


def _runs(fits: list[bool]) -> list[tuple[int, int]]:
    """First and last index of every run of True."""
    starts = [k for k, fit in enumerate(fits) if fit and not (k and fits[k - 1])]
    ends = [k for k, fit in enumerate(fits) if fit and not (k + 1 < len(fits) and fits[k + 1])]
    return list(zip(starts, ends, strict=True))


def _edge(loads: tuple[JointLoad, ...], motor: Motor, outside: float, inside: float) -> float:
    """The last ratio that fits between one that does not and one that does."""
    for _ in range(_BISECTIONS):
        middle = math.sqrt(outside * inside)
        if geared(loads, motor, middle).fits:
            inside = middle
        else:
            outside = middle
    return inside


def _several(loads: JointLoad | Sequence[JointLoad]) -> tuple[JointLoad, ...]:
    found = (loads,) if isinstance(loads, JointLoad) else several("loads", loads)
    if not found:
        raise DescriptionError("loads is empty; one load or more is accepted")
    return found

"""Reference values: published ranges of healthy walks, scaled to leg length and walking speed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from exo_pin.arguments import number, table
from exo_pin.errors import GaitError
from exo_pin.gait.spatiotemporal import Number
from exo_pin.physics import GRAVITY

_DEVIATIONS = 2.0
"""A range is the mean plus and minus this many standard deviations: it holds 95 of 100 healthy people."""

_SCHWARTZ = "Schwartz 2008"
_BOHANNON = "Bohannon & Andrews 2011"
_DUSING = "Dusing & Thorpe 2007"
_SCHULZ = "Schulz 2012"

CITATIONS = {
    _SCHWARTZ: "Schwartz, Rozumalski, Trost, J Biomech 41 (2008) 1639-1650, supplement: typically developing "
    "children in five groups of speed; cadence, lengths and speed made dimensionless by leg length; taken at "
    "this walk's own dimensionless speed, mean +- 2 sd",
    _BOHANNON: "Bohannon, Andrews, Physiotherapy 97 (2011) 182-189: lowest and highest mean of 23 111 "
    "healthy adults grouped by sex and decade (women of 80 to 99 years, men of 40 to 49)",
    _DUSING: "Dusing, Thorpe, Gait & Posture 25 (2007) 135-139: 438 children of 1 to 10 years at the speed "
    "they chose; mean - 2 sd of the slowest age to mean + 2 sd of the quickest; for a stature below 1.43 m, "
    "which no adult is expected to have (WHO growth reference 2007: women at 19 years, mean - 3 sd)",
    _SCHULZ: "Schulz, J NeuroEng Rehabil 9:69 (2012), table 1: 28 healthy younger and older adults at their "
    "preferred speed on a level floor, in per cent of leg length, mean +- 2 sd",
}
"""The publications and the people measured. Leg length: here from the hip's centre to the sole."""

_ADULT_SPEED = (0.943, 1.434)
"""Lowest and highest group mean of normal walking [m/s]: Bohannon & Andrews 2011, abstract."""

_CHILD_SPEEDS = ((0.8205, 0.2528), (1.3363, 0.1544))
"""Mean and sd of the slowest and of the quickest age [m/s]: Dusing & Thorpe 2007, abstract."""

_SMALLEST_ADULT = 1.43
"""Mean minus three sd of the height of women at 19 years [m]: WHO growth reference 2007."""

_STEP_WIDTH = (0.140, 0.031)
"""Mean and sd in leg lengths: Schulz 2012, table 1, no obstacles, preferred speed."""

_GROUP_SPEEDS = (0.1721, 0.2902, 0.4294, 0.5599, 0.6938)
"""Mean dimensionless speeds v / sqrt(g L) of the groups of Schwartz 2008, very slow to very fast."""

_MEASURED_SPEEDS = (0.0904, 0.8442)
"""Slowest and quickest child of that source; beyond the outer groups' mean speeds their numbers hold."""

_AT_SPEED = {
    "cadence": ((0.3372, 0.4550, 0.5648, 0.6622, 0.7575), (0.0632, 0.0445, 0.0374, 0.0544, 0.0625)),
    "step_length": ((0.5099, 0.6400, 0.7596, 0.8497, 0.9220), (0.0707, 0.0561, 0.0437, 0.0557, 0.0733)),
    "stance": ((68.0, 62.0, 59.0, 58.0, 56.0), (5.0, 2.0, 2.0, 2.0, 2.0)),
    "double_support": ((36.0, 24.0, 19.0, 16.0, 14.0), (10.0, 4.0, 2.0, 3.0, 3.0)),
}
"""Means and sds of those groups: steps per sqrt(L / g), leg lengths, per cent of the cycle (whole there)."""


class Norm(NamedTuple):
    """The reference range of one number.

    Attributes:
        low: Lower end.
        high: Upper end.
        unit: Its unit.
        source: Key of `CITATIONS`.
    """

    low: float
    high: float
    unit: str
    source: str


def normal(numbers: Mapping[str, Number], *, leg_length: float, stature: float = math.nan) -> dict[str, Norm]:
    """The reference range of each number that has one.

    Walking speed decides nearly every other number, so cadence, lengths and phases are compared with people
    of the same dimensionless speed, v / sqrt(g L). Beyond the speeds of the source there is no range, nor is
    there one for symmetry and single times: no publication was checked.

    Args:
        numbers: Of `exo_pin.gait.spatiotemporal`.
        leg_length: Hip centre to sole [m]; NaN where it is unknown: then only speed has a range.
        stature: Height of the person [m], which separates children from adults; NaN: taken for an adult.

    Raises:
        GaitError: A length is no number, or `numbers` holds something else than a `Number`.
    """
    if not all(isinstance(one, Number) for one in table("numbers", numbers, error=GaitError).values()):
        raise GaitError("numbers holds something that is no Number; those of `spatiotemporal` are accepted")
    for name, length in (("leg_length", leg_length), ("stature", stature)):
        if not (isinstance(length, float) and math.isnan(length)):
            number(name, length, error=GaitError)
    known = {"speed": _chosen_speed(stature)}
    if leg_length > 0:
        known["step_width"] = _spread(*_STEP_WIDTH, leg_length, "m", _SCHULZ)
        speed = numbers["speed"].mean / math.sqrt(GRAVITY * leg_length) if "speed" in numbers else math.nan
        known |= _at_speed(speed, leg_length) if _MEASURED_SPEEDS[0] <= speed <= _MEASURED_SPEEDS[1] else {}
    return {name: known[_plain(name)] for name in numbers if _plain(name) in known}


def against_normal(
    numbers: Mapping[str, Number], *, leg_length: float, stature: float = math.nan
) -> dict[str, str]:
    """Each number that has a reference range: `within`, `below` or `above` it.

    Args:
        numbers: Of `exo_pin.gait.spatiotemporal`.
        leg_length: Hip centre to sole [m], or NaN.
        stature: Height of the person [m], or NaN.

    Raises:
        GaitError: As in `normal`.
    """
    verdicts = {}
    for name, norm in normal(numbers, leg_length=leg_length, stature=stature).items():
        mean = numbers[name].mean
        verdicts[name] = "below" if mean < norm.low else "above" if mean > norm.high else "within"
    return verdicts


def _plain(name: str) -> str:
    """Without the side."""
    return name.removeprefix("left_").removeprefix("right_")


def _chosen_speed(stature: float) -> Norm:
    """The speed that people of that size choose: a child's, or an adult's."""
    if not stature < _SMALLEST_ADULT:
        return Norm(*_ADULT_SPEED, "m/s", _BOHANNON)
    (slowest, slow_sd), (quickest, quick_sd) = _CHILD_SPEEDS
    return Norm(slowest - _DEVIATIONS * slow_sd, quickest + _DEVIATIONS * quick_sd, "m/s", _DUSING)


def _spread(mean: float, sd: float, scale: float, unit: str, source: str) -> Norm:
    return Norm(scale * (mean - _DEVIATIONS * sd), scale * (mean + _DEVIATIONS * sd), unit, source)


def _at_speed(speed: float, leg_length: float) -> dict[str, Norm]:
    """Ranges of people who walk at that dimensionless speed."""

    def _range(name: str, scale: float, unit: str, less_than: float = 0.0) -> Norm:
        mean, sd = (float(np.interp(speed, _GROUP_SPEEDS, values)) for values in _AT_SPEED[name])
        return _spread(abs(less_than - mean), sd, scale, unit, _SCHWARTZ)

    return {
        "cadence": _range("cadence", 60 * math.sqrt(GRAVITY / leg_length), "steps/min"),
        "step_length": _range("step_length", leg_length, "m"),
        "stride_length": _range("step_length", 2 * leg_length, "m"),
        "stance": _range("stance", 1, "%"),
        "swing": _range("stance", 1, "%", less_than=100.0),
        "double_support": _range("double_support", 1, "%"),
    }

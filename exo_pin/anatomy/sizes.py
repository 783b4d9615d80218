"""Sizes and masses of a body: meaning, unit and plausible range of each."""

from __future__ import annotations

import math
import numbers
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from exo_pin.anatomy.anthropometry import LIMITS_DEG
from exo_pin.anatomy.human import ranges_by_joint
from exo_pin.anatomy.names import JOINTS, SIDES
from exo_pin.errors import DescriptionError, UnknownNameError


class Size(NamedTuple):
    """A number that describes a body: plausible range, unit and meaning."""

    low: float
    high: float
    unit: str
    what: str


LEG_SIZES = {
    "thigh": Size(0.05, 1.0, "m", "hip centre to knee"),
    "shank": Size(0.05, 1.0, "m", "knee to ankle"),
    "ankle_height": Size(0.01, 0.4, "m", "ankle above the sole"),
    "foot_length": Size(0.05, 0.6, "m", "heel to toe tip"),
    "foot_width": Size(0.02, 0.3, "m", "width of the sole"),
    "heel": Size(0.005, 0.3, "m", "heel behind the ankle"),
    "ball": Size(0.02, 0.4, "m", "ball of the foot ahead of the ankle"),
    "thigh_mass": Size(0.01, 80.0, "kg", "the wearer's thigh"),
    "shank_mass": Size(0.01, 40.0, "kg", "the wearer's shank"),
    "foot_mass": Size(0.01, 15.0, "kg", "the wearer's foot"),
}
"""Sizes of one leg; a `Body` has each of them twice, as `left_...` and `right_...`."""

SIZES = {
    "stature": Size(0.5, 2.6, "m", "height of the person"),
    "mass": Size(2.0, 400.0, "kg", "mass of the person"),
    "hip_width": Size(0.03, 0.6, "m", "distance between the hip joint centres"),
    "waist_width": Size(0.1, 1.0, "m", "inner width of the waist ring"),
    **{f"{side}_{name}": size for side in SIDES for name, size in LEG_SIZES.items()},
    "pelvis_hardware": Size(0.01, 100.0, "kg", "waist ring, bracket and electronics"),
    "hip_hardware": Size(0.01, 30.0, "kg", "each of the two links between pelvis and thigh, a side"),
    "thigh_hardware": Size(0.01, 30.0, "kg", "thigh bar, knee motor and cuffs, a side"),
    "shank_hardware": Size(0.01, 30.0, "kg", "shank bar, ankle motor and cuffs, a side"),
    "ankle_hardware": Size(0.01, 30.0, "kg", "link between the two ankle axes, a side"),
    "foot_hardware": Size(0.01, 30.0, "kg", "foot plate, a side"),
}
"""Every number of a `Body`."""

_LARGEST = 10**15

DEFAULT_LIMITS = MappingProxyType(ranges_by_joint(LIMITS_DEG))
"""Default joint limits [rad] by joint name."""


def checked(name: str, value: object) -> float:
    """The value as a float within its plausible range.

    Raises:
        DescriptionError: It is no finite number, or implausible.
    """
    size = SIZES[name]
    accepted = f"{size.low:g} .. {size.high:g} {size.unit} is accepted"
    beyond = isinstance(value, int) and abs(value) > _LARGEST  # what no float holds
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or beyond or not math.isfinite(value):
        raise DescriptionError(f"{name} is {value!r}; a number of {accepted}")
    number = float(value)
    if not size.low <= number <= size.high:
        meant = _in_other_unit(number, size)
        raise DescriptionError(f"{name} = {number:g} {size.unit} is not plausible; {accepted}{meant}")
    return number


def _in_other_unit(number: float, size: Size) -> str:
    """The number that is meant where it was given in cm, mm or g, as a question; else nothing."""
    smaller = {"cm": 1e-2, "mm": 1e-3} if size.unit == "m" else {"g": 1e-3}
    for unit, scale in smaller.items():
        if size.low <= scale * number <= size.high:
            return f" (did you mean {scale * number:g} {size.unit}, which is {number:g} {unit}?)"
    return ""


def checked_limits(limits: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """All 12 joint limits [rad] in the order of `JOINTS`; those not given are the defaults.

    Raises:
        UnknownNameError: A joint is unknown.
        DescriptionError: A pair is not lower < upper within one turn.
    """
    complete = dict(DEFAULT_LIMITS)
    if not isinstance(limits, Mapping):
        raise DescriptionError(f"limits is {limits!r}; a table of joint: (lower, upper) is accepted")
    for name, pair in limits.items():
        if name not in complete:
            raise UnknownNameError("joint", name, JOINTS)
        try:
            lower, upper = (float(x) for x in pair)
        except (TypeError, ValueError):
            raise DescriptionError(f"limits of {name}: {pair!r}; a pair lower, upper is accepted") from None
        if not -math.pi <= lower < upper <= math.pi:
            raise DescriptionError(
                f"limits of {name}: {math.degrees(lower):g} .. {math.degrees(upper):g} deg; "
                "lower < upper within -180 .. 180 deg is accepted"
            )
        complete[name] = (lower, upper)
    return complete

"""What a file says of a person's body: sizes and mass, each with its origin."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

from exo_pin.anatomy.anthropometry import LENGTHS
from exo_pin.anatomy.human import DEFAULT_STATURE, MASS_INDEX_RANGE
from exo_pin.anatomy.names import SIDES, Side, SizeOrigin
from exo_pin.anatomy.sizes import SIZES
from exo_pin.frozen_fields import set_fields

LEG_PART = LENGTHS["thigh"] + LENGTHS["shank"]
"""Hip to ankle / stature, Drillis & Contini 1966."""

_LEG_PARTS = (0.35, 0.65)
"""Hip to ankle / stature of any person: from a small child's short legs to the longest."""

_SHARES = {
    "thigh": (0.13, 0.36),
    "shank": (0.13, 0.36),
    "ankle_height": (0.01, 0.09),
    "foot_length": (0.08, 0.25),
    "hip_width": (0.03, 0.18),
}
"""Length / stature of anybody: half and one and a half of the average, or more."""

_LEAST_SIDE = 0.85
"""A leg shorter than this part of the other is a mistake of a measure, not of a person."""


class Measure(NamedTuple):
    """One size of a person.

    Attributes:
        value: In metres or kilograms.
        origin: Where it comes from.
        detail: The same in words, with the source.
    """

    value: float
    origin: SizeOrigin
    detail: str = ""


@dataclass(frozen=True)
class Person:
    """Sizes and mass of a person as far as they are known.

    Sizes that no person has, or that do not go with each other, are left out; `remarks` states it.

    Attributes:
        sizes: By the names of the fields of `Body`, e.g. `stature`, `left_thigh`.
        others: What is stated and has no field there, e.g. the width of a knee [m].
        remarks: What is left out or was understood with a doubt, a sentence each.
    """

    sizes: Mapping[str, Measure] = field(default_factory=dict)
    others: Mapping[str, Measure] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        kept, why = _consistent(*_plausible(self.sizes))
        set_fields(
            self,
            sizes=MappingProxyType(kept),
            others=MappingProxyType(dict(self.others)),
            remarks=(*self.remarks, *why),
        )

    def over(self, other: Person) -> Person:
        """Both together; a size that both have is this one's."""
        remarks = tuple(dict.fromkeys((*self.remarks, *other.remarks)))
        return Person({**other.sizes, **self.sizes}, {**other.others, **self.others}, remarks)

    @property
    def mass(self) -> float | None:
        """Mass [kg], or None."""
        return self.sizes["mass"].value if "mass" in self.sizes else None

    @property
    def hip_to_ankle(self) -> float | None:
        """Mean of both legs [m]; None where no leg is known."""
        legs = list(_legs(self.sizes).values())
        return sum(legs) / len(legs) if legs else None


def _plausible(sizes: Mapping[str, Measure]) -> tuple[dict[str, Measure], list[str]]:
    """The sizes that a person can have, and a sentence for each other one."""
    kept, why = dict[str, Measure](), list[str]()
    for name, measure in sizes.items():
        size = SIZES[name]
        if math.isfinite(measure.value) and size.low <= measure.value <= size.high:
            kept[name] = measure
        else:
            why.append(
                f"{name.replace('_', ' ')} {measure.value:.4g} {size.unit} ({_words(measure)}) is no "
                f"person's and is not used; {size.low:g} .. {size.high:g} {size.unit} is accepted"
            )
    return kept, why


def _consistent(sizes: dict[str, Measure], why: list[str]) -> tuple[dict[str, Measure], list[str]]:
    """The sizes that go with each other: legs with each other and the stature, mass with the stature."""
    wrong: dict[str, str] = {}
    checks = (_unequal_legs, _unfitting_stature, _impossible_legs, _unfitting_shares, _unfitting_mass)
    found = True
    while found:  # what is left out changes the height that the rest is compared with
        found = False
        for check in checks:
            more = check({name: size for name, size in sizes.items() if name not in wrong})
            more = {name: text for name, text in more.items() if name in sizes}
            found, wrong = found or bool(more), wrong | more
    reasons = [f"{text}: not used" for text in dict.fromkeys(wrong.values())]
    return {name: size for name, size in sizes.items() if name not in wrong}, [*why, *reasons]


def _unequal_legs(sizes: Mapping[str, Measure]) -> dict[str, str]:
    """Both legs with the reason, where one is far shorter than the other."""
    legs = _legs(sizes)
    if len(legs) < len(SIDES) or min(legs.values()) >= _LEAST_SIDE * max(legs.values()):
        return {}
    shown = ", ".join(f"{side} {1e3 * leg:.0f} mm" for side, leg in legs.items())
    return dict.fromkeys(_names(SIDES), f"the legs differ too much from hip to ankle ({shown})")


def _unfitting_stature(sizes: Mapping[str, Measure]) -> dict[str, str]:
    """The legs with the reason where they do not go with the stature; it, where they were measured."""
    wrong: dict[str, str] = {}
    for side, leg in _legs(sizes).items():
        stature, thigh = sizes.get("stature"), sizes[f"{side}_thigh"]
        if stature is None or _LEG_PARTS[0] <= leg / stature.value <= _LEG_PARTS[1]:
            continue
        what = f"the {side} leg of {1e3 * leg:.0f} mm from hip to ankle ({_words(thigh)})"
        height = f"a height of {stature.value:.2f} m ({_words(stature)})"
        if thigh.origin == "file's header":
            wrong |= dict.fromkeys(_names([side]), f"{what} does not go with {height}")
        else:
            wrong["stature"] = f"{height} does not go with {what}"
    return wrong


def _impossible_legs(sizes: Mapping[str, Measure]) -> dict[str, str]:
    """All legs with the reason, where the stature that follows from them is nobody's."""
    height, size = _height(sizes), SIZES["stature"]
    if "stature" in sizes or height is None or size.low <= height <= size.high:
        return {}
    return dict.fromkeys(
        _names(SIDES), f"legs of {height * LEG_PART:.2f} m from hip to ankle are no person's"
    )


def _unfitting_shares(sizes: Mapping[str, Measure]) -> dict[str, str]:
    """Single lengths with the reason, where they are no share of the stature that anybody has."""
    height, wrong = _height(sizes) or DEFAULT_STATURE, dict[str, str]()
    for name, measure in sizes.items():
        low, high = _SHARES.get(name.removeprefix("left_").removeprefix("right_"), (0.0, math.inf))
        if not low <= measure.value / height <= high:
            what = f"{name.replace('_', ' ')} of {1e3 * measure.value:.0f} mm ({_words(measure)})"
            wrong[name] = f"a {what} does not go with {height:.2f} m of height"
    return wrong


def _height(sizes: Mapping[str, Measure]) -> float | None:
    """The stature [m], stated or by the legs; None where neither is known."""
    if "stature" in sizes:
        return sizes["stature"].value
    legs = _legs(sizes)
    return sum(legs.values()) / len(legs) / LEG_PART if legs else None


def _unfitting_mass(sizes: Mapping[str, Measure]) -> dict[str, str]:
    """The mass with the reason, where nobody of this stature has it."""
    mass, height = sizes.get("mass"), _height(sizes)
    low, high = MASS_INDEX_RANGE
    if mass is None or height is None or low <= mass.value / height**2 <= high:
        return {}
    return {"mass": f"a mass of {mass.value:g} kg ({_words(mass)}) does not go with {height:.2f} m of height"}


def _legs(sizes: Mapping[str, Measure]) -> dict[Side, float]:
    """Hip to ankle [m] of each leg whose thigh and shank are known."""
    return {
        side: sum(sizes[name].value for name in _names([side]))
        for side in SIDES
        if set(_names([side])) <= set(sizes)
    }


def _names(sides: Iterable[Side]) -> list[str]:
    """Names of the sizes of these legs from hip to ankle."""
    return [f"{side}_{name}" for side in sides for name in ("thigh", "shank")]


def _words(measure: Measure) -> str:
    return measure.detail or measure.origin

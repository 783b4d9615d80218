"""Sizes of the person of a marker trial, and the `Body` that they make."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.human import usual_mass
from exo_pin.anatomy.names import Segment, Sex, Side
from exo_pin.anatomy.sizes import SIZES
from exo_pin.errors import DescriptionError, GaitError
from exo_pin.formats.units import METRES_PER

Pair = tuple[float, float]

_LEG_PART = 0.245 + 0.246
"""Hip to ankle / stature, Drillis & Contini 1966 (in Winter)."""


class Sizes(NamedTuple):
    """Sizes of a body by its markers or its model [m]; pairs are left and right.

    Attributes:
        hip_width: Between the hip centres.
        thigh: Hip to knee, down.
        shank: Knee to ankle, down.
        foot: Heel to toe tip.
        ankle: Height of the ankle over the ground, or None.
        foot_measured: Whether the markers gave the feet; False where they follow from the legs.
        knee_aside: Where the knee centres are forward and left of straight below the hip, at rest.
        ankle_aside: The same of the ankle centres below the knee.
    """

    hip_width: float
    thigh: Pair
    shank: Pair
    foot: Pair
    ankle: float | None = None
    foot_measured: bool = True
    knee_aside: tuple[Pair, Pair] = ((0.0, 0.0), (0.0, 0.0))
    ankle_aside: tuple[Pair, Pair] = ((0.0, 0.0), (0.0, 0.0))

    def length(self, segment: Segment, side: Side | None) -> float:
        """The length that a segment's places are multiples of [m]."""
        if side is None:
            return self.hip_width
        lengths = {"thigh": self.thigh, "shank": self.shank, "foot": self.foot}
        return lengths[segment][SIDES.index(side)]

    @property
    def leg(self) -> Pair:
        """Hip to ankle along the segments, left and right."""
        return self.thigh[0] + self.shank[0], self.thigh[1] + self.shank[1]


def check_lengths(sizes: Sizes, unit: str) -> None:
    """Refuse lengths that no person has, before anything is fitted to them.

    Args:
        sizes: By markers.
        unit: What the file states its lengths in; "" where it states none.

    Raises:
        GaitError: With the unit in which they would be a person's.
    """
    size, stature = SIZES["stature"], float(np.mean(sizes.leg)) / _LEG_PART
    if size.low <= stature <= size.high:
        return
    says = f"; the file says {unit}" if unit else ""
    for word, metres in (("metres", 1.0), ("centimetres", 1e-2), ("millimetres", 1e-3)):
        fitting = stature * metres / METRES_PER.get(unit, 1.0)
        if size.low <= fitting <= size.high:
            raise GaitError(
                f"the markers are no person's, whose stature would be {stature:.2g} m: in {word}? "
                f"It would be {fitting:.2f} m then{says}"
            )
    raise GaitError(
        f"the markers are no person's, whose stature would be {stature:.2g} m{says}; "
        f"{size.low:g} .. {size.high:g} m is accepted"
    )


def body_of(sizes: Sizes, *, mass: float | None, sex: Sex) -> Body:
    """The body with these sizes; all others follow from the stature by the length of the legs.

    Args:
        sizes: By markers.
        mass: Of the person [kg]; None: by stature.
        sex: Whose segment masses.

    Raises:
        GaitError: No person has such sizes: wrong units or wrong markers.
    """
    stature = float(np.mean(sizes.leg)) / _LEG_PART
    measures = {"hip_width": sizes.hip_width}
    for k, side in enumerate(SIDES):
        measures[f"{side}_thigh"] = float(np.hypot(sizes.thigh[k], np.hypot(*sizes.knee_aside[k])))
        measures[f"{side}_shank"] = float(np.hypot(sizes.shank[k], np.hypot(*sizes.ankle_aside[k])))
        if sizes.foot_measured:
            measures[f"{side}_foot_length"] = sizes.foot[k]
        if sizes.ankle is not None:
            measures[f"{side}_ankle_height"] = sizes.ankle
    try:
        weight = usual_mass(stature) if mass is None else mass
        rounded = {name: round(value, 6) for name, value in measures.items()}
        return Body.from_stature(round(stature, 4), mass=weight, sex=sex, **rounded)
    except DescriptionError as error:
        raise GaitError(f"the markers are no person's: {error}") from error

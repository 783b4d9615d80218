"""Normal bands: mean and spread of the clinical angles over the cycle, published or of recordings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy.names import CLINICAL_ANGLES, ClinicalAngle, Speed
from exo_pin.arrays import Array
from exo_pin.clinic.clinical_cycles import ClinicalCycles
from exo_pin.errors import GaitError
from exo_pin.frozen_fields import set_fields
from exo_pin.gait.normative import published_curve, speed_named
from exo_pin.short_repr import short_repr

LEAST_RECORDINGS = 2
"""Recordings that make a band: one has no spread."""


class BandCurve(NamedTuple):
    """One angle of a band.

    Attributes:
        mean: `(101,)` [rad].
        sd: `(101,)` standard deviation between persons or recordings [rad].
        n: How many of them.
    """

    mean: Array
    sd: Array
    n: int

    def __repr__(self) -> str:
        return short_repr(self)


@dataclass(frozen=True, eq=False)
class NormalBand:
    """Angles of normal walks over the cycle, the same for both sides.

    Attributes:
        name: What it is called, e.g. `schwartz2008 free`.
        population: Whose walks they are, in words.
        curves: By angle; those that the source has.
    """

    name: str
    population: str
    curves: Mapping[ClinicalAngle, BandCurve]

    __repr__ = short_repr

    def __post_init__(self) -> None:
        ordered = {angle: self.curves[angle] for angle in CLINICAL_ANGLES if angle in self.curves}
        set_fields(self, curves=MappingProxyType(ordered))


_CHILDREN: dict[Speed, int] = {"very_slow": 77, "slow": 82, "free": 82, "fast": 76, "very_fast": 51}
"""Children of each speed (Schwartz 2008, supplementary workbook)."""


def published_band(speed: Speed = "free") -> NormalBand:
    """The band of Schwartz 2008 at one of its speeds: children.

    Raises:
        UnknownNameError: There is no such speed.
    """
    speed = speed_named(speed)
    n = _CHILDREN[speed]
    curves = {angle: BandCurve(*published_curve(speed, angle), n) for angle in CLINICAL_ANGLES}
    words = f"{n} typically developing children walking {speed.replace('_', ' ')} (Schwartz 2008)"
    return NormalBand(f"schwartz2008 {speed}", words, curves)


def recorded_band(walks: Sequence[Sequence[ClinicalCycles]], name: str) -> NormalBand:
    """The band of recordings; each counts once, by the mean of its sides' mean cycles.

    Args:
        walks: The cycles of each recording.
        name: What the band is called.

    Raises:
        GaitError: Fewer than two recordings have any angle.
    """
    curves = {}
    for angle in CLINICAL_ANGLES:
        each = [np.mean(found, axis=0) for sides in walks if (found := _means(sides, angle))]
        if len(each) >= LEAST_RECORDINGS:
            curves[angle] = BandCurve(np.mean(each, axis=0), np.std(each, axis=0, ddof=1), len(each))
    if not curves:
        raise GaitError(f"a band takes {LEAST_RECORDINGS} recordings with whole cycles; found {len(walks)}")
    return NormalBand(name, f"{len(walks)} recordings, {name}", curves)


def _means(sides: Sequence[ClinicalCycles], angle: ClinicalAngle) -> list[Array]:
    return [side.mean(angle) for side in sides if angle in side.curves]

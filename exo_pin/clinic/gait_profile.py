"""Gait Profile Score and its movement map (Baker 2009): how far a walk is from the mean of normal walks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy.names import SIDES, ClinicalAngle, Side
from exo_pin.arrays import Array
from exo_pin.clinic.clinical_cycles import ClinicalCycles
from exo_pin.clinic.normal_band import NormalBand
from exo_pin.short_repr import short_repr

CITATION = (
    "R. Baker, J. L. McGinley, M. H. Schwartz, S. Beynon, A. Rozumalski, H. K. Graham, O. Tirosh, "
    '"The Gait Profile Score and Movement Analysis Profile", Gait & Posture 30 (2009) 265-269'
)

NINE: tuple[ClinicalAngle, ...] = (
    "pelvis_tilt",
    "pelvis_obliquity",
    "pelvis_rotation",
    "hip_flexion",
    "hip_adduction",
    "hip_rotation",
    "knee_flexion",
    "ankle_dorsiflexion",
    "foot_progression",
)
"""The variables of the score."""

_OF_THE_PELVIS = NINE[:3]


@dataclass(frozen=True, eq=False)
class GaitProfile:
    """Scores of a walk against a band.

    A variable's score is the root mean square over the cycle of the mean cycle's difference from the band's
    mean. A side's is the root mean square of its nine; the walk's that of fifteen: the pelvis's by the left
    side alone, the others by both.

    Attributes:
        variables: Side and angle -> score [rad]; what is not known is left out.
        sides: Side -> its score [rad]; NaN where one of the nine is not known.
        overall: Of the walk [rad]; NaN likewise.
        spread: Standard deviation of each side's score from cycle to cycle [rad]; NaN for one cycle.
        band: What the walk is compared with.
    """

    variables: Mapping[tuple[Side, ClinicalAngle], float]
    sides: Mapping[Side, float]
    overall: float
    spread: Mapping[Side, float]
    band: NormalBand

    __repr__ = short_repr

    @property
    def missing(self) -> tuple[ClinicalAngle, ...]:
        """Those of the nine that one side or both do not have."""
        return tuple(x for x in NINE if any((side, x) not in self.variables for side in SIDES))


def gait_profile(sides: Sequence[ClinicalCycles], band: NormalBand) -> GaitProfile:
    """The scores of a walk.

    Args:
        sides: Its cycles, of `clinical_cycles`.
        band: The normal walks.
    """
    variables = {
        (cycle.side, angle): _rms(cycle.mean(angle) - band.curves[angle].mean)
        for cycle in sides
        for angle in NINE
        if angle in cycle.curves and angle in band.curves
    }
    scores = {side: _score(variables, [(side, angle) for angle in NINE]) for side in SIDES}
    both = [
        (side, angle) for side in SIDES for angle in NINE if side == "left" or angle not in _OF_THE_PELVIS
    ]
    spread = dict.fromkeys(SIDES, math.nan) | {cycle.side: _spread(cycle, band) for cycle in sides}
    return GaitProfile(variables, scores, _score(variables, both), spread, band)


def _score(
    variables: Mapping[tuple[Side, ClinicalAngle], float], wanted: Iterable[tuple[Side, ClinicalAngle]]
) -> float:
    return _rms(np.array([variables.get(key, math.nan) for key in wanted]))


def _spread(cycle: ClinicalCycles, band: NormalBand) -> float:
    """Standard deviation (n - 1) of the score of the single cycles [rad]."""
    if len(cycle) < 2 or not set(NINE) <= set(cycle.curves) & set(band.curves):
        return math.nan
    away = np.stack([cycle.curves[angle] - band.curves[angle].mean for angle in NINE])  # (9, k, 101)
    return float(np.sqrt((away**2).mean(axis=(0, 2))).std(ddof=1))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))

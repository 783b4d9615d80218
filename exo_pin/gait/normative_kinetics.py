"""Normative moments and powers of the joints over the gait cycle, mean and spread between children."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import Speed
from exo_pin.arguments import MOST_SAMPLES, count
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.gait.normative import series, speed_named
from exo_pin.gait.schwartz2008_kinetics import MEAN_KINETICS, SD_KINETICS


class KineticBand(NamedTuple):
    """Mean and standard deviation `(n, 12)`, in the order of `JOINTS`; NaN where the source has no curve."""

    mean: Array
    sd: Array


def normative_moments(speed: Speed = "free", *, samples: int = 100) -> KineticBand:
    """Joint moments of typically developing children, each leg from its own heel strike on [N m/kg].

    Schwartz, Rozumalski and Trost, J Biomech 41 (2008) 1639-1650: flexion of hip and knee, adduction of the
    hip, dorsiflexion of the ankle. Positive the way the joint is named; moments of muscles, not of loads.

    Args:
        speed: One of `SPEEDS`.
        samples: Number of samples in the cycle.

    Raises:
        UnknownNameError: There is no such speed.
        GaitError: There is no sample, or more than a million.
    """
    return _band(speed, samples, "{}_moment")


def normative_powers(speed: Speed = "free", *, samples: int = 100) -> KineticBand:
    """Joint powers of typically developing children, at the sagittal joints, as `normative_moments` [W/kg].

    Args:
        speed: One of `SPEEDS`.
        samples: Number of samples in the cycle.

    Raises:
        UnknownNameError: There is no such speed.
        GaitError: There is no sample, or more than a million.
    """
    return _band(speed, samples, "{}_power")


_SAGITTAL = {"hip_flexion": "hip", "knee_flexion": "knee", "ankle_dorsiflexion": "ankle"}


def _band(speed: Speed, samples: int, curve: str) -> KineticBand:
    speed = speed_named(speed)
    phase = np.arange(count("samples", samples, 1, MOST_SAMPLES, error=GaitError)) / samples
    mean, sd = np.full((2, len(phase), len(JOINTS)), np.nan)
    for k, joint in enumerate(JOINTS):
        movement = joint.partition("_")[2]
        name = curve.format(_SAGITTAL.get(movement, "") if "power" in curve else movement)
        if name in MEAN_KINETICS[speed]:
            mean[:, k] = series(MEAN_KINETICS[speed][name], phase)
            sd[:, k] = series(SD_KINETICS[speed][name], phase)
    return KineticBand(mean, sd)

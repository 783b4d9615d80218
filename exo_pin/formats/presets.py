"""Sign conventions of OpenSim models: one entry in PRESETS per model family."""

from __future__ import annotations

from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from exo_pin.errors import UnknownNameError

ONE_SIDED = 0.9
"""Part of the knee's excursion that must lie on one side of 0 before its sign is believed."""

BENT = np.radians(15)
"""A walk bends the knee more than this; smaller angles could be flexion or hyperextension [rad]."""


class Preset(NamedTuple):
    """What must be known of a model to read its coordinates.

    Attributes:
        name: What the user calls it.
        knee: +1 if `knee_angle` is positive in flexion, -1 if negative.
        mid_hip: Midway between the hip centres in the pelvis's own frame, OpenSim axes [m]: the generic
            model's, because a file of coordinates does not carry the scaled one.
    """

    name: str
    knee: int
    mid_hip: tuple[float, float, float]


PRESETS = MappingProxyType(
    {
        preset.name: preset
        for preset in (
            # Delp 1990 and its descendants gait2354 and gait2392 (their .osim files, joint hip_r)
            Preset("opensim-gait2392", -1, (-0.0707, -0.0661, 0.0)),
            # Rajagopal 2016 and its descendants (Rajagopal2016.osim, joint hip_r)
            Preset("opensim-rajagopal", +1, (-0.056276, -0.07849, 0.0)),
        )
    }
)
"""Name -> preset."""


def preset(name: str) -> Preset:
    """The preset of that name; raises `UnknownNameError`."""
    if name not in PRESETS:
        raise UnknownNameError("preset", name, PRESETS)
    return PRESETS[name]


def inferred(knees: NDArray[np.float64]) -> tuple[Preset, float] | None:
    """Find the preset whose knee sign makes `(n, 2)` knee angles [rad] those of a walk.

    Returns:
        The preset and the part (0 to 1) of the excursion on its side, or None if that is not clear: less
        than 90 % on one side, or knees that never bend 15 degrees.
    """
    up, down = max(float(knees.max()), 0.0), max(float(-knees.min()), 0.0)
    if max(up, down) < BENT or max(up, down) < ONE_SIDED * (up + down):
        return None
    sign = 1 if up > down else -1
    return next(entry for entry in PRESETS.values() if entry.knee == sign), max(up, down) / (up + down)

"""Samples of a recorded walk that stand out of their curve: joint angles and the place of the pelvis."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exo_pin import signals
from exo_pin.anatomy import JOINTS
from exo_pin.gait import Gait

_LEAST_ANGLE_DEG, _LEAST_PLACE_MM = 1.0, 10.0
"""Smaller deviations are noise: the fastest curves of recordings at 60 Hz stay below."""


class CurveOutlier(NamedTuple):
    """A sample that stands out of its curve.

    Attributes:
        curve: A joint, or `pelvis_x`, `pelvis_y`, `pelvis_z`.
        time: When [s].
        off: Deviation from the cubic through its neighbours, in `unit`.
        unit: `"deg"` or `"mm"`.
    """

    curve: str
    time: float
    off: float
    unit: str


def curve_outliers(gait: Gait) -> tuple[CurveOutlier, ...]:
    """The outliers of the joint angles, then those of the pelvis, each sorted by time."""
    found = _outliers(gait, np.degrees(gait.q), JOINTS, "deg", _LEAST_ANGLE_DEG)
    if gait.base is not None:
        place = 1e3 * gait.base[:, :3, 3]
        found += _outliers(gait, place, ("pelvis_x", "pelvis_y", "pelvis_z"), "mm", _LEAST_PLACE_MM)
    return tuple(found)


def _outliers(
    gait: Gait, values: np.ndarray, names: tuple[str, ...], unit: str, least: float
) -> list[CurveOutlier]:
    found = signals.outliers(gait.time, values, names, least=least)
    return [CurveOutlier(x.name, x.time, x.off, unit) for x in found]

"""Samples of a recorded walk that stand out of their curve: joint angles and the place of the pelvis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from exo_pin import signals
from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.gait import Event, Gait, manner

_LEAST_ANGLE_DEG, _LEAST_PLACE_MM = 1.0, 10.0
"""Smaller deviations are noise: the fastest curves of recordings at 60 Hz stay below."""


_ALIKE = 1 / 3
"""A deviation returns where one of this part of its size is, of either sign: how a bend shows depends on
where between the samples it lies ..."""

_AROUND = 3
"""... and within so many samples: strikes are known to a frame or two."""


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
    """The outliers of the joint angles, then those of the pelvis, each sorted by time.

    The curves of a run have sharp bends where feet land and leave: what returns at the same moment of half of
    the steps is its motion and no outlier. That needs the events of the run.
    """
    curves = _Curves(np.degrees(gait.q), JOINTS, "deg", _LEAST_ANGLE_DEG)
    parts = [curves]
    if gait.base is not None:
        place = 1e3 * gait.base[:, :3, 3]
        parts.append(_Curves(place, ("pelvis_x", "pelvis_y", "pelvis_z"), "mm", _LEAST_PLACE_MM))
    strikes = _strikes(gait) if manner(gait) == "run" else ()
    return tuple(x for part in parts for x in _outliers(gait.time, part, strikes))


class _Curves(NamedTuple):
    """Curves `(n, m)` of one kind with their m names, unit and least deviation of an outlier."""

    values: Array
    names: tuple[str, ...]
    unit: str
    least: float


def _outliers(time: Array, curves: _Curves, strikes: Sequence[Event]) -> list[CurveOutlier]:
    values, names, unit, least = curves
    found = signals.outliers(time, values, names, least=least)
    if strikes and found:
        peaks = signals.spikes(time, values, factor=0.0)
        found = tuple(x for x in found if not _returns(time, peaks, names, strikes, x))
    return [CurveOutlier(x.name, x.time, x.off, unit) for x in found]


def _strikes(gait: Gait) -> tuple[Event, ...]:
    return tuple(event for event in gait.events if event.kind == "heel_strike")


def _returns(
    time: Array, peaks: Array, names: tuple[str, ...], strikes: Sequence[Event], found: signals.Outlier
) -> bool:
    """Whether a deviation has its like at the same moment of most other steps.

    Steps of the other foot are those of the other leg's joint; of the pelvis only steps of one foot compare.

    Args:
        time: `(n,)` [s].
        peaks: `(n, m)` deviations that are the largest around them, in the curves' units.
        names: Of the m curves.
        strikes: Heel strikes of both feet.
        found: The deviation.
    """
    nearest = min(strikes, key=lambda event: abs(event.time - found.time))
    seen = []
    for strike in strikes:
        name = found.name if strike.side == nearest.side else _mirrored(found.name)
        at = strike.time + found.time - nearest.time
        if strike is nearest or name not in names or not time[2] <= at <= time[-3]:
            continue
        k = int(np.abs(time - at).argmin())
        around = np.abs(peaks[max(k - _AROUND, 0) : k + _AROUND + 1, names.index(name)])
        seen.append(bool(around.max(initial=0.0) >= _ALIKE * abs(found.off)))
    return bool(seen) and float(np.mean(seen)) >= 0.5


def _mirrored(name: str) -> str:
    """The same joint of the other leg; empty for the pelvis."""
    side, _, movement = name.partition("_")
    return {"left": f"right_{movement}", "right": f"left_{movement}"}.get(side, "")

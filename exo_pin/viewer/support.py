"""How the balance support carries the pelvis, so that the picture stands on its ground."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import CORNERS, SIDES
from exo_pin.gait import Gait
from exo_pin.viewer.contact import Intervals, lowest_corners, samples

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Support:
    """The pelvis as shown.

    Attributes:
        base: `(n, 4, 4)` pose of the pelvis.
        belt_speed: Of the treadmill, backwards [m/s]: the mean speed of the standing foot.
        note: What was done to the pelvis, in one sentence.
    """

    base: Array
    belt_speed: float
    note: str


def carried(gait: Gait, base: Array, corners: Array, stance: Intervals) -> Support:
    """Lift or lower the whole walk by one constant, so that the lowest standing corner is on the ground.

    Args:
        gait: The walk.
        base: `(n, 4, 4)` pose of the pelvis as given.
        corners: `(n, 8, 3)` positions of `CORNERS` with that base [m].
        stance: Side -> intervals on the ground.
    """
    time = gait.time - gait.time[0]
    heights = lowest_corners(corners)
    standing = {side: samples(stance, side, time) for side in SIDES}
    low = [heights[side][standing[side]].min() for side in SIDES if standing[side].any()]
    shift = -min(low, default=min(heights[side].min() for side in SIDES))
    shown = base.copy()
    shown[:, 2, 3] += shift
    origin = "the gait's own" if gait.base is not None else "held still"
    note = (
        f"The pelvis's motion is {origin}, shifted vertically by {1000 * shift:+.1f} mm as a whole so that "
        "the lowest standing sole corner is on the ground."
    )
    return Support(shown, _belt_speed(gait, corners, standing), note)


def _belt_speed(gait: Gait, corners: Array, standing: dict[str, NDArray[np.bool_]]) -> float:
    """Mean backward speed of the standing feet [m/s]."""
    x = {s: corners[:, [c.startswith(s) for c in CORNERS], 0].mean(axis=1) for s in SIDES}
    if gait.periodic:
        velocity = {side: (np.roll(x[side], -1) - np.roll(x[side], 1)) for side in SIDES}
        step = 2 * gait.duration / len(gait)
    else:
        velocity = {side: np.gradient(x[side], gait.time) for side in SIDES}
        step = 1.0
    speeds = np.concatenate([velocity[side][standing[side]] / step for side in SIDES])
    return max(float(-speeds.mean()), 0.0) if len(speeds) else 0.0

"""Where a pelvis would stand if a device held it: upright at its mean place, looking its mean way."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait.heading import mean_heading


def stand(time: Array, base: Array, *, periodic: bool) -> Array:
    """T_world_stand (n, 4, 4) for a pelvis T_world_pelvis (n, 4, 4) at times (n,) [s].

    It goes evenly along with a walk over ground, and stands still under a periodic one.
    """
    place = base[:, :3, 3]
    held = np.tile(np.eye(4), (len(place), 1, 1))
    held[:, :3, 3] = travel(time, place, periodic=periodic)
    c, s = mean_heading(base)
    held[:, :2, :2] = [[c, -s], [s, c]]
    return held


def travel(time: Array, place: Array, *, periodic: bool) -> Array:
    """The even travel (n, 3) of a place (n, 3) [m]: level along a line, or periodic and hence at rest."""
    even = np.tile(place.mean(axis=0), (len(place), 1))
    if not periodic:
        away = time - time.mean()
        even[:, :2] += np.outer(away, away @ place[:, :2] / (away @ away))
    return even

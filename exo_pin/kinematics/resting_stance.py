"""The resting stance: a pelvis as a device holds it, upright at its mean place and heading."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait.heading import mean_heading


def stand(time: Array, base: Array, *, periodic: bool) -> Array:
    """The stand T_world_stand (n, 4, 4) that holds a pelvis upright.

    It travels evenly with a walk over ground, and rests under a periodic one.

    Args:
        time: `(n,)` [s].
        base: T_world_pelvis `(n, 4, 4)`.
        periodic: Whether the walk repeats.
    """
    place = base[:, :3, 3]
    held = np.tile(np.eye(4), (len(place), 1, 1))
    held[:, :3, 3] = travel(time, place, periodic=periodic)
    c, s = mean_heading(base)
    held[:, :2, :2] = [[c, -s], [s, c]]
    return held


def travel(time: Array, place: Array, *, periodic: bool) -> Array:
    """The even part `(n, 3)` of a motion [m]: horizontal at constant velocity, or at rest where it repeats.

    Args:
        time: `(n,)` [s].
        place: `(n, 3)` positions [m].
        periodic: Whether the motion repeats.
    """
    even = np.tile(place.mean(axis=0), (len(place), 1))
    if not periodic:
        away = time - time.mean()
        even[:, :2] += np.outer(away, away @ place[:, :2] / (away @ away))
    return even

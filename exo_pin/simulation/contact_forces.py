"""Forces of the floor on each foot, from the sensors at the sole corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.arrays import Array
from exo_pin.simulation.engine_forces import corner_forces

_LOADED = 1.0
"""Vertical force from which a centre of pressure is given [N]."""


@dataclass(frozen=True, eq=False)
class FloorForces:
    """Forces of the floor, by foot: left, right.

    Attributes:
        force: `(N, 2, 3)` world axes [N].
        moment: `(N, 2, 3)` about the world's origin [N m].
        point: `(N, 2, 3)` centre of pressure on the floor [m]; NaN where the foot bears less than 1 N.
    """

    force: Array
    moment: Array
    point: Array


def floor_forces(sensed: Array) -> FloorForces:
    """Sum the contacts of each foot, as MuJoCo's `sensordata` (N, S) of `sensing_model` gives them."""
    force, place = corner_forces(sensed)
    total, about = force.sum(axis=2), np.cross(place, force).sum(axis=2)
    point = np.full(total.shape, np.nan)
    loaded = total[..., 2] > _LOADED
    point[loaded, 0] = -about[loaded, 1] / total[loaded, 2]
    point[loaded, 1] = about[loaded, 0] / total[loaded, 2]
    point[loaded, 2] = 0.0
    return FloorForces(total, about, point)

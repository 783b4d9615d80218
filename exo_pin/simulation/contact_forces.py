"""Forces of the floor on each foot, from the contacts that the loop wrote down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import CORNERS, SIDES
from exo_pin.arrays import Array
from exo_pin.simulation.recording import Recording

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


def floor_forces(record: Recording) -> FloorForces:
    """Sum the contacts of each foot."""
    frames = record.frame.reshape(*record.frame.shape[:2], 3, 3)
    force = np.einsum("ncij,nci->ncj", frames, record.force)  # rows of a frame are its axes in the world
    used = np.arange(force.shape[1]) < record.contacts[:, None]
    force[~used] = 0.0
    moment = np.cross(record.point, force)
    left = record.corner < len(CORNERS) // len(SIDES)
    masks = np.stack([left, ~left], axis=1)[..., None]  # (N, 2, 8, 1)
    total, about = (np.sum(masks * x[:, None], axis=2) for x in (force, moment))
    point = np.full(total.shape, np.nan)
    loaded = total[..., 2] > _LOADED
    point[loaded, 0] = -about[loaded, 1] / total[loaded, 2]
    point[loaded, 1] = about[loaded, 0] / total[loaded, 2]
    point[loaded, 2] = 0.0
    return FloorForces(total, about, point)

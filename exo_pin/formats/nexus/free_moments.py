"""Free moments of exported force plates: what is left of the moment at the centre of pressure."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array

_LOADED = 50.0
"""Vertical force of samples that show the point of reference [N]; below, the centre of pressure is noise."""

_FEWEST = 10
"""Samples that the point of reference is fitted to."""

_CLOSE = 1.0
"""Largest rms of the horizontal moments at the centre of pressure [N m], where force and moment meet it."""


def free_moments(force: Array, moment: Array, point: Array) -> Array | None:
    """`(m, 3)` free moments [N m]; None where force, moment and centre of pressure do not agree.

    The export does not say which point its moments refer to: the middle of a plate, its sensors or the
    origin. It follows from the numbers, as nothing but a moment about the vertical acts at the centre of
    pressure: `M = (p - o) x F + T` with `T_x = T_y = 0`, linear in o.

    Args:
        force: `(m, 3)` [N].
        moment: `(m, 3)` about one fixed point o [N m].
        point: `(m, 3)` centre of pressure p [m]; unused while nothing loads the plate.
    """
    loaded = np.abs(force[:, 2]) > _LOADED
    loaded &= np.isfinite(point).all(axis=1) & np.isfinite(moment).all(axis=1)
    if loaded.sum() < _FEWEST:
        return None
    left = moment - np.cross(point, force)  # = T - o x F
    fx, fy, fz = force[loaded].T
    zero = np.zeros_like(fz)
    rows = np.vstack([np.stack([zero, -fz, fy], axis=1), np.stack([fz, zero, -fx], axis=1)])
    origin, *_ = np.linalg.lstsq(rows, left[loaded, :2].T.ravel(), rcond=None)
    at_point = left + np.cross(origin, force)
    if np.sqrt((at_point[loaded, :2] ** 2).mean()) > _CLOSE:
        return None
    free = np.where(loaded[:, None], at_point, 0.0)
    free[:, :2] = 0.0
    return np.asarray(free)

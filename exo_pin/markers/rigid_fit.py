"""Rigid transforms that fit points to measured points (Kabsch)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait.rigid_poses import nearest_pose


def rigid_fit(places: Mapping[str, Array], paths: Mapping[str, Array]) -> Array:
    """Poses that bring a body's points nearest to their measured paths, by least squares (Kabsch).

    Args:
        places: Marker -> `(3,)` place in the body [m].
        paths: Marker -> `(n, 3)` path in the world [m]; NaN where it was not seen.

    Returns:
        `(n, 4, 4)` T_world_body; NaN where fewer than three markers are seen.
    """
    local = np.array([places[name] for name in places if name in paths]).reshape(-1, 3)
    seen = np.stack([paths[name] for name in places if name in paths], axis=1) if len(local) else None
    if seen is None:
        return np.full((0, 4, 4), np.nan)
    out = np.full((len(seen), 4, 4), np.nan)
    there = ~np.isnan(seen).any(axis=2)
    for mask in np.unique(there, axis=0):
        if mask.sum() >= 3:
            frames = (there == mask).all(axis=1)
            out[frames] = _fitted(local[mask], seen[frames][:, mask])
    return out


def _fitted(local: Array, seen: Array) -> Array:
    """`(n, 4, 4)` for `(k, 3)` points that are all seen, `(n, k, 3)`."""
    centre, target = local.mean(axis=0), seen.mean(axis=1)
    H = np.einsum("nki,kj->nij", seen - target[:, None], local - centre)
    T = np.tile(np.eye(4), (len(seen), 1, 1))
    U, _, Vt = np.linalg.svd(H)
    flip = np.linalg.det(U @ Vt)
    U[:, :, 2] *= flip[:, None]
    T[:, :3, :3] = U @ Vt
    T = nearest_pose(T)
    T[:, :3, 3] = target - T[:, :3, :3] @ centre
    return T

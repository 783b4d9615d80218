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
        `(n, 4, 4)` T_world_body; NaN where not all markers are seen.
    """
    local = np.array(list(places.values()))
    seen = np.stack([paths[name] for name in places], axis=1)
    out = np.full((len(seen), 4, 4), np.nan)
    good = ~np.isnan(seen).any(axis=(1, 2))
    if len(local) < 3 or not good.any():
        return out
    centre, target = local.mean(axis=0), seen[good].mean(axis=1)
    H = np.einsum("nki,kj->nij", seen[good] - target[:, None], local - centre)
    T = np.tile(np.eye(4), (int(good.sum()), 1, 1))
    U, _, Vt = np.linalg.svd(H)
    flip = np.linalg.det(U @ Vt)
    U[:, :, 2] *= flip[:, None]
    T[:, :3, :3] = U @ Vt
    T = nearest_pose(T)
    T[:, :3, 3] = target - T[:, :3, :3] @ centre
    out[good] = T
    return out

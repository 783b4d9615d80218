"""The heading of a walk: the horizontal direction in which the pelvis faces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait.gait import Gait
from exo_pin.gait.rigid_poses import about

_LEAST_MEAN = 0.5
"""Length of the mean of the unit headings below which a walk has no heading: it turns around."""

_LEVEL = 1e-9
"""A horizontal part shorter than this has no direction: the pelvis lies on its face or back."""


def headings(base: Array) -> Array:
    """`(n, 2)` unit headings of a pelvis with poses `(n, 4, 4)`, sample by sample."""
    forward = base[:, :2, 0]
    return np.asarray(forward / np.maximum(np.linalg.norm(forward, axis=1, keepdims=True), _LEVEL))


def mean_heading(base: Array) -> Array:
    """`(2,)` unit vector: the mean heading of a pelvis with poses `(n, 4, 4)`."""
    forward = base[:, :2, 0].mean(axis=0)
    return np.asarray(forward / max(float(np.linalg.norm(forward)), _LEVEL))


def yaw(base: Array) -> Array:
    """`(n,)` headings as angles from x about the vertical, without jumps [rad]."""
    return np.unwrap(np.arctan2(base[:, 1, 0], base[:, 0, 0]))


def heading(gait: Gait) -> float | None:
    """Mean heading of a walk as an angle from x about the vertical [rad].

    None if the pelvis does not move, or the walk turns around.
    """
    if gait.base is None:
        return None
    x, y = gait.base[:, :2, 0].mean(axis=0)
    return float(np.arctan2(y, x)) if np.hypot(x, y) > _LEAST_MEAN else None


def turned(gait: Gait, angle: float) -> Gait:
    """The walk turned about the world's vertical by an angle [rad]."""
    if gait.base is None:
        return gait
    T = np.eye(4)
    T[:3, :3] = about((0.0, 0.0, 1.0), angle)
    return replace(gait, base=T @ gait.base)

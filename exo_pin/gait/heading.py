"""Where a recorded walk goes: laboratories lay their axes as they like."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin.gait.gait import Gait
from exo_pin.gait.rigid import about

STRAIGHT = 0.5
"""Length of the mean of the unit headings below which a walk has no direction: it turns around."""


def heading(gait: Gait) -> float | None:
    """Mean direction in which the pelvis faces, counted from x about the vertical [rad].

    None where there is none: the pelvis does not move, or the walk turns around.
    """
    if gait.base is None:
        return None
    mean = complex(gait.base[:, 0, 0].mean(), gait.base[:, 1, 0].mean())
    return float(np.angle(mean)) if abs(mean) > STRAIGHT else None


def turned(gait: Gait, angle: float) -> Gait:
    """The walk turned about the world's vertical by an angle [rad]."""
    if gait.base is None:
        return gait
    T = np.eye(4)
    T[:3, :3] = about((0.0, 0.0, 1.0), angle)
    return replace(gait, base=T @ gait.base)

"""A recorded walk turned so that it goes along x: laboratories lay their axes as they like."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from exo_pin.gait import Gait

STRAIGHT = 0.5
"""Length of the mean of the unit headings below which a walk has no direction: it turns around."""


def ahead(gait: Gait) -> tuple[Gait, str]:
    """The walk, turned about the vertical so that its pelvis faces x on the mean; and what was done."""
    if gait.base is None:
        return gait, "x; the pelvis is held still"
    heading = complex(gait.base[:, 0, 0].mean(), gait.base[:, 1, 0].mean())
    if abs(heading) < STRAIGHT:
        return gait, "the file's own x axis: the walk turns around and has no one direction"
    angle = float(np.angle(heading))
    T = np.eye(4)
    T[:2, :2] = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    how = f"the pelvis's mean heading, {np.degrees(angle) + 0.0:.1f} deg from the walk's own x axis"
    return replace(gait, base=T @ gait.base), how

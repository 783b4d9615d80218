"""The normal band of an angle as layers of a chart."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy.names import ClinicalAngle
from exo_pin.clinic import NormalBand
from exo_pin.clinic.clinical_cycles import PERCENT
from exo_pin.report.draw.chart import Band, Curve

MOST_LINES = 12
"""Cycles that are drawn one by one; more become a band of 1 standard deviation."""


def normal_layers(band: NormalBand | None, angle: ClinicalAngle) -> tuple[list[Band], list[Curve]]:
    """Spread and mean of normal walks in degrees; nothing without a band of this angle."""
    if band is None or angle not in band.curves:
        return [], []
    found = band.curves[angle]
    mean, sd = np.degrees(found.mean), np.degrees(found.sd)
    spread = Band(PERCENT, mean - sd, mean + sd, "#7d8894", "normal, ±1 sd", 0.28)
    return [spread], [Curve(PERCENT, mean, "#8b95a0", "normal, mean", dash="5 3", width=1.1)]

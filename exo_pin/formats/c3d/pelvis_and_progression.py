"""Plug-in Gait's angles beside the leg joints: pelvis, foot progression, the knee's other two planes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.anatomy.names import SIDES, ClinicalAngle, Side
from exo_pin.arrays import Array
from exo_pin.gait.further_angles import FurtherAngles
from exo_pin.gait.trial import Markers

_OUTPUTS: dict[ClinicalAngle, tuple[str, int]] = {
    "pelvis_tilt": ("PelvisAngles", 0),
    "pelvis_obliquity": ("PelvisAngles", 1),
    "pelvis_rotation": ("PelvisAngles", 2),
    "knee_adduction": ("KneeAngles", 1),
    "knee_rotation": ("KneeAngles", 2),
    "foot_progression": ("FootProgressAngles", 2),
}
"""Angle -> output, after L or R, and which of its three components; the signs are ours."""


def further_angles(path: Path, trial: Markers) -> FurtherAngles | None:
    """Those of the outputs that the trial has; None without any."""
    values: dict[tuple[Side, ClinicalAngle], Array] = {}
    for side in SIDES:
        for angle, (output, axis) in _OUTPUTS.items():
            found = trial.angles.get(f"{side[0].upper()}{output}")
            if found is not None:
                empty = (found == 0).all(axis=1)  # a frame without the output
                values[side, angle] = np.where(empty, np.nan, found[:, axis])
    if not values or len(trial) < 2:
        return None
    return FurtherAngles(trial.time, values, f"{path.name}, Plug-in Gait")

"""A walk as a file of OpenSim coordinates (.mot, .sto)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.formats.opensim.coordinate_names import KNEES, LEG_COORDINATES
from exo_pin.formats.opensim.pelvis_axes import PELVIS_ANGLES, PELVIS_TRANSLATIONS, to_opensim
from exo_pin.formats.opensim.storage import write_storage
from exo_pin.formats.sign_presets import PRESETS, Preset
from exo_pin.formats.tables.metadata import Metadata, comment_lines
from exo_pin.gait import Gait

_RAJAGOPAL = PRESETS["opensim-rajagopal"]


def write_gait(gait: Gait, path: Path, *, preset: Preset = _RAJAGOPAL) -> None:
    """Write coordinates in degrees, with events and source in comments of the header.

    Args:
        gait: The walk.
        path: The file.
        preset: The model family it is for; decides the knee's sign and the mid-hip's place in the pelvis.

    Raises:
        FormatError: The file cannot be written.
    """
    names, parts = ["time"], [gait.time[:, None]]
    if gait.base is not None and preset.mid_hip is not None:
        angles, translation = to_opensim(gait.base, preset.mid_hip)
        names += [*PELVIS_ANGLES, *PELVIS_TRANSLATIONS]
        parts += [np.degrees(angles), translation]
    sign = "positive" if preset.knee > 0 else "negative"
    remarks = [
        f"Written by exo_pin: angles in degrees, translations in metres; knee_angle is {sign} in flexion.",
        f"# preset: {preset.name}",
        *comment_lines(Metadata(gait.events, gait.periodic, gait.source)),
    ]
    signs = [preset.knee if name in KNEES else 1 for name in LEG_COORDINATES]
    values = np.hstack([*parts, np.degrees(gait.q) * signs])
    write_storage(path, "Coordinates", remarks, [*names, *LEG_COORDINATES], values, degrees=True)

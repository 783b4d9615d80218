"""The summary of a study: mean and largest error of each device over all walks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exo_pin.study.study_table import Row


def summary(rows: Sequence[Row]) -> tuple[tuple[str, ...], list[list[str]]]:
    """Columns and lines: sole error of the best motion by device, mean and largest over the walks [mm].

    Args:
        rows: Of a study, at least one.
    """
    best = [row for row in rows if row.motion == "best"]
    pelvises = list(dict.fromkeys(row.pelvis for row in best))
    lines = []
    for device in dict.fromkeys(row.device for row in best):
        mine = [row for row in best if row.device == device]
        errors = [[row.sole_rms_mm for row in mine if row.pelvis == pelvis] for pelvis in pelvises]
        numbers = [f"{value:.1f}" for some in errors for value in (np.mean(some), max(some))]
        lines.append([device, str(mine[0].motors), *numbers])
    columns = [f"pelvis {pelvis}: {what}" for pelvis in pelvises for what in ("mean", "worst")]
    return ("device", "motors", *columns), sorted(lines, key=lambda line: float(line[2]))

"""Samples of a recording that stand out of their curve, for `info` and `cycles`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.gait import Gait

LEAST = {"deg": 1.0, "mm": 10.0}
"""Smaller deviations are noise: what recordings of 60 Hz have in their quickest curves stays below."""

SHOWN = 6
"""Lines that are printed; JSON holds all."""


def facts(gait: Gait) -> list[dict[str, Any]]:
    """Joint angles and the pelvis's place: which sample, when, how far off the curve around it."""
    import numpy as np

    from exo_pin import signals
    from exo_pin.anatomy import JOINTS

    curves = [(np.degrees(gait.q), JOINTS, "deg")]
    if gait.base is not None:
        curves.append((1e3 * gait.base[:, :3, 3], ("pelvis_x", "pelvis_y", "pelvis_z"), "mm"))
    return [
        {"curve": found.name, "time_s": found.time, "off": found.off, "unit": unit}
        for values, names, unit in curves
        for found in signals.outliers(gait.time, values, names, least=LEAST[unit])
    ]


def show(found: Sequence[dict[str, Any]]) -> None:
    """One line for each of the furthest."""
    ordered = sorted(found, key=lambda x: -abs(x["off"]))
    for x in ordered[:SHOWN]:
        print(
            f"outlier: {x['curve']} at {x['time_s']:.3f} s is {x['off']:+.1f} {x['unit']} off its neighbours"
        )
    if len(ordered) > SHOWN:
        print(f"... and {len(ordered) - SHOWN} outliers more (--json lists all)")

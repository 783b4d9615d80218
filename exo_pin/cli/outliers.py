"""Outliers of a recording's curves, for `info` and `cycles`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from exo_pin.gait import Gait

_LEAST = {"deg": 1.0, "mm": 10.0}
"""Smaller deviations are noise: what recordings of 60 Hz have in their quickest curves stays below."""

_SHOWN = 6
"""Lines that are printed; JSON holds all."""


class CurveOutlier(NamedTuple):
    """A sample that stands out of its curve.

    Attributes:
        curve: A joint, or a coordinate of the pelvis.
        time: When [s].
        off: How far it is off the curve around it.
        unit: Of `off`: deg or mm.
    """

    curve: str
    time: float
    off: float
    unit: str

    def to_json(self) -> dict[str, Any]:
        """As `--json` prints it."""
        return {"curve": self.curve, "time_s": self.time, "off": self.off, "unit": self.unit}


def find(gait: Gait) -> tuple[CurveOutlier, ...]:
    """The outliers among joint angles and the pelvis's place."""
    import numpy as np

    from exo_pin import signals
    from exo_pin.anatomy import JOINTS

    curves = [(np.degrees(gait.q), JOINTS, "deg")]
    if gait.base is not None:
        curves.append((1e3 * gait.base[:, :3, 3], ("pelvis_x", "pelvis_y", "pelvis_z"), "mm"))
    return tuple(
        CurveOutlier(found.name, found.time, found.off, unit)
        for values, names, unit in curves
        for found in signals.outliers(gait.time, values, names, least=_LEAST[unit])
    )


def show(found: Sequence[CurveOutlier]) -> None:
    """One line for each of the furthest."""
    ordered = sorted(found, key=lambda x: -abs(x.off))
    for x in ordered[:_SHOWN]:
        print(f"outlier: {x.curve} at {x.time:.3f} s is {x.off:+.1f} {x.unit} off its neighbours")
    if len(ordered) > _SHOWN:
        print(f"... and {len(ordered) - _SHOWN} outliers more (--json lists all)")

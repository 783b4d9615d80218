"""Angles of a recording that the 12 joints do not have: pelvis, foot progression, the knee's other two."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from exo_pin.anatomy.names import CLINICAL_ANGLES, SIDES, ClinicalAngle, Side
from exo_pin.arguments import real, word
from exo_pin.arrays import Array
from exo_pin.errors import GaitError
from exo_pin.frozen_fields import set_fields
from exo_pin.gait.validation import check_time, frozen


@dataclass(frozen=True, eq=False)
class FurtherAngles:
    """Angles beside a walk's joints, as the walk's file has them.

    Attributes:
        time: `(n,)` strictly increasing [s].
        values: Side and angle -> `(n,)` [rad], signs as of `ClinicalAngle`; NaN where the file has none.
        source: Where they come from, in words.

    Raises:
        GaitError: Shapes or times are unusable.
        UnknownNameError: There is no such side or angle.
    """

    time: Array
    values: Mapping[tuple[Side, ClinicalAngle], Array]
    source: str

    def __post_init__(self) -> None:
        set_fields(self, time=frozen(self.time, "time"))
        check_time(self.time, periodic=False)
        kept = {}
        if not isinstance(self.values, Mapping):
            raise GaitError("values is no mapping; (side, angle) -> (n,) is accepted")
        for (side, angle), values in self.values.items():
            word("side", side, SIDES)
            word("angle", angle, CLINICAL_ANGLES)
            name = f"{side} {angle}"
            kept[side, angle] = frozen(
                real(name, values, (len(self.time),), gaps=True, error=GaitError), name
            )
        set_fields(self, values=MappingProxyType(kept))

    def at(self, side: Side, angle: ClinicalAngle, times: Array) -> Array | None:
        """An angle at any times `(...)` [s], linear between samples; NaN outside; None: it is not there."""
        values = self.values.get((side, angle))
        if values is None:
            return None
        return np.asarray(np.interp(times, self.time, values, left=np.nan, right=np.nan))

"""Units of length, angle and moment that files state, in SI."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy.names import AngleUnit
from exo_pin.errors import UnknownNameError

METRES_PER = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
METRES_PER |= {"millimeters": 1e-3, "centimeters": 1e-2, "meters": 1.0, "millimetres": 1e-3, "metres": 1.0}
RADIANS_PER = {"deg": np.pi / 180, "degrees": np.pi / 180, "rad": 1.0, "radians": 1.0}
NEWTON_METRES_PER = {"Nmm": 1e-3, "Nm": 1.0, "N.m": 1.0, "N.mm": 1e-3}

ANGLE_UNITS: tuple[AngleUnit, ...] = ("deg", "rad")
"""Units that the user chooses from."""


def angle_unit(name: str) -> AngleUnit:
    """The unit of that name; raises `UnknownNameError`."""
    for unit in ANGLE_UNITS:
        if unit == name:
            return unit
    raise UnknownNameError("unit of angles", name, ANGLE_UNITS)

"""Units of length, angle and moment that files state, in SI."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy.names import AngleUnit, LengthUnit
from exo_pin.errors import UnknownNameError

METRES_PER = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
for _prefix, _metres in (("milli", 1e-3), ("centi", 1e-2), ("", 1.0)):
    METRES_PER |= dict.fromkeys([f"{_prefix}met{end}" for end in ("er", "ers", "re", "res")], _metres)
RADIANS_PER = {
    **dict.fromkeys(("deg", "degs", "degree", "degrees"), np.pi / 180),
    **dict.fromkeys(("rad", "rads", "radian", "radians"), 1.0),
}
_NEWTON_METRES_PER = {"nmm": 1e-3, "ncm": 1e-2, "nm": 1.0}
_NEWTONS = ("n", "newton", "newtons")

LENGTH_UNITS: tuple[LengthUnit, ...] = ("mm", "cm", "m")
"""Units of length that the user chooses from."""

ANGLE_UNITS: tuple[AngleUnit, ...] = ("deg", "rad")
"""Units that the user chooses from."""


def angle_unit(name: str) -> AngleUnit:
    """The unit of that name; raises `UnknownNameError`."""
    for unit in ANGLE_UNITS:
        if unit == name:
            return unit
    raise UnknownNameError("unit of angles", name, ANGLE_UNITS)


def metres_per(stated: str) -> float | None:
    """Metres per unit of length in a file's words (`MM`, `Millimeters`, `[mm]`); None: not known."""
    return METRES_PER.get(_letters(stated))


def radians_per(stated: str) -> float | None:
    """Radians per unit of angle in a file's words; None: not known."""
    return RADIANS_PER.get(_letters(stated.replace("°", "deg")))


def newton_metres_per(stated: str) -> float | None:
    """Newton metres per unit of moment in a file's words (`N.mm`, `Nm`); None: not known."""
    return _NEWTON_METRES_PER.get(_letters(stated))


def is_newton(stated: str) -> bool:
    """Whether a file's unit of force is the newton."""
    return _letters(stated) in _NEWTONS


def _letters(stated: str) -> str:
    return "".join(letter for letter in stated.lower() if letter.isalpha())

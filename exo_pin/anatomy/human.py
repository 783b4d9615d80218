"""Human limits and averages: extreme joint ranges, hyperextension of the knee, mass by stature."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from exo_pin.anatomy.names import MOVEMENTS, SIDES, Movement, joint

DEFAULT_STATURE = 1.75
"""Height of the default person [m]."""

DEFAULT_MASS = 70.0
"""Mass of the default person [kg]."""

MASS_INDEX_RANGE = (8.0, 90.0)
"""Mass over squared stature [kg/m^2] of anybody: from starving children to the heaviest adults."""

_BODY_MASS_INDEX = DEFAULT_MASS / DEFAULT_STATURE**2
"""Mass over squared stature [kg/m^2] of a person whose mass is unknown: that of the default person."""


def ranges_by_joint(degrees: Mapping[Movement, tuple[float, float]]) -> dict[str, tuple[float, float]]:
    """Ranges (lower, upper) [deg] by movement as ranges [rad] by joint name, the same left and right."""
    return {
        joint(side, movement): (math.radians(degrees[movement][0]), math.radians(degrees[movement][1]))
        for side in SIDES
        for movement in MOVEMENTS
    }


_EXTREME_DEG: dict[Movement, tuple[float, float]] = {
    "hip_flexion": (-45.0, 130.0),
    "hip_adduction": (-50.0, 45.0),
    "hip_rotation": (-70.0, 70.0),
    "knee_flexion": (-20.0, 160.0),
    "ankle_dorsiflexion": (-65.0, 50.0),
    "ankle_inversion": (-50.0, 60.0),
}

EXTREME_RANGES = MappingProxyType(ranges_by_joint(_EXTREME_DEG))
"""What a person's joint can do at the very most, lower and upper [rad] by joint name: clinical ranges of
motion with a margin of about 20 degrees."""

HYPEREXTENDED_KNEE = math.radians(-10.0)
"""No healthy knee is straighter than this for long [rad]; recordings hyperextend by up to 5 degrees."""


def usual_mass(stature: float) -> float:
    """Mass [kg] of a person of this stature [m] by `_BODY_MASS_INDEX`."""
    return _BODY_MASS_INDEX * stature**2

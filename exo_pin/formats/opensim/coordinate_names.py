"""Names of OpenSim's coordinates, by joint."""

from __future__ import annotations

from exo_pin.anatomy import SIDES, joint
from exo_pin.anatomy.names import Movement

_OF_MOVEMENT: dict[Movement, str] = {
    "hip_flexion": "hip_flexion",
    "hip_adduction": "hip_adduction",
    "hip_rotation": "hip_rotation",
    "knee_flexion": "knee_angle",
    "ankle_dorsiflexion": "ankle_angle",
    "ankle_inversion": "subtalar_angle",
}
"""Movement -> coordinate without `_r` or `_l`; all signs but the knee's are this package's."""

COORDINATE_OF = {
    joint(side, movement): f"{name}_{side[0]}" for side in SIDES for movement, name in _OF_MOVEMENT.items()
}
"""Joint -> coordinate, in the order of `JOINTS`."""

LEG_COORDINATES = tuple(COORDINATE_OF.values())

KNEES = ("knee_angle_l", "knee_angle_r")

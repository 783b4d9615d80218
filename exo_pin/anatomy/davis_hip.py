"""Hip centre from the front spine of the pelvis by the clinical length of the leg (Davis 1991).

Davis, Ounpuu, Tyburski, Gage, Hum Mov Sci 10 (1991) 575-587, with the constants of Plug-in Gait (Vicon,
Plug-in Gait Reference Guide). Leg length is the clinical one: front spine (ASIS) to medial malleolus.
"""

from __future__ import annotations

import math

import numpy as np

from exo_pin.arrays import Array

_SIDEWAYS, _DOWN = 0.5, 0.314
"""Davis's angles theta and beta [rad]: 28.4 and 18 degrees."""


def from_front_spine(leg_length: float, marker_radius: float = 0.0) -> Array:
    """Forward, towards the middle and up `(3,)` from a front spine of the pelvis to its hip centre [m].

    The axes are those of Plug-in Gait's pelvis: the plane through the front spines and the sacrum is level.

    Args:
        leg_length: Front spine to medial malleolus [m].
        marker_radius: Of a marker on the front spine from whose centre is measured [m].
    """
    size = 0.115 * leg_length - 0.0153
    behind = 0.1288 * leg_length - 0.04856 + marker_radius  # front spine to greater trochanter, lying
    level = size * math.cos(_SIDEWAYS)
    forward = level * math.sin(_DOWN) - behind * math.cos(_DOWN)
    up = -level * math.cos(_DOWN) - behind * math.sin(_DOWN)
    return np.array([forward, size * math.sin(_SIDEWAYS), up])


def hip_to_ankle(leg_length: float) -> float:
    """Hip centre to ankle [m] of a leg of this clinical length, which begins at the front spine.

    The leg is measured lying and straight, so it lacks the hip's depth below the front spine. In the one
    recording at hand that has both, the joint centres are 1 and 2.5 % nearer to each other.

    Args:
        leg_length: Front spine to medial malleolus [m].
    """
    return leg_length + float(from_front_spine(leg_length)[2])

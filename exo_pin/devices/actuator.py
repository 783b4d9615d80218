"""Actuators: default torques, speeds and ranges of the joints where no source gives them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple


class Actuator(NamedTuple):
    """Largest torque [N m] and speed [rad/s] at a joint (a slide: [N] and [m/s])."""

    effort: float
    velocity: float


DEFAULT_ACTUATORS: Mapping[str, Actuator] = MappingProxyType(
    {
        "hip_flexion": Actuator(150.0, 8.0),
        "hip_adduction": Actuator(120.0, 5.0),
        "hip_rotation": Actuator(60.0, 5.0),
        "knee_flexion": Actuator(150.0, 12.0),
        "ankle_dorsiflexion": Actuator(180.0, 8.0),
        "ankle_inversion": Actuator(60.0, 5.0),
        "toe_dorsiflexion": Actuator(40.0, 10.0),
        "pelvis_forward": Actuator(1000.0, 1.0),
        "pelvis_left": Actuator(1000.0, 1.0),
        "pelvis_up": Actuator(1500.0, 1.0),
    }
)
"""Torques and speeds where no source gives them, a design choice: above what a 70 kg person's level walking
at any of Schwartz's (2008) speeds needs; the paper gives none. Toes and slides likewise."""

ADDED_JOINT_RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "toe_dorsiflexion": (math.radians(-20.0), math.radians(60.0)),
        "pelvis_forward": (-0.10, 0.10),
        "pelvis_left": (-0.10, 0.10),
        "pelvis_up": (-0.10, 0.10),
    }
)
"""Ranges of the added joints where no source gives them [rad, m], a design choice: normal walking moves the
pelvis by about +-0.03 m."""

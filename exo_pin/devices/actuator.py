"""Actuators: default torques, speeds and ranges of the joints where no source gives them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

ACCELERATION_LIMIT = 200.0
"""Largest joint acceleration [rad/s^2], a design choice: no source gives one for these devices; the very fast
walk of Schwartz (2008) requires up to 150."""


class Actuator(NamedTuple):
    """What a joint can do at most (a slide: [N], [m/s], [m/s^2]).

    Attributes:
        effort: Torque [N m].
        velocity: Speed [rad/s].
        acceleration: Acceleration [rad/s^2]; None: that of `DEFAULT_ACCELERATIONS`.
    """

    effort: float
    velocity: float
    acceleration: float | None = None


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

DEFAULT_ACCELERATIONS: Mapping[str, float] = MappingProxyType(
    {name: math.inf if name.startswith("pelvis_") else ACCELERATION_LIMIT for name in DEFAULT_ACTUATORS}
)
"""Largest accelerations where no source gives them: `ACCELERATION_LIMIT`, and none for slides [m/s^2]."""

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

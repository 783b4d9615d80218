"""Anatomy: names of joints, feet and sides, and the sizes and masses of the wearer."""

from exo_pin.anatomy.body import Body, Leg
from exo_pin.anatomy.names import (
    CORNERS,
    FEET,
    HIP_ORDERS,
    JOINTS,
    MOVEMENTS,
    SIDES,
    joint,
)

__all__ = ["CORNERS", "FEET", "HIP_ORDERS", "JOINTS", "MOVEMENTS", "SIDES", "Body", "Leg", "joint"]

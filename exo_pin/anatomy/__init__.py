"""Names and sizes: joints, feet and sides of the legs, and the body that wears the exoskeleton."""

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

"""Demand on joints, required against available: range, speed, acceleration, torque, power."""

from exo_pin.demand.joint_demand import JointDemand, acceleration_limits, joint_demands
from exo_pin.demand.quantity import PeakDemand, RangeDemand, peak_demands, range_demands
from exo_pin.devices.actuator import ACCELERATION_LIMIT

__all__ = [
    "ACCELERATION_LIMIT",
    "JointDemand",
    "PeakDemand",
    "RangeDemand",
    "acceleration_limits",
    "joint_demands",
    "peak_demands",
    "range_demands",
]

"""Demand on joints, required against available: range, speed, acceleration, torque, power."""

from exo_pin.demand.joint_demand import ACCELERATION_LIMIT, JointDemand, joint_demands
from exo_pin.demand.quantity import PeakDemand, RangeDemand, peak_demands, range_demands

__all__ = [
    "ACCELERATION_LIMIT",
    "JointDemand",
    "PeakDemand",
    "RangeDemand",
    "joint_demands",
    "peak_demands",
    "range_demands",
]

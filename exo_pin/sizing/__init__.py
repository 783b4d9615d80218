"""Sizing of motors and gears: what the joints of a walk need against what a motor can do."""

from exo_pin.sizing.gear import GearedUse, Ratios, fitting_ratios, geared, motor_torque
from exo_pin.sizing.joint_load import JointLoad, Spring
from exo_pin.sizing.joint_sizing import JointSizing
from exo_pin.sizing.motor import Motor
from exo_pin.sizing.motor_file import example_motors, find_motor, load_motor
from exo_pin.sizing.walk_sizing import Sizing, joint_loads, size, stride_time
from exo_pin.sizing.worst_case import QUANTITIES, SizingCase, WorstCase, bodies, worst_cases

__all__ = [
    "QUANTITIES",
    "GearedUse",
    "JointLoad",
    "JointSizing",
    "Motor",
    "Ratios",
    "Sizing",
    "SizingCase",
    "Spring",
    "WorstCase",
    "bodies",
    "example_motors",
    "find_motor",
    "fitting_ratios",
    "geared",
    "joint_loads",
    "load_motor",
    "motor_torque",
    "size",
    "stride_time",
    "worst_cases",
]

"""Sizing of motors and gears: what the joints of a walk need against what a motor can do."""

from exo_pin.sizing.motor import Motor
from exo_pin.sizing.motor_file import example_motors, find_motor, load_motor

__all__ = ["Motor", "example_motors", "find_motor", "load_motor"]

"""Devices as data: which joints an exoskeleton drives, how it holds the pelvis, what its actuators can do."""

from exo_pin.devices.actuator import Actuator
from exo_pin.devices.catalogue import DEVICES, EXO12, find
from exo_pin.devices.device import SLIDES, TOES, Device, both, movement_of, subset
from exo_pin.devices.device_file import load

__all__ = [
    "DEVICES",
    "EXO12",
    "SLIDES",
    "TOES",
    "Actuator",
    "Device",
    "both",
    "find",
    "load",
    "movement_of",
    "subset",
]

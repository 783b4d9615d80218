"""A walk on other robots: humanoids, or any URDF with two legs."""

from exo_pin.retarget.machine import Machine, find, load, ready
from exo_pin.retarget.retargeted import Retargeted
from exo_pin.retarget.target_robots import TARGETS, Target
from exo_pin.retarget.transfer import joint_by_joint, retarget

__all__ = [
    "TARGETS",
    "Machine",
    "Retargeted",
    "Target",
    "find",
    "joint_by_joint",
    "load",
    "ready",
    "retarget",
]

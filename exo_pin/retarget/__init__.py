"""Retargeting of a walk to other robots: humanoids, or any URDF with two legs."""

from exo_pin.retarget.biped import Biped, as_biped, find, load
from exo_pin.retarget.retargeted import LimitUse, Retargeted
from exo_pin.retarget.target_robots import TARGETS, Target
from exo_pin.retarget.transfer import joint_by_joint, retarget

__all__ = [
    "TARGETS",
    "Biped",
    "LimitUse",
    "Retargeted",
    "Target",
    "as_biped",
    "find",
    "joint_by_joint",
    "load",
    "retarget",
]

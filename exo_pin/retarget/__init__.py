"""A walk on other robots: humanoids whose legs have the exoskeleton's six joints."""

from exo_pin.retarget.targets import TARGETS, Target, find, load
from exo_pin.retarget.transfer import Retargeted, retarget

__all__ = ["TARGETS", "Retargeted", "Target", "find", "load", "retarget"]

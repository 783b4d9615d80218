"""Feasibility of a walk on a device: limits, self-collision, reach, and how much of the walk is possible.

Torques count where they are given (`exo_pin.gait.Torques`), e.g. by `exo_pin.dynamics.torques`.
"""

from exo_pin.feasible.amplitude import LARGEST_AMPLITUDE
from exo_pin.feasible.assessment import feasible
from exo_pin.feasible.collision import Nearest, nearest
from exo_pin.feasible.concession import LEAST_SHARE, Concession
from exo_pin.feasible.device_fit import Fit
from exo_pin.feasible.device_walk import DeviceWalk
from exo_pin.feasible.feasibility import LARGEST_CADENCE, Failure, Feasibility
from exo_pin.feasible.grading import device_walk, pelvis_by_default

__all__ = [
    "LARGEST_AMPLITUDE",
    "LARGEST_CADENCE",
    "LEAST_SHARE",
    "Concession",
    "DeviceWalk",
    "Failure",
    "Feasibility",
    "Fit",
    "Nearest",
    "device_walk",
    "feasible",
    "nearest",
    "pelvis_by_default",
]

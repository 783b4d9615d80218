"""Dynamics of a walk: joint torques by inverse dynamics, ground reaction by plates or predicted, residual."""

from exo_pin.dynamics.base_motion import Motion, in_pelvis_axes, motion
from exo_pin.dynamics.floating_robot import floating_robot, mass_of
from exo_pin.dynamics.free_reaction import FREE_CUTOFF
from exo_pin.dynamics.ground_forces import GroundForces
from exo_pin.dynamics.inverse import torques
from exo_pin.dynamics.newton_euler import generalized_forces, in_world_axes
from exo_pin.dynamics.plate_checks import WeightCheck
from exo_pin.dynamics.residual import Residual
from exo_pin.dynamics.walk_dynamics import Dynamics
from exo_pin.signals import CUTOFF

__all__ = [
    "CUTOFF",
    "FREE_CUTOFF",
    "Dynamics",
    "GroundForces",
    "Motion",
    "Residual",
    "WeightCheck",
    "floating_robot",
    "generalized_forces",
    "in_pelvis_axes",
    "in_world_axes",
    "mass_of",
    "motion",
    "torques",
]

"""Whether a device can do a walk with a person: limits, self-collision, reach, and how much is possible.

Torques are asked where they are given (`exo_pin.gait.Torques`): working them out needs the ground's forces.
"""

from exo_pin.demand import ACCELERATION, JointDemand, demands
from exo_pin.feasible.amplitude import MOST
from exo_pin.feasible.collision import Nearest, nearest
from exo_pin.feasible.feasibility import FASTEST, Feasibility
from exo_pin.feasible.judge import feasible

__all__ = [
    "ACCELERATION",
    "FASTEST",
    "MOST",
    "Feasibility",
    "JointDemand",
    "Nearest",
    "demands",
    "feasible",
    "nearest",
]

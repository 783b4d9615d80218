"""Whether a device can do a walk with a person: limits, self-collision, reach, and how much is possible.

Torques are asked where they are given (`exo_pin.gait.Torques`): working them out needs the ground's forces.
"""

from exo_pin.feasible.collision import Nearest, nearest
from exo_pin.feasible.judge import feasible
from exo_pin.feasible.limits import ACCELERATION, JointDemand, demands
from exo_pin.feasible.scale import MOST
from exo_pin.feasible.verdict import FASTEST, Feasibility

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

"""Walking: footsteps become a walk of the whole body that nothing has to hold, by the inverted pendulum."""

from exo_pin.walking.footstep_file import load_footsteps, save_footsteps
from exo_pin.walking.footsteps import Footstep, Footsteps, footsteps
from exo_pin.walking.pendulum import (
    com_of_zmp,
    divergent_component,
    fall,
    orbital_energy,
    time_constant,
    zmp_of_com,
)
from exo_pin.walking.preview import Preview
from exo_pin.walking.recorded_footsteps import recorded_footsteps
from exo_pin.walking.support_polygon import convex_hull, margin
from exo_pin.walking.walk_plan import Plan, plan_walk

__all__ = [
    "Footstep",
    "Footsteps",
    "Plan",
    "Preview",
    "com_of_zmp",
    "convex_hull",
    "divergent_component",
    "fall",
    "footsteps",
    "load_footsteps",
    "margin",
    "orbital_energy",
    "plan_walk",
    "recorded_footsteps",
    "save_footsteps",
    "time_constant",
    "zmp_of_com",
]

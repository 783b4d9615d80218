"""Simulation: the exoskeleton walks by torques in MuJoCo, carried by its support."""

from exo_pin.simulation.mujoco_model import Floor, mujoco_model, mujoco_spec
from exo_pin.simulation.pelvis_support import PelvisSupport
from exo_pin.simulation.plant import Plant
from exo_pin.simulation.push import Push
from exo_pin.simulation.run import Run
from exo_pin.simulation.run_gaits import motor_torques, walked, wanted
from exo_pin.simulation.simulate import simulate
from exo_pin.simulation.walk_verdict import Verdict

__all__ = [
    "Floor",
    "PelvisSupport",
    "Plant",
    "Push",
    "Run",
    "Verdict",
    "motor_torques",
    "mujoco_model",
    "mujoco_spec",
    "simulate",
    "walked",
    "wanted",
]

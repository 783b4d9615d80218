"""Control: controllers of the motors, and patients who walk with them."""

from exo_pin.control.controller import Controller, Reference, reset
from exo_pin.control.controller_file import load_controller
from exo_pin.control.controllers import CONTROLLERS, find_controller
from exo_pin.control.passive_moments import passive_moments
from exo_pin.control.patient import PATIENTS, Patient, shares
from exo_pin.control.patient_file import find_patient, load_patient
from exo_pin.control.users_code import raised_where
from exo_pin.control.walk_torques import JointTorque, StrideWork, WalkTorques, stride_work, walk_torques

__all__ = [
    "CONTROLLERS",
    "PATIENTS",
    "Controller",
    "JointTorque",
    "Patient",
    "Reference",
    "StrideWork",
    "WalkTorques",
    "find_controller",
    "find_patient",
    "load_controller",
    "load_patient",
    "passive_moments",
    "raised_where",
    "reset",
    "shares",
    "stride_work",
    "walk_torques",
]

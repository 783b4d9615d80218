"""Loss of a walk on a device: its best motion towards the recorded feet, and the remaining errors."""

from exo_pin.compare.best_motion import DeviceMotion, best, dressed, projected, robot_for
from exo_pin.compare.comparison import Comparison, compare
from exo_pin.compare.joint_choices import JointChoices, compare_joints
from exo_pin.compare.loss import Loss, Spread
from exo_pin.compare.motor_demand import MotorDemand
from exo_pin.compare.recorded_walk import Conditions, Walk, walk
from exo_pin.gait.phases import PHASES

__all__ = [
    "PHASES",
    "Comparison",
    "Conditions",
    "DeviceMotion",
    "JointChoices",
    "Loss",
    "MotorDemand",
    "Spread",
    "Walk",
    "best",
    "compare",
    "compare_joints",
    "dressed",
    "projected",
    "robot_for",
    "walk",
]

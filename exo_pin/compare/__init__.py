"""What a device loses of a walk: its best motion towards the recorded feet, and what is left to wish."""

from exo_pin.compare.best_motion import (
    CONDITIONS,
    Conditions,
    Motion,
    Walk,
    best,
    dressed,
    projected,
    robot_for,
    walk,
)
from exo_pin.compare.comparison import Comparison, compare
from exo_pin.compare.joint_choices import Worth, worth
from exo_pin.compare.loss import Loss
from exo_pin.gait.phases import PHASES

__all__ = [
    "CONDITIONS",
    "PHASES",
    "Comparison",
    "Conditions",
    "Loss",
    "Motion",
    "Walk",
    "Worth",
    "best",
    "compare",
    "dressed",
    "projected",
    "robot_for",
    "walk",
    "worth",
]

"""Inverse kinematics: joint angles from the poses of the feet (or any frames, positions, markers)."""

from exo_pin.ik.online import Online
from exo_pin.ik.result import Solution, Track
from exo_pin.ik.settings import Auto, ClosedForm, Dls
from exo_pin.ik.solve import SOLVERS, solve, track
from exo_pin.ik.targets import Points, Pose, Position

__all__ = [
    "SOLVERS",
    "Auto",
    "ClosedForm",
    "Dls",
    "Online",
    "Points",
    "Pose",
    "Position",
    "Solution",
    "Track",
    "solve",
    "track",
]

"""The robot: Pinocchio's model of an exoskeleton, addressed by name; its legs and subtrees."""

from exo_pin.robot.leg_axes import LegAxes
from exo_pin.robot.load import load_robot, load_urdf
from exo_pin.robot.model import Robot
from exo_pin.robot.subtree import Subtree
from exo_pin.robot.subtree_arrays import SubtreeArrays

__all__ = ["LegAxes", "Robot", "Subtree", "SubtreeArrays", "load_robot", "load_urdf"]

"""The robot: Pinocchio's model of an exoskeleton, addressed by name."""

from exo_pin.robot.load import load_robot, load_urdf
from exo_pin.robot.model import Robot

__all__ = ["Robot", "load_robot", "load_urdf"]

"""Exports of the exoskeleton to other tools: MuJoCo, OpenSim, ROS 2."""

from exo_pin.export.exports import EXPORTS, Export, export
from exo_pin.export.mjcf import mjcf
from exo_pin.export.osim import osim
from exo_pin.export.ros2 import ros2, ros2_files

__all__ = ["EXPORTS", "Export", "export", "mjcf", "osim", "ros2", "ros2_files"]

"""The robot of inverse dynamics: a floating pelvis, with the masses of the wearer, the device or both."""

from __future__ import annotations

from typing import get_args

import pinocchio as pin

from exo_pin.anatomy.names import Masses
from exo_pin.arguments import word
from exo_pin.errors import DescriptionError
from exo_pin.robot import Robot, load_robot, load_urdf


def floating_robot(robot: Robot, masses: Masses = "both") -> Robot:
    """The same robot on a pelvis that moves freely, with these masses; itself where it is that already.

    It is built at the first call and kept in `Robot.floating`.

    Args:
        robot: Any robot with feet.
        masses: `"wearer"` leaves out the hardware's masses, `"device"` the wearer's.

    Raises:
        DescriptionError: The masses of a URDF from elsewhere, or of a bare device, are to be divided.
        UnknownNameError: There are no such masses.
    """
    word("masses", masses, get_args(Masses))
    if robot.base == "floating" and robot.masses == masses:
        return robot
    if masses not in robot.floating:
        robot.floating[masses] = _built(robot, masses)
    return robot.floating[masses]


def _built(robot: Robot, masses: Masses) -> Robot:
    if robot.body is not None and robot.device is not None:
        return load_robot(
            robot.body, device=robot.device, hip_order=robot.hip_order, base="floating", masses=masses
        )
    if masses != "both":
        raise DescriptionError(
            f"masses of the {masses} alone are not known of a URDF from elsewhere; both is accepted"
        )
    return load_urdf(
        robot.urdf, base="floating", placement=robot.placement, hip_order=robot.hip_order, path=robot.path
    )


def mass_of(robot: Robot) -> float:
    """Mass of all links [kg]."""
    return float(pin.computeTotalMass(robot.model) + robot.model.inertias[0].mass)

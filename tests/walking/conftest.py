"""One planned walk for the tests of this folder."""

import pytest

from exo_pin.robot import load_robot
from exo_pin.walking import footsteps, plan_walk


@pytest.fixture(scope="session")
def robot():
    return load_robot()


@pytest.fixture(scope="session")
def plan(robot):
    return plan_walk(robot, footsteps(4, 0.25, width=robot.body.hip_width))

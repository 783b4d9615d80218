"""Poses of many samples by formulas on whole arrays, against Pinocchio and against few samples."""

import numpy as np
import pytest

from exo_pin.anatomy import CORNERS, FEET, HIP_ORDERS
from exo_pin.kinematics import poses, positions
from exo_pin.kinematics.leg_poses import legs_of
from exo_pin.robot import load_robot

ROUNDING = 1e-14  # of a product of eight poses of about 1 m [m]
MANY = 7000  # more than one chunk
FRAMES = ("pelvis", *CORNERS, "left_thigh", *FEET, "right_shank")


@pytest.mark.parametrize("order", HIP_ORDERS)
def test_many_samples_have_the_poses_of_each_sample_alone(rng, order):
    robot = load_robot(hip_order=order)
    q = rng.uniform(robot.lower, robot.upper, (MANY, robot.nq))
    together = poses(robot, q, FRAMES)
    for k in (0, 1, 5999, 6000, MANY - 1):
        np.testing.assert_allclose(together[k], poses(robot, q[k], FRAMES), rtol=0, atol=ROUNDING)


def test_frames_of_the_feet_are_on_legs_and_other_links_are_not():
    robot = load_robot()
    assert sorted(legs_of(robot, FRAMES)) == [k for k, name in enumerate(FRAMES) if name in (*CORNERS, *FEET)]


def test_a_floating_base_carries_its_legs(rng):
    robot = load_robot(base="floating")
    q = np.tile(robot.neutral, (MANY, 1))
    q[:, :3] += rng.uniform(-1, 1, (MANY, 3))
    rises = poses(robot, q)[:, :, :3, 3] - q[:, None, :3]
    np.testing.assert_allclose(rises, np.broadcast_to(rises[0], rises.shape), rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("shape", [(4,), (2, 150), (MANY,)])
@pytest.mark.parametrize("bases", ["none", "one", "each"])
def test_positions_are_those_of_the_poses(rng, shape, bases):
    robot = load_robot()
    q = rng.uniform(robot.lower, robot.upper, (*shape, robot.nq))
    turned = poses(robot, rng.uniform(robot.lower, robot.upper, (*shape, robot.nq)))[..., 0, :, :]
    base = {"none": None, "one": turned.reshape(-1, 4, 4)[0], "each": turned}[bases]
    expected = poses(robot, q, FRAMES, base=base)[..., :3, 3]
    np.testing.assert_allclose(positions(robot, q, FRAMES, base=base), expected, rtol=0, atol=ROUNDING)

"""A gait where configurations are taken: its own rates and its moving pelvis."""

import dataclasses

import numpy as np
import pytest

from exo_pin import FEET, load_robot, normative_gait
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.gait.time_series import derivative
from exo_pin.ground import place_walk
from exo_pin.kinematics import accelerations, center_of_mass, contacts, poses, positions, velocities

SAME = 1e-9
"""Spectral derivatives of angles and of positions differ by rounding times the highest frequency."""


@pytest.fixture(scope="module")
def walk(robot):
    gait = normative_gait("slow", samples=200)
    return dataclasses.replace(gait, base=place_walk(robot, gait).base)


def rate(walk, curves, order):
    flat = curves.reshape(len(walk), -1)
    return derivative(walk.time, flat, order, walk.duration).reshape(curves.shape)


@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_velocities_and_accelerations_are_the_derivatives_of_the_positions(walk, base):
    robot = load_robot(base=base)
    where = positions(robot, walk, FEET)
    speed, change = rate(walk, where, 1), rate(walk, where, 2)
    np.testing.assert_allclose(velocities(robot, walk)[..., :3], speed, atol=SAME * np.abs(speed).max() * 10)
    found = accelerations(robot, walk)[..., :3]
    np.testing.assert_allclose(found, change, atol=1e-6 * np.abs(change).max())


def test_angular_velocities_and_accelerations_turn_the_feet(walk, robot):
    R = poses(robot, walk)[..., :3, :3]
    W = rate(walk, R, 1) @ np.swapaxes(R, -1, -2)
    turning = np.stack([W[..., 2, 1], W[..., 0, 2], W[..., 1, 0]], axis=-1)
    np.testing.assert_allclose(velocities(robot, walk)[..., 3:], turning, atol=1e-6)
    spin = rate(walk, velocities(robot, walk)[..., 3:], 1)
    np.testing.assert_allclose(accelerations(robot, walk)[..., 3:], spin, atol=1e-5 * np.abs(spin).max())


@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_the_centre_of_mass_of_a_gait_moves_as_its_position_does(walk, base):
    com = center_of_mass(load_robot(base=base), walk)
    np.testing.assert_allclose(com.velocity, rate(walk, com.position, 1), atol=1e-8)
    np.testing.assert_allclose(com.acceleration, rate(walk, com.position, 2), atol=1e-5)


def test_contacts_of_a_gait_are_those_of_its_coordinates(walk, robot):
    other = contacts(robot, robot.from_gait(walk), base=walk.base)
    np.testing.assert_array_equal(contacts(robot, walk).touching, other.touching)


def test_rates_beside_a_gait_and_no_rates_without_one_are_refused(walk, robot):
    with pytest.raises(DescriptionError, match="leave it out"):
        velocities(robot, walk, np.zeros((len(walk), 12)))
    with pytest.raises(DescriptionError, match="dq is missing"):
        velocities(robot, robot.from_gait(walk))


def test_a_joint_of_a_gait_by_its_name(walk):
    assert walk["right_knee_flexion"] is not None
    np.testing.assert_array_equal(walk["left_hip_flexion"], walk.q[:, 0])
    with pytest.raises(UnknownNameError):
        walk["left_elbow"]

"""Walks that the ground alone carries: the whole wrench, at the zero-moment point, within the soles."""

import dataclasses

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import CORNERS, FEET, JOINTS
from exo_pin.dynamics import torques
from exo_pin.gait import Event, Gait, normative_gait
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.robot import load_robot

SOLE = 0.001
"""The sole of a foot that rolls sideways is no trapezoid on the ground [m]."""

TIME = np.linspace(0.0, 2.0, 201)


@pytest.fixture(scope="module")
def exo():
    return load_robot()


def swaying(robot, along=0.0, across=0.0):
    """Standing with both soles flat; the pelvis sways out and back once, 30 mm lower than upright."""
    base = np.tile(robot.placement, (len(TIME), 1, 1))
    out = np.sin(np.pi * TIME / TIME[-1])[:, None] ** 2 * [along, across, 0.0]
    base[:, :3, 3] += out - [0.0, 0.0, 0.03]
    feet = {foot: np.tile(poses(robot, robot.neutral, [foot])[0], (len(TIME), 1, 1)) for foot in FEET}
    track = ik.track(robot, feet, base=base)
    assert track.converged.all()
    return robot.to_gait(track.q, Gait(TIME, np.zeros((len(TIME), len(JOINTS))), base=base))


def test_the_ground_gives_all_that_a_swaying_body_takes(exo):
    found = torques(exo, swaying(exo, 0.03, 0.05), cutoff=None, free=True)
    assert np.abs(found.support_wrench).max() < 1e-9
    force = found.ground.force.sum(axis=1)
    assert force[:, 2] == pytest.approx(found.weight_force, rel=0.1)


def test_the_foot_that_the_body_leans_to_bears_more(exo):
    left = torques(exo, swaying(exo, across=0.05), cutoff=None, free=True).ground.force[100, :, 2]
    right = torques(exo, swaying(exo, across=-0.05), cutoff=None, free=True).ground.force[100, :, 2]
    assert left[0] > 1.5 * left[1]
    np.testing.assert_allclose(right, left[::-1], rtol=1e-6)


def test_the_centre_of_pressure_is_under_the_centre_of_mass_of_a_still_body(exo):
    for along in (-0.03, 0.0, 0.03):
        walk = swaying(exo)
        base = walk.base + np.eye(4, k=3) * [[along], [0.0], [0.0], [0.0]]  # body and feet together
        found = torques(exo, dataclasses.replace(walk, base=base), cutoff=None, free=True)
        com = center_of_mass(found.robot, found.motion.q[0]).position
        np.testing.assert_allclose(found.ground.point[0, :, 0], com[0], atol=1e-6)


def test_what_a_ground_cannot_give_is_left_over_and_no_pressure_leaves_its_sole(exo):
    found = torques(exo, normative_gait(), free=True)
    assert np.abs(found.support_wrench[:, 3:5]).max() > 50.0  # [N m]; the walk is no plan
    corners = poses(found.robot, found.motion.q, CORNERS)[..., :3, 3].reshape(-1, 2, 4, 3)
    point = found.ground.point
    for axis in (0, 1):
        inside = (point[..., axis] > corners[..., axis].min(axis=2) - SOLE) & (
            point[..., axis] < corners[..., axis].max(axis=2) + SOLE
        )
        assert (inside | np.isnan(point[..., axis])).all()


def test_in_single_support_the_standing_foot_bears_all(exo):
    events = (Event(0.5, "toe_off", "left"), Event(1.5, "heel_strike", "left"))
    walk = dataclasses.replace(swaying(exo, across=-0.05), events=(*events, Event(1.9, "toe_off", "right")))
    force = torques(exo, walk, cutoff=None, free=True).ground.force[60:140, :, 2]
    assert (force[:, 0] == 0.0).all()
    assert (force[:, 1] > 500.0).all()

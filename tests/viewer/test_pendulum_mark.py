"""The inverted pendulum of a walk in the picture: its foot is the ZMP, its mass the centre of mass."""

import math

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.robot import load_robot
from exo_pin.viewer.scenes.pendulum_mark import zero_moment_point
from exo_pin.walking import footsteps, plan_walk


@pytest.mark.parametrize("turn", [0.0, math.radians(20.0)])  # the second walk is turned to face the cameras
def test_the_line_goes_from_the_zmp_of_the_plan_to_the_centre_of_mass(turn):
    robot = load_robot()
    plan = plan_walk(robot, footsteps(3, 0.2, turn=turn, width=0.2), rate=50.0)
    scene = viewer.exoskeleton_scene(
        robot,
        plan.gait,
        viewer.SceneOptions(support="still"),
        kinetics=viewer.Kinetics.of_dynamics(plan.dynamics),
        wearer=False,
    )
    foot, arm, com = (scene.arrays[name] for name in ("pendulum_at", "pendulum", "com"))
    assert np.allclose(foot + arm * scene.facts.forces.length, com, atol=1e-5)  # float32
    long = np.linalg.norm(plan.com[:, :2] - plan.zmp, axis=1)
    assert np.allclose(np.linalg.norm((com - foot)[:, :2], axis=1), long, atol=1e-3)
    shown = {group.title: group.shown for group in scene.facts.groups}
    assert shown["Inverted pendulum: ZMP to centre of mass"]


def test_the_zero_moment_point_is_nearer_to_the_foot_that_bears_more():
    points = np.array([[[0.0, 0.1, 0.0], [0.4, -0.1, 0.0]], [[0.0, 0.1, 0.0], [np.nan] * 3]])
    found = zero_moment_point(np.array([[300.0, 100.0], [400.0, 0.0]]), points)
    assert np.allclose(found, [[0.1, 0.05, 0.0], [0.0, 0.1, 0.0]])
    assert np.isnan(zero_moment_point(np.zeros((1, 2)), np.full((1, 2, 3), np.nan))).all()

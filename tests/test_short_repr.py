"""Texts of results in an interactive session are short, and say what they are."""

import re

import numpy as np
import pytest

import exo_pin
from exo_pin import dynamics, ik, kinematics, simulation
from exo_pin.short_repr import LONGEST

WALK = exo_pin.normative_gait("slow")


@pytest.fixture(scope="module")
def results(robot):
    T = kinematics.poses(robot, WALK)
    targets = {name: ik.Pose(T[:, k]) for k, name in enumerate(exo_pin.FEET)}
    return [
        robot,
        robot.body,
        robot.device,
        robot.leg("left_foot"),
        WALK,
        WALK.events[0],
        ik.track(robot, targets),
        exo_pin.compare.compare(WALK, ["planar5", "lokomat"]),
        dynamics.torques(robot, WALK),
        simulation.simulate(robot, WALK, cycles=1),
        exo_pin.view(WALK),
        exo_pin.viewer.scene(robot, WALK),
        kinematics.contacts(robot, WALK),
        kinematics.center_of_mass(robot, WALK),
    ]


def test_no_result_prints_more_than_a_few_lines(results):
    for result in results:
        assert 3 < len(repr(result)) <= LONGEST, type(result)


def test_results_draw_themselves_in_notebooks(results):
    drawn = [result._repr_html_() for result in results if hasattr(result, "_repr_html_")]
    assert len(drawn) == 6
    assert all(text.startswith("<") for text in drawn)
    assert not [text for text in drawn if re.search(r"\bnan\b", text)]
    assert "<svg" in WALK._repr_html_()


def test_arrays_are_named_by_their_shape_and_names_by_themselves(robot):
    text = repr(robot)
    assert "lower=array(12)" in text
    assert "hip_order='clinical'" in text


def test_points_of_a_panel_that_are_not_known_are_left_out(robot):
    from exo_pin.html_summary import panels

    curve = np.array([0.0, np.nan, 2.0])
    assert panels(np.arange(3.0), {"knee": (curve,)}, "deg").count(",") == 3  # two points, one in the title

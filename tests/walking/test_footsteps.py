"""Footsteps: where they are, and what is no walk."""

import dataclasses
import math

import numpy as np
import pytest

from exo_pin.errors import ExoPinError, GaitError
from exo_pin.gait import normative_gait
from exo_pin.walking import (
    Footstep,
    Footsteps,
    footsteps,
    load_footsteps,
    recorded_footsteps,
    save_footsteps,
)


def test_straight_steps_go_ahead_by_their_length_and_the_last_one_closes():
    walk = footsteps(3, 0.3, width=0.2)
    assert [step.side for step in walk.steps] == ["left", "right", "left", "right"]
    assert np.allclose([step.x for step in walk.steps], [0.3, 0.6, 0.9, 0.9])
    assert np.allclose([step.y for step in walk.steps], [0.1, -0.1, 0.1, -0.1])


def test_a_positive_turn_goes_to_the_left():
    last = footsteps(8, 0.25, turn=math.radians(10.0), width=0.2).steps[-1]
    assert last.y > 0.5
    assert last.heading == pytest.approx(math.radians(80.0))


def test_steps_seen_from_the_standing_foot_are_all_alike():
    seen = footsteps(6, 0.25, turn=0.1, width=0.2).relative()[1:-1]
    assert np.allclose(seen[:-2], seen[2:])


def test_shortened_steps_keep_width_and_turn():
    walk = footsteps(4, 0.3, width=0.2, turn=0.1)
    half = walk.shortened(0.5).relative()
    assert np.allclose(half, walk.relative() * [0.5, 1.0, 1.0])


def test_mirrored_twice_is_the_same_walk():
    walk = footsteps(4, 0.3, turn=0.1)
    assert walk.mirrored().mirrored() == walk
    assert walk.mirrored().steps[0].side == "right"


@pytest.mark.parametrize(
    "bad",
    [
        {"steps": 0},
        {"steps": 100_000},
        {"steps": 2.5},
        {"length": math.nan},
        {"length": 3.0},
        {"width": 0.0},
        {"turn": math.inf},
        {"step_time": 0.0},
        {"double_support": 0.0},
        {"double_support": 1.0},
        {"double_support": math.nan},
        {"clearance": -0.1},
        {"start": "middle"},
    ],
)
def test_what_is_no_walk_is_refused(bad):
    with pytest.raises(ExoPinError):
        footsteps(**bad)


def test_feet_take_turns():
    left, right = Footstep("left", 0.0, 0.1), Footstep("right", 0.0, -0.1)
    with pytest.raises(ExoPinError, match="steps 1 and 2 are both of the left foot"):
        Footsteps((left, right), (left, left))


def test_written_footsteps_are_read_again(tmp_path):
    walk = footsteps(3, 0.25, turn=0.2)
    save_footsteps(walk, tmp_path / "steps.csv")
    read = load_footsteps(tmp_path / "steps.csv")
    assert [foot.side for foot in read.steps] == [foot.side for foot in walk.steps]
    assert np.allclose(read.relative(), walk.relative(), atol=1e-12)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "empty"),
        ("side,x_m,y_m\nleft,0,0", "header"),
        ("side,x_m,y_m,heading_deg\nleft,0,0.1,0\nright,0,-0.1,0\n", "2 rows"),
        ("side,x_m,y_m,heading_deg\nleft,0,0.1,0\nright,0,-0.1,0\nup,0,0,0", "steps.csv:4: side is 'up'"),
        ("side,x_m,y_m,heading_deg\nleft,0,0.1,0\nright,0,-0.1,0\nleft,nan,0,0", "steps.csv:4: .*nan"),
        ("side,x_m,y_m,heading_deg\nleft,0,0.1,0\nright,0,-0.1,0\nleft,a,0,0", "steps.csv:4: x_m is 'a'"),
        ("side,x_m,y_m,heading_deg\nleft,0,0.1,0\nright,0,-0.1,0\nleft,0,0", "steps.csv:4: 3 cells"),
        ("side,x_m,y_m,heading_deg\nleft,0,0.1,0\nleft,0,-0.1,0\nright,0,0,0", "left, then the right"),
    ],
)
def test_a_wrong_table_is_refused_with_its_line(text, said, tmp_path):
    (tmp_path / "steps.csv").write_text(text)
    with pytest.raises(ExoPinError, match=said):
        load_footsteps(tmp_path / "steps.csv")


def test_the_footsteps_of_a_planned_walk_are_found_in_it(robot, plan):
    found = recorded_footsteps(robot, plan.gait)
    assert np.allclose(found.relative(), plan.footsteps.relative(), atol=1e-6)
    assert found.step_time == pytest.approx(plan.footsteps.step_time, abs=0.01)
    assert found.double_support == pytest.approx(plan.footsteps.double_support, abs=0.02)


@pytest.mark.parametrize(
    ("change", "said"), [({"base": None}, "no motion of its pelvis"), ({"events": ()}, "events")]
)
def test_a_walk_without_pelvis_or_events_has_no_footsteps(robot, plan, change, said):
    with pytest.raises(GaitError, match=said):
        recorded_footsteps(robot, dataclasses.replace(plan.gait, **change))


def test_a_walk_on_the_spot_has_no_footsteps(robot):
    gait = normative_gait("free")
    still = dataclasses.replace(gait, base=np.tile(np.eye(4), (len(gait), 1, 1)))
    with pytest.raises(GaitError, match="on the spot"):
        recorded_footsteps(robot, still)

"""Slide of the standing foot: exact on motions that are made to slide, larger the more a body is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from exo_pin.anatomy import CORNERS, Body
from exo_pin.formats import load_gait
from exo_pin.gait import Gait
from exo_pin.gait.event import FOOT_FLAT, Event
from exo_pin.kinematics import LARGE_SLIDE, largest_slide, poses, stance_slides
from exo_pin.robot import load_robot

WALK = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"


LEFT_CORNERS = [name for name in CORNERS if name.startswith("left")]


def sliding(robot, gait, velocity):
    """The gait's cycle over ground, with a pelvis that lets the left sole move at `(2,)` velocity [m/s]."""
    sole = poses(robot, robot.from_gait(gait), LEFT_CORNERS)[..., :2, 3].mean(axis=1)
    base = np.tile(robot.placement, (len(gait), 1, 1))
    base[:, :2, 3] -= sole - np.outer(gait.time, velocity)
    base[-1, 0, 3] += 5.0  # the person gets along, so the ground is at rest
    events = (Event(0.1, "heel_strike", "left"), Event(0.7, "toe_off", "left"))
    return Gait(gait.time, gait.q, base=base, events=events)


def test_a_foot_that_is_held_in_place_does_not_slide(robot, gait):
    (slide,) = stance_slides(robot, sliding(robot, gait, (0.0, 0.0)))
    assert slide.side == "left"
    assert slide.distance < 1e-12


def test_the_slide_is_velocity_times_the_time_that_the_foot_rests(robot, gait):
    (slide,) = stance_slides(robot, sliding(robot, gait, (0.3, -0.4)))
    begin, end = (0.1 + part * 0.6 for part in FOOT_FLAT)
    assert (slide.start, slide.end) == pytest.approx((begin, end))
    step = gait.time[1] - gait.time[0]
    assert 0.5 * (end - begin - 2 * step) <= slide.distance <= 0.5 * (end - begin) + 1e-9


def test_a_belt_under_the_feet_is_no_slide(shared):
    robot, walk = load_robot(Body.from_stature(1.34, mass=33)), load_gait(shared / WALK)
    speed = (walk.base[-1, :2, 3] - walk.base[0, :2, 3]) / walk.duration
    belt = walk.base.copy()
    belt[:, :2, 3] -= np.outer(walk.time - walk.time[0], speed)
    over_ground = largest_slide(robot, walk).distance
    # the belt's speed is estimated from the same feet, which takes a part of the slide away
    assert 0.3 * over_ground < largest_slide(robot, replace(walk, base=belt)).distance < 1.5 * over_ground


def test_there_is_no_slide_where_the_pelvis_was_not_recorded_or_nothing_tells_stance(robot, gait):
    assert gait.events
    assert np.ptp(gait.base[:, :2, 3]) < 1e-6
    assert stance_slides(robot, gait) == ()
    assert largest_slide(robot, gait) is None
    walk = sliding(robot, gait, (0.3, 0.0))
    assert stance_slides(robot, replace(walk, events=())) == ()
    assert stance_slides(robot, replace(walk, base=None)) == ()


def test_the_slide_tells_a_child_on_an_adults_body(shared):
    walk = load_gait(shared / WALK)
    bodies = [Body.from_stature(stature, mass=33) for stature in (1.34, 1.55, 1.75)]  # its height: 1.34 m
    slides = [largest_slide(load_robot(body), walk).distance for body in bodies]
    assert slides == sorted(slides)
    assert slides[0] < 0.025
    assert slides[-1] > 3 * LARGE_SLIDE

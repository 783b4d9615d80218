from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.anatomy import SIDES
from exo_pin.errors import UnknownNameError
from exo_pin.formats import load_gait
from exo_pin.gait import SPEEDS, Gait, normative_gait
from exo_pin.gait.heading import turned
from exo_pin.gait.time_series import runs
from exo_pin.ground import DEEPEST_SINK, lowest_corners, place_walk
from exo_pin.ground import standing as standing_between
from exo_pin.ground.misfit import misfit
from exo_pin.retarget import retarget

TOUCH = 2e-3  # [m]: a standing sole this close to the ground touches it
SMOOTH = 15.0  # [m/s^2]: the pelvis of fast walkers reaches half of this; a jerk far exceeds it
STEADY = 0.06  # [m]: how far the pelvis may surge; people's pelvis surges 2-4 cm

SWAY = 0.09  # [m]: people's pelvis sways 4 to 7 cm, the more the slower they walk
SLIDE = 0.02  # [m]: sideways, of heel and ball in one single support; without the sway it is 26 to 28 mm


def standing(shown, side):
    return standing_between(shown.stance, side, shown.time)


@pytest.mark.parametrize("speed", SPEEDS)
def test_no_corner_sinks_and_the_standing_foot_touches(robot, speed):
    shown = place_walk(robot, normative_gait(speed))
    assert shown.corners[..., 2].min() >= -DEEPEST_SINK - 1e-9
    left, right = standing(shown, "left"), standing(shown, "right")
    low = lowest_corners(shown.corners)
    assert low["left"][left & ~right].max() < TOUCH
    assert low["right"][right & ~left].max() < TOUCH


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_pelvis_is_carried_smoothly_and_not_far(robot, speed):
    gait = normative_gait(speed)
    shown = place_walk(robot, gait)
    path = np.vstack([shown.base[:, :3, 3]] * 2)
    acceleration = np.diff(path, 2, axis=0) / (gait.duration / len(gait)) ** 2
    assert np.abs(acceleration).max() < SMOOTH
    assert np.ptp(path[:, 0]) < STEADY
    assert np.ptp(path[:, 2]) < STEADY


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_pelvis_sways_to_the_standing_leg_so_that_its_foot_does_not_slide(robot, speed):
    gait = normative_gait(speed)
    shown = place_walk(robot, gait)
    left, right = standing(shown, "left"), standing(shown, "right")
    sway = shown.base[:, 1, 3] - shown.base[:, 1, 3].mean()
    assert sway[left & ~right].mean() > 0.005 > -0.005 > sway[right & ~left].mean()
    assert np.ptp(sway) < SWAY
    assert shown.support.slide < SLIDE
    flat = left & ~right & (np.ptp(shown.corners[:, :4, 2], axis=1) < 0.01)
    sole = shown.corners[:, :4, 1].mean(axis=1)[flat]
    given = sole - sway[flat]  # where it would be without the sway
    assert np.ptp(sole) < 0.5 * np.ptp(given)


@pytest.mark.parametrize("speed", ["slow", "free", "fast"])
def test_the_flat_standing_foot_goes_with_the_belt(robot, speed):
    gait = normative_gait(speed)
    shown = place_walk(robot, gait)
    x = shown.corners[:, :4, 0].mean(axis=1)
    flat = (
        standing(shown, "left") & ~standing(shown, "right") & (np.ptp(shown.corners[:, :4, 2], axis=1) < 0.01)
    )
    speeds = np.gradient(x, gait.time)[flat]
    assert flat.sum() > 10
    assert np.median(speeds) == pytest.approx(-shown.support.belt_speed, rel=0.15)


def test_the_belt_runs_as_fast_as_people_walk(robot):
    speeds = [place_walk(robot, normative_gait(speed)).support.belt_speed for speed in SPEEDS]
    assert speeds == sorted(speeds)
    assert 1.0 < speeds[SPEEDS.index("free")] < 1.5


def test_the_rotation_of_the_pelvis_stays_the_gaits_own(robot):
    gait = normative_gait()
    assert np.array_equal(place_walk(robot, gait).base[:, :3, :3], gait.base[:, :3, :3])


def test_a_still_support_moves_the_walk_as_a_whole(robot):
    gait = normative_gait()
    shown = place_walk(robot, gait, "still")
    moved = shown.base[:, :3, 3] - gait.base[:, :3, 3]
    assert np.ptp(moved, axis=0) == pytest.approx(0, abs=1e-12)
    assert shown.corners[..., 2].min() == pytest.approx(0, abs=1e-9)


def test_what_remains_is_measured_on_the_shown_feet_and_said(robot):
    shown = place_walk(robot, normative_gait())
    both = standing(shown, "left") & standing(shown, "right")
    low = lowest_corners(shown.corners)
    assert shown.support.gap == pytest.approx(np.maximum(low["left"], low["right"])[both].max())
    assert shown.support.sink == pytest.approx(-shown.corners[..., 2].min())
    for name in ("gap", "sink", "hover", "slide", "slide_along"):
        assert f"{1000 * getattr(shown.support, name):.1f} mm" in shown.support.note


def test_the_slide_is_the_longest_way_of_heel_or_ball_over_the_belt(robot):
    """The left foot's, point by point from the drawn corners; the free walk is the same on both sides."""
    shown = place_walk(robot, normative_gait())
    alone = standing(shown, "left") & ~standing(shown, "right")
    ends = shown.corners[:, :4].reshape(-1, 2, 2, 3).mean(axis=2)  # heel, ball
    lowest = ends[..., 2].min(axis=1)
    ways = []
    for k in range(2):
        bears = alone & (ends[:, k, 2] < lowest + 0.01)
        assert len(runs(bears)) == 1
        places = ends[bears, k, :2]
        places[:, 0] += shown.support.belt_speed * shown.time[bears]
        ways.append(np.ptp(places, axis=0))
    along, sideways = np.max(ways, axis=0)
    assert shown.support.slide_along == pytest.approx(
        along, abs=1e-4
    )  # the sides differ by rounding of events
    assert shown.support.slide == pytest.approx(sideways, abs=1e-4)
    assert 0.01 < sideways < 0.02 < along < 0.05


def test_a_wrong_speed_of_the_belt_shows_as_a_slide_along(robot):
    shown = place_walk(robot, normative_gait())
    stance, speed = shown.stance, shown.support.belt_speed
    slides = [misfit(normative_gait(), shown.corners, stance, speed + d).slide_along for d in (0.0, -0.3)]
    assert slides[1] > slides[0] + 0.03


@pytest.mark.parametrize("angle", [0.0, 90.0, 200.0])
def test_sideways_is_across_the_way_of_a_walk_through_the_room(robot, angle):
    gait = normative_gait()
    base = gait.base.copy()
    base[:, 0, 3] += 1.2 * gait.time
    ways = [Gait(gait.time, gait.q, base=base, events=gait.events)]
    ways.append(turned(ways[0], np.radians(angle)))
    one, other = (place_walk(robot, way).support for way in ways)
    assert (other.slide, other.slide_along) == pytest.approx((one.slide, one.slide_along), abs=1e-6)
    assert "slides over the ground" in other.note


def test_a_longer_walk_is_carried_as_its_cycle_is(robot):
    gait = normative_gait()
    once, often = place_walk(robot, gait), place_walk(robot, gait.repeated(20))
    assert often.base == pytest.approx(np.tile(once.base, (20, 1, 1)), abs=1e-9)
    for number in ("belt_speed", "sink", "hover", "gap", "slide", "slide_along"):
        assert getattr(often.support, number) == pytest.approx(getattr(once.support, number), abs=1e-9)


def test_a_walk_through_the_room_keeps_its_way_and_gets_its_height(robot):
    gait = normative_gait()
    base = gait.base.copy()
    base[:, 0, 3] += 1.2 * gait.time
    away = Gait(gait.time, gait.q, base=base, events=gait.events)
    shown = place_walk(robot, away)
    assert shown.support.overground
    assert shown.support.belt_speed == 0
    assert np.array_equal(shown.base[:, :2, 3], base[:, :2, 3])
    assert shown.corners[..., 2].min() >= -DEEPEST_SINK - 1e-9


def test_a_walk_without_base_and_events_is_carried_too(robot):
    gait = replace(normative_gait(), base=None, events=())
    shown = place_walk(robot, gait)
    assert shown.corners[..., 2].min() >= -DEEPEST_SINK - 1e-9


def test_a_recording_is_carried(robot, shared):
    gait = load_gait(shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot")
    shown = place_walk(robot, gait)
    assert shown.corners[..., 2].min() >= -DEEPEST_SINK - 1e-9
    assert 0.8 < shown.support.belt_speed < 1.8
    assert np.abs(np.diff(shown.base[:, :3, 3], 2, axis=0)).max() / np.diff(gait.time)[0] ** 2 < 2 * SMOOTH


def test_an_unknown_support_is_refused_with_a_hint(robot):
    with pytest.raises(UnknownNameError, match="carried"):
        place_walk(robot, normative_gait(), "caried")


def test_the_note_names_a_support_only_where_there_is_one(robot):
    gait = normative_gait()
    assert place_walk(robot, gait).support.note.startswith("Balance support: the pelvis is raised")
    walk = viewer.retargeted(retarget(gait, "bolt"))
    assert any(note.startswith("The pelvis is raised") for note in walk.facts.notes)
    assert not any("Balance support" in note for note in walk.facts.notes)


@pytest.mark.parametrize("side", SIDES)
def test_a_standing_foot_of_either_side_that_slides_is_measured(robot, side):
    gait = normative_gait()
    other = SIDES[1 - SIDES.index(side)]
    alone = gait.stance(side) & ~gait.stance(other)
    base = gait.base.copy()
    base[:, 1, 3] += np.interp(np.arange(len(gait)), np.flatnonzero(alone)[[0, -1]], [0.0, 0.05])
    slides = [
        place_walk(robot, Gait(gait.time, gait.q, base=T, events=gait.events), "still").support.slide
        for T in (gait.base, base)
    ]
    assert slides[1] > slides[0] + 0.01

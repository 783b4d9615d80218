"""Events against force plates: the difference of each origin and kind, and when it is a reason to doubt."""

import dataclasses

import pytest

from exo_pin.anatomy import Body
from exo_pin.formats import load_forces, load_gait
from exo_pin.gait import normative_gait
from exo_pin.kinematics import EventDifference, disagreements, event_differences
from exo_pin.robot import load_robot

CHILD = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
ON_PLATES = 4


@pytest.fixture
def child(shared):
    path = shared / CHILD
    return load_robot(Body.from_stature(1.34)), load_gait(path), load_forces(path)


def test_the_files_events_and_those_of_kinematics_are_compared(child):
    robot, gait, plates = child
    found = event_differences(robot, gait, plates)
    by = {(x.source, x.kind): x for x in found}
    assert sum(len(x.late) for x in found) == 2 * ON_PLATES
    assert {source for source, _ in by} == {"C3D event", "O'Connor 2007", "Zeni 2008"}
    assert all(abs(x.largest) < 0.033 for x in found)
    assert disagreements(found) == ()


@pytest.mark.parametrize("late", [0.08, -0.08])
def test_events_of_another_clock_are_a_reason_to_doubt_with_the_sign_of_the_difference(child, late):
    robot, gait, plates = child
    moved = [dataclasses.replace(e, time=e.time + late) for e in gait.events if 0.9 < e.time < 2.4]
    found = event_differences(robot, dataclasses.replace(gait, events=tuple(moved)), plates)
    own = [x for x in found if x.source == "C3D event"]
    assert [x.mean for x in own] == pytest.approx([late, late], abs=0.01)  # a frame
    reasons = disagreements(found)
    assert len(reasons) == 2
    assert all("C3D event" in reason for reason in reasons)


def test_plates_that_nobody_steps_on_say_nothing(robot, child):
    _, _, plates = child
    assert event_differences(robot, normative_gait("free"), plates) == ()


def test_the_words_name_origin_kind_mean_and_number():
    words = str(EventDifference("Zeni 2008", "toe_off", (0.010, -0.020)))
    assert words == "toe-offs by Zeni 2008 -5 ms (2 contacts, at most -20)"

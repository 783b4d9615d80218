from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from exo_pin import viewer
from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.errors import UnknownNameError
from exo_pin.gait import Gait
from exo_pin.robot import load_robot
from exo_pin.viewer.scenes import joint_plots
from exo_pin.viewer.scenes.compiler import phase_cycles

ORDER = 1e-12  # [rad] through a robot's own coordinates and back


def test_left_and_right_of_a_joint_share_a_plot_and_the_sagittal_plane_comes_first():
    found = joint_plots.pairs(JOINTS)
    assert tuple(found)[:3] == ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
    assert {f"{side}_{movement}" for movement, sides in found.items() for side in sides} == set(JOINTS)
    for movement, sides in found.items():
        assert {side: JOINTS[k] for side, k in sides.items()} == {s: f"{s}_{movement}" for s in SIDES}


@pytest.mark.parametrize(
    ("left", "right"),
    [("leg_left_4_joint", "leg_right_4_joint"), ("l_knee", "r_knee"), ("LKneePitch", "RKneePitch")],
)
def test_the_sides_of_other_robots_are_found_in_their_names(left, right):
    ((_, sides),) = joint_plots.pairs((left, right)).items()
    assert sides == {"left": 0, "right": 1}


def test_a_joint_of_the_trunk_has_a_plot_of_its_own():
    assert joint_plots.pairs(("torso_roll", "lateral_bend")) == {
        "torso_roll": {"middle": 0},
        "lateral_bend": {"middle": 1},
    }


def test_a_device_with_locked_joints_shows_them_still_and_without_limits(gait):
    robot = load_robot(device="lokomat")
    angles, speeds = joint_plots.of_gait(robot, gait)
    for k, joint in enumerate(JOINTS):
        moves = joint in robot.joints
        assert np.isfinite([angles.lower[k], angles.upper[k], speeds.upper[k]]).all() == moves
        assert np.abs(angles.values[:, k] - moves * gait.q[:, k]).max() < ORDER
    facts = viewer.scene(robot, gait).facts
    assert [len(group.plots) for group in facts.plots][:2] == [6, 6]


def test_any_robots_joints_have_plots_under_their_own_names(gait):
    robot = load_robot(device="lopes8")
    q = robot.from_gait(gait)
    angles, speeds = joint_plots.of_robot(robot, gait.time, q)
    assert angles.joints == speeds.joints == robot.joints[3:]  # without the slides of its pelvis
    for k, name in enumerate(angles.joints):
        assert np.array_equal(angles.values[:, k], q[:, robot.column(name)])
    some = joint_plots.of_robot(robot, gait.time, q, ["left_knee_flexion"])[0]
    assert some.values.shape == (len(gait), 1)
    with pytest.raises(UnknownNameError):
        joint_plots.of_robot(robot, gait.time, q, ["tail"])


def test_dashed_curves_keep_their_own_time(gait):
    slow = gait.slowed(1.5)
    tabs = joint_plots.of_gait(load_robot(), gait, slow)
    arrays = joint_plots.arrays(tabs)
    for tab in tabs:
        assert np.array_equal(arrays[f"{tab.dashed}_time"], slow.time)
        assert len(arrays[tab.dashed]) == len(slow)
    assert [group.reference for group in joint_plots.groups(tabs)] == [tab.dashed for tab in tabs]


def test_phase_is_counted_in_the_cycles_of_the_foot_that_has_more(gait):
    walk = gait.repeated(3)
    events = [event for event in walk.events if event.time > 0.1]  # the first left heel strike is lost
    recording = Gait(walk.time + 5.0, walk.q, events=[replace(e, time=e.time + 5.0) for e in events])
    found = phase_cycles(recording)
    assert found.side == "right"
    strikes = [e.time for e in events if (e.side, e.kind) == ("right", "heel_strike")]
    assert found.spans == tuple((pytest.approx(a), pytest.approx(b)) for a, b in pairwise(strikes))


def test_a_cycle_that_repeats_has_a_phase_at_every_moment(gait):
    late = np.roll(gait.q, -30, axis=0)  # the left foot strikes at 70 % of the samples
    events = [replace(e, time=(e.time - 0.3 * gait.duration) % gait.duration) for e in gait.events]
    found = phase_cycles(Gait(gait.time, late, events=events, periodic=True))
    assert found.side == "left"
    assert found.spans[0][0] <= 0
    assert found.spans[-1][1] >= gait.duration
    strike = 0.7 * gait.duration
    assert found.spans == (
        (pytest.approx(strike - gait.duration), pytest.approx(strike)),
        (pytest.approx(strike), pytest.approx(strike + gait.duration)),
    )
    assert phase_cycles(replace(gait, events=())).spans == ((0.0, gait.duration),)


def test_a_recording_without_a_whole_cycle_has_an_estimated_phase_at_every_moment(gait):
    """One strike of each foot, half a stride apart: the stride is twice as long, and said to be estimated."""
    found = phase_cycles(
        Gait(gait.time + 2.0, gait.q, events=[replace(e, time=e.time + 2.0) for e in gait.events])
    )
    assert found.side == "left"
    assert "twice the step time" in found.estimate
    assert found.spans == ((pytest.approx(0.0), pytest.approx(gait.duration)),)


def test_without_events_or_with_strikes_of_one_foot_only_there_is_no_phase(gait):
    one = [event for event in gait.events if event.side == "right"]
    for events in ((), one):
        found = phase_cycles(Gait(gait.time, gait.q, events=events))
        assert (found.spans, found.estimate) == ((), "")

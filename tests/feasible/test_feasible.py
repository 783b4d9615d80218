"""Feasibility: the verdict turns where a limit is crossed, and the factors lead exactly to the limit."""

import dataclasses
import json

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, Body
from exo_pin.cli import main
from exo_pin.errors import UnknownNameError
from exo_pin.feasible import LARGEST_AMPLITUDE, LARGEST_CADENCE, feasible, nearest
from exo_pin.feasible.amplitude import with_amplitude
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import Gait, Torques, normative_gait
from exo_pin.robot import load_robot

GAIT = normative_gait().resampled(50)
JUST = 1e-3  # a factor this much beyond the limit must fail, this much below must pass
KNEE = JOINTS.index("left_knee_flexion")


@pytest.fixture(scope="module")
def free():
    return feasible(GAIT)


def test_the_normal_walk_can_be_done(free):
    assert free.ok
    assert not free.failures
    assert not set(free.dropped) & set(JOINTS)
    assert free.cadence > 1
    assert free.amplitude > 1


def test_the_largest_cadence_is_where_it_stops_to_be_possible(free):
    assert feasible(GAIT.slowed(1 / (free.cadence * (1 - JUST)))).ok
    verdict = feasible(GAIT.slowed(1 / (free.cadence * (1 + JUST))))
    assert not verdict.ok
    assert verdict.cadence == pytest.approx(1 / (1 + JUST))
    assert {how for _, how, _ in verdict.failures} <= {"too fast", "accelerated too hard"}


def test_the_largest_amplitude_is_where_it_stops_to_be_possible(free):
    assert feasible(with_amplitude(GAIT, free.amplitude * (1 - JUST))).ok
    assert not feasible(with_amplitude(GAIT, free.amplitude * (1 + JUST))).ok


def test_a_joint_outside_its_range_is_named_with_margin_and_phase():
    body = Body.from_stature(limits={"left_knee_flexion": (0.0, np.radians(50))})
    verdict = feasible(GAIT, body=body)
    assert not verdict.ok
    name, how, mask = verdict.failures[0]
    assert (name, how) == ("left_knee_flexion", "outside its range")
    assert np.array_equal(mask, GAIT.q[:, KNEE] > np.radians(50))
    assert "initial swing" in verdict.phases(mask, name)
    knee = next(d for d in verdict.joints if d.joint == name)
    assert knee.position.margin == pytest.approx(np.radians(50) - GAIT.q[:, KNEE].max())
    assert feasible(with_amplitude(GAIT, verdict.amplitude * (1 - JUST)), body=body).ok


def test_a_recording_that_hyperextends_is_refused_and_its_amplitude_told(shared):
    gait = load_gait(shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot")
    verdict = feasible(gait)
    assert {name for name, _, _ in verdict.failures} == {"left_knee_flexion", "right_knee_flexion"}
    assert 0.5 < verdict.amplitude < 1


def test_locked_joints_are_told_and_do_not_enter_the_verdict():
    verdict = feasible(GAIT, "hk4")
    assert verdict.ok
    assert len(verdict.dropped) == 8  # its pelvis goes with the person
    assert verdict.dropped["left_ankle_dorsiflexion"] == pytest.approx(
        np.abs(GAIT.q[:, JOINTS.index("left_ankle_dorsiflexion")]).max()
    )
    assert {d.joint for d in verdict.joints} == set(JOINTS) - set(verdict.dropped)


@pytest.mark.parametrize("device", ["exo12", "lopes8", "planar9"])
def test_standing_legs_are_apart_by_what_their_shapes_leave(device):
    robot = load_robot(device=device)
    body = robot.body
    thighs = body.hip_width - 2 * 0.16 * body.left_thigh  # two capsules beside each other
    found = nearest(robot, robot.q()[None])
    assert found.distance[0] == pytest.approx(thighs, abs=1e-5)
    assert found.pairs == [("left_thigh", "right_thigh")]


def test_crossed_legs_collide():
    q = np.zeros((20, 12))
    cross = np.radians(20) * np.sin(2 * np.pi * np.arange(20) / 20)
    for side in ("left", "right"):
        q[:, JOINTS.index(f"{side}_hip_adduction")] = cross
    verdict = feasible(Gait(np.arange(20) / 10, q))
    assert not verdict.ok
    (name, how, mask), *_ = verdict.failures
    assert how == "too near"
    assert name.startswith("left_")
    assert "right_" in name
    assert not mask[0]
    assert mask[5]
    assert 0.1 < verdict.amplitude < 1
    apart = feasible(with_amplitude(Gait(np.arange(20) / 10, q), verdict.amplitude)).colliding
    assert not apart.any()


def test_a_gap_that_no_walk_keeps_leaves_no_amplitude():
    verdict = feasible(GAIT, gap=0.2)
    assert not verdict.ok
    assert verdict.amplitude == 0


def test_reach_is_what_a_stretched_knee_would_add(free):
    leg = free.robot.body.leg("left")
    bent = GAIT.q[:, KNEE].min()
    asked = np.sqrt(leg.thigh**2 + leg.shank**2 + 2 * leg.thigh * leg.shank * np.cos(bent))
    assert free.reach["left"] == pytest.approx(leg.thigh + leg.shank - asked)
    stiff = Body.from_stature(limits={"left_knee_flexion": (np.radians(10), 2.0)})
    assert feasible(GAIT, body=stiff).reach["left"] < 0


def test_standing_still_is_possible_at_any_speed():
    verdict = feasible(Gait(np.arange(5) / 10, np.zeros((5, 12))))
    assert verdict.ok
    assert (verdict.cadence, verdict.amplitude) == (LARGEST_CADENCE, LARGEST_AMPLITUDE)
    json.dumps(verdict.facts(), allow_nan=False)


def test_the_command_says_where_it_stopped_to_look(capsys, tmp_path):
    path = tmp_path / "still.npz"
    save_gait(Gait(np.arange(5) / 10, np.zeros((5, 12))), path)
    assert main(["feasible", str(path)]) == 0
    assert "at 10 times the cadence, and more was not tried; at 3 times" in capsys.readouterr().out


def test_speed_and_acceleration_limits_count():
    slow = dataclasses.replace(GAIT, events=())
    verdict = feasible(slow, acceleration=20.0)
    assert {how for _, how, _ in verdict.failures} == {"accelerated too hard"}
    assert verdict.cadence < 1


def test_the_command_answers_with_its_exit_code(capsys):
    assert main(["feasible", "slow", "--device", "lokomat", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ok"]
    assert main(["feasible", "slow", "--gap", "100"]) == 1
    assert "too near" in capsys.readouterr().out
    assert main(["feasible", "slow", "--acceleration", "-1"]) == 2


def test_unknown_devices_are_refused():
    with pytest.raises(UnknownNameError):
        feasible(GAIT, "hal")


def _swaying(amount):
    """The normal walk, its pelvis going aside by `amount` and back once a cycle [m]."""
    base = np.array(GAIT.base)
    base[:, 1, 3] += amount * np.sin(2 * np.pi * np.arange(50) / 50)
    return dataclasses.replace(GAIT, base=base)


def test_prismatic_joints_must_follow_the_pelvis():
    verdict = feasible(_swaying(0.04), "lopes8")
    aside = next(d for d in verdict.joints if d.joint == "pelvis_left")
    assert aside.prismatic
    assert aside.position.required == pytest.approx(0.04 * np.sin(2 * np.pi * np.arange(50) / 50), abs=1e-9)
    assert aside.position.margin == pytest.approx(0.06, abs=1e-3)
    assert aside.speed.peak == pytest.approx(0.04 * 2 * np.pi / GAIT.duration)
    assert verdict.ok
    far = feasible(_swaying(0.11), "lopes8")
    assert [(name, how) for name, how, _ in far.failures] == [("pelvis_left", "outside its range")]
    assert not far.cadence_decides
    assert far.amplitude == 0  # smaller steps do not keep the pelvis still


def test_what_the_device_holds_of_the_pelvis_is_told_and_does_not_count():
    verdict = feasible(_swaying(0.04).slowed(2.0), "lokomat")  # its belt is slow
    assert verdict.ok
    assert verdict.dropped["pelvis_left"] == pytest.approx(0.04, abs=1e-3)
    assert "pelvis_up" not in verdict.dropped
    assert 0.05 < verdict.dropped["pelvis_turn"] < 0.4
    assert not [name for name in feasible(_swaying(0.04), "h2").dropped if name.startswith("pelvis")]


def test_known_torques_count_and_unknown_ones_do_not():
    tau = np.full((50, 12), np.nan)
    tau[:, KNEE] = 30 * np.sin(2 * np.pi * np.arange(50) / 50)
    verdict = feasible(GAIT, torques=Torques(GAIT.time, tau))
    knee = next(d for d in verdict.joints if d.joint == "left_knee_flexion")
    assert knee.torque.use == pytest.approx(np.nanmax(np.abs(tau)) / knee.torque.available)
    assert [d.joint for d in verdict.joints if d.torque is not None] == ["left_knee_flexion"]
    assert verdict.ok
    strong = feasible(GAIT, torques=Torques(GAIT.time, 10 * tau))
    assert [(name, how) for name, how, _ in strong.failures] == [("left_knee_flexion", "too much torque")]
    assert np.array_equal(strong.failures[0][2], np.abs(10 * tau[:, KNEE]) > knee.torque.available)
    assert not any((strong.ok, strong.cadence_decides, strong.amplitude_decides))


def test_the_command_says_where_and_under_what_conditions(capsys, tmp_path):
    words = ["feasible", "free", "--device", "lopes8", "--acceleration", "20"]
    assert main(words) == 1  # slower than half the cadence
    said = capsys.readouterr().out
    assert "ankle is held" in said  # the device's own remark
    assert "torques are not checked" in said
    assert "NOT OK left_knee_flexion: accelerated too hard (" in said
    assert main([*words, "--json"]) == 1
    facts = json.loads(capsys.readouterr().out)
    failure = facts["failures"][0]
    assert sum(b - a + 1 for a, b in failure["frames"]) == failure["samples"]
    path = tmp_path / "tau.csv"
    path.write_text("time_s,left_knee_flexion_torque_nm\n0,500\n2,500\n")
    assert main(["feasible", "free", "--torques", str(path)]) == 1
    assert (
        "left_knee_flexion: too much torque (500 of 150 N m) in 100 frames (0-99" in capsys.readouterr().out
    )


def test_a_belt_sets_the_cadence_and_the_amplitude():
    verdict = feasible(GAIT, "lokomat")
    belt = verdict.fits[0]
    assert not verdict.ok
    assert [name for name, _, _ in verdict.failures] == ["treadmill"]
    assert verdict.cadence == pytest.approx(belt.available[1] / belt.required)
    for part in (GAIT.slowed(1 / verdict.cadence), with_amplitude(GAIT, verdict.amplitude)):
        now = feasible(part, "lokomat")
        assert now.ok
        assert now.fits[0].required == pytest.approx(belt.available[1], rel=0.01)
    assert feasible(GAIT.slowed(20.0), "lokomat").failures[0][0] == "treadmill"  # too slow for it


def test_a_belt_whose_speed_nobody_knows_does_not_count():
    standing = Gait(np.arange(5) / 10, np.zeros((5, 12)))
    verdict = feasible(standing, "lokomat")
    assert np.isnan(verdict.fits[0].required)
    assert verdict.ok
    json.dumps(verdict.facts(), allow_nan=False)


@pytest.mark.parametrize(("stature", "good"), [(1.40, False), (1.50, True), (1.95, True), (2.0, False)])
def test_a_device_fits_the_people_it_is_made_for(stature, good):
    verdict = feasible(GAIT, "h2", Body.from_stature(stature))
    assert verdict.ok is good
    assert verdict.cadence_decides is good
    assert feasible(GAIT, "exo12", Body.from_stature(stature)).ok

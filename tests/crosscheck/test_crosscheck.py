"""The cross-checks see what is right, and what is not."""

import dataclasses

import numpy as np
import pytest

from exo_pin import crosscheck
from exo_pin.anatomy import JOINTS, Body
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.formats import load_gait
from exo_pin.gait import SPEEDS, normative_gait
from exo_pin.robot import load_robot, load_urdf

ROBOT = load_robot()


@pytest.mark.parametrize("speed", SPEEDS)
def test_all_is_well_with_the_normal_walk(speed):
    verdict = crosscheck.check(ROBOT, normative_gait(speed))
    assert verdict.ok
    facts = verdict.facts()
    assert set(facts) == {"fk_max_difference", "ik", "limits", "ok"}
    assert set(facts["fk_max_difference"]) == {"recursion", "dh", "yourdfpy"}
    assert set(facts["limits"]) == set(JOINTS)
    assert facts["ik"]["converged"] == facts["ik"]["frames"] == 100
    assert facts["ik"]["max_angle_error_deg"] < np.degrees(1e-6)


def test_a_joint_outside_its_limits_is_named_and_counted():
    gait = normative_gait()
    body = Body.from_stature(limits={"left_knee_flexion": (0.0, np.radians(30))})
    verdict = crosscheck.check(load_robot(body), gait)
    bent = int((gait.q[:, JOINTS.index("left_knee_flexion")] > np.radians(30)).sum())
    assert not verdict.ok
    assert verdict.fk_ok
    assert verdict.limits["left_knee_flexion"].samples_outside == bent
    assert verdict.joints_outside == ["left_knee_flexion"]
    assert verdict.recovery.within.sum() == len(gait.time) - bent


def test_the_recorded_walk_is_recovered_within_limits(shared):
    gait = load_gait(shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot")
    verdict = crosscheck.check(ROBOT, gait)
    assert verdict.fk_ok
    assert verdict.ik_ok
    assert verdict.recovery.largest_angle_error < 1e-6
    outside = verdict.joints_outside
    assert outside == ["left_knee_flexion", "right_knee_flexion"]  # the person's knees hyperextend
    low = np.degrees(min(verdict.limits[joint].lowest for joint in outside))
    assert low == pytest.approx(-3.2, abs=0.1)


def test_a_foot_that_was_not_reached_is_not_ok_nor_is_a_torque_that_differs():
    verdict = crosscheck.check(ROBOT, normative_gait())
    assert verdict.consistent
    wrong = dataclasses.replace(verdict, dynamics={"recursion": 1e-6})
    assert not wrong.consistent
    assert wrong.facts()["dynamics_max_relative_difference"] == {"recursion": 1e-6}
    track = verdict.recovery.track
    missed = dataclasses.replace(track, converged=np.arange(len(track.q)) != 3)
    recovery = dataclasses.replace(verdict.recovery, track=missed)
    assert not dataclasses.replace(verdict, recovery=recovery).ok


def test_a_wrong_branch_that_reaches_the_feet_is_not_ok():
    verdict = crosscheck.check(ROBOT, normative_gait())
    gait = verdict.recovery.gait
    turned = dataclasses.replace(gait, q=gait.q + 0.01)
    recovery = dataclasses.replace(verdict.recovery, gait=turned)
    assert not dataclasses.replace(verdict, recovery=recovery).ok
    assert not dataclasses.replace(verdict, agreement=0.01).ok
    assert not dataclasses.replace(verdict, fk={"recursion": 1e-9}).ok


def test_only_our_own_robots_have_a_witness():
    with pytest.raises(DescriptionError, match="load_robot"):
        crosscheck.forward(load_urdf(ROBOT.urdf), np.zeros((1, 12)))


def test_one_witness_alone_can_be_asked(robot):
    q = np.zeros((3, 12))
    assert crosscheck.forward(robot, q, witnesses=("dh",)) == {"dh": crosscheck.forward(robot, q)["dh"]}
    with pytest.raises(UnknownNameError):
        crosscheck.forward(robot, q, witnesses=("matlab",))

"""Legs and subtrees: what a robot reads from its model once, and keeps to itself."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

from exo_pin.anatomy import FEET, JOINTS
from exo_pin.devices import subset
from exo_pin.errors import UnknownNameError
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

ROUNDING = 1e-12  # [m] sums of a few lengths


@pytest.fixture(scope="module")
def robot():
    return load_robot()


def test_a_leg_is_read_once(robot):
    for foot in FEET:
        assert robot.leg(foot) is robot.leg(foot)
        assert robot.subtree((foot,)) is robot.subtree((foot,))
        assert robot.leg(foot) is not load_robot().leg(foot)


def test_a_leg_has_the_joints_limits_and_lengths_of_its_side(robot):
    for side, foot in zip(("left", "right"), FEET, strict=True):
        leg, own = robot.leg(foot), robot.body.leg(side)
        assert [robot.joints[c] for c in leg.columns] == [j for j in JOINTS if j.startswith(side)]
        np.testing.assert_array_equal(leg.lower, robot.lower[leg.columns])
        np.testing.assert_array_equal(leg.upper, robot.upper[leg.columns])
        assert leg.reach == pytest.approx(own.thigh + own.shank, abs=ROUNDING)
        assert np.linalg.norm(leg.hip - leg.ankle) == pytest.approx(leg.reach, abs=ROUNDING)
        np.testing.assert_allclose(leg.tip, poses(robot, robot.q(), (foot,))[0], atol=ROUNDING)


@pytest.mark.parametrize("device", ["lokomat", "lopes8"])
def test_fewer_joints_or_slides_above_make_no_leg_of_six(device):
    robot = load_robot(device=device)
    assert robot.leg("left_foot") is None
    assert robot.leg("pelvis") is None


def test_a_floating_base_is_no_joint_of_a_leg():
    held, floating = load_robot(), load_robot(base="floating")
    for foot in FEET:
        np.testing.assert_array_equal(held.leg(foot).columns + 7, floating.leg(foot).columns)
        np.testing.assert_allclose(held.leg(foot).axes, floating.leg(foot).axes, atol=ROUNDING)


def test_frames_that_share_joints_are_in_one_subtree(robot):
    assert [s.frames for s in robot.subtrees(FEET)] == [("left_foot",), ("right_foot",)]
    shared = robot.subtrees(("left_foot", "right_foot", "left_shank"))
    assert sorted(sorted(s.frames) for s in shared) == [["left_foot", "left_shank"], ["right_foot"]]
    slides = load_robot(device="lopes8").subtrees(FEET)
    assert [s.frames for s in slides] == [FEET]
    floating = load_robot(base="floating")
    assert len(floating.subtrees(FEET)) == 2
    assert [s.frames for s in floating.subtrees(FEET, base_moves=True)] == [FEET]


def test_a_subtree_holds_the_joints_that_move_its_frames(robot):
    subtree = robot.subtree(("left_shank",))
    assert [robot.joints[c] for c in subtree.columns] == [
        "left_hip_flexion",
        "left_hip_adduction",
        "left_hip_rotation",
        "left_knee_flexion",
    ]
    np.testing.assert_array_equal(subtree.lower, robot.lower[subtree.columns])
    assert not subtree.floating


def test_revolute_and_prismatic_joints_are_told_apart():
    robot = load_robot(device="lopes8")
    subtree = robot.subtrees(FEET)[0]
    names = [robot.joints[c] for c in subtree.columns]
    assert {name for name, turns in zip(names, subtree.arrays.revolute, strict=True) if not turns} == {
        name for name in names if name.startswith("pelvis")
    }


def test_arrays_do_not_hold_a_floating_base():
    robot = load_robot(base="floating")
    assert robot.subtree(FEET, base_moves=True).arrays is None
    assert robot.subtree(FEET).arrays is not None


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, lambda r: pickle.loads(pickle.dumps(r))])
def test_a_copy_reads_its_own_legs(robot, duplicate):
    legs = [robot.leg(foot) for foot in FEET]
    robot.subtrees(FEET)
    other = duplicate(robot)
    assert other.joints == robot.joints
    for foot, leg in zip(FEET, legs, strict=True):
        assert other.leg(foot) is not leg
        np.testing.assert_array_equal(other.leg(foot).axes, leg.axes)


def test_a_robot_of_another_model_does_not_inherit_legs(robot):
    robot.leg("left_foot")
    short = load_robot(device=subset(["hip_flexion"]))
    other = dataclasses.replace(robot, model=short.model, joints=short.joints)
    assert other.leg("left_foot") is None


def test_what_derives_from_a_leg_is_made_once_for_each_leg(robot):
    calls = []

    def reach(leg):
        calls.append(leg.frame)
        return leg.reach

    left, right = (load_robot().leg(foot) for foot in FEET)
    assert left.derived(reach) == left.derived(reach) == left.reach
    assert right.derived(reach) == right.reach
    assert calls == list(FEET)


def test_unknown_frames_are_refused(robot):
    for query in (robot.leg, lambda name: robot.subtree((name,)), lambda name: robot.subtrees((name,))):
        with pytest.raises(UnknownNameError, match="left_foot"):
            query("left_fot")

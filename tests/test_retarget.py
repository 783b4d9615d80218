"""Retargeting: the robot's feet do what the walker's feet do, scaled, on every robot of the table."""

import json

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, Body
from exo_pin.cli import main
from exo_pin.errors import UnknownNameError
from exo_pin.gait import Gait, normative_gait
from exo_pin.ik.leg import leg
from exo_pin.kinematics import poses
from exo_pin.retarget import TARGETS, load, retarget
from exo_pin.robot import load_robot

GAIT = normative_gait().resampled(20)
IDEAL = [name for name, target in TARGETS.items() if not target.remarks]
REACHED = 2e-6  # metres and radians: twice what the solver is asked for
WALKER = load_robot()


def _turn(target):
    return np.diag([-1.0, -1.0, 1.0]) if target.backward else np.eye(3)


def _walker_feet(gait):
    return poses(WALKER, WALKER.from_gait(gait), ("left_sole_plate", "right_sole_plate"), base=np.eye(4))


@pytest.mark.parametrize("name", TARGETS)
def test_each_leg_is_six_joints_and_stands_level_at_zero(name):
    robot, target = load(name), TARGETS[name]
    for foot, joints in zip(target.feet, (target.left, target.right), strict=True):
        own = leg(robot, foot)
        assert [robot.column(joint) for joint in joints] == own.columns.tolist()
        assert abs(own.axes[5] @ [1, 0, 0]) == pytest.approx(1, abs=1e-6)  # ankle roll axis lies level


@pytest.mark.parametrize("name", TARGETS)
def test_left_is_left_and_forward_is_forward(name):
    robot, target = load(name), TARGETS[name]
    left = poses(robot, robot.neutral, target.feet)[0, :3, 3] @ _turn(target).T
    assert left[1] > 0
    bent = np.zeros((2, 12))
    bent[:, JOINTS.index("left_hip_flexion")] = 0.3
    result = retarget(Gait([0.0, 1.0], bent), name)
    moved = poses(robot, result.copied[0], target.feet)[0, :3, 3] @ _turn(target).T
    assert moved[0] > left[0] + 0.05


@pytest.mark.parametrize("name", IDEAL)
def test_joint_by_joint_gives_the_feet_the_walker_s_attitude(name, rng):
    angles = rng.uniform(-0.4, 0.4, (10, 12))
    gait = Gait(np.arange(10) / 10, angles)
    result, turn = retarget(gait, name), _turn(TARGETS[name])
    rest = poses(result.robot, result.robot.neutral, TARGETS[name].feet)[..., :3, :3]
    R = (
        turn.T
        @ poses(result.robot, result.copied, TARGETS[name].feet)[..., :3, :3]
        @ np.swapaxes(rest, -1, -2)
        @ turn
    )
    assert np.abs(R - _walker_feet(gait)[..., :3, :3]).max() < 1e-4  # the files' axes are rounded


@pytest.mark.parametrize("name", IDEAL)
def test_foot_by_foot_reaches_every_foot_within_the_limits(name):
    result = retarget(GAIT, name)
    assert result.position_error.max() <= REACHED
    assert result.rotation_error.max() <= REACHED
    result.robot.check_limits(result.q)
    assert result.facts()["samples_missed"] == 0


@pytest.mark.parametrize("name", IDEAL)
def test_the_ankle_s_path_is_the_walker_s_scaled(name):
    result, target = retarget(GAIT, name), TARGETS[name]
    feet = poses(result.robot, result.q, target.feet)
    hips = poses(WALKER, WALKER.from_gait(GAIT), ("left_thigh", "right_thigh"), base=np.eye(4))
    walker = (_walker_feet(GAIT) - hips)[..., :3, 3]
    for k, foot in enumerate(target.feet):
        own = leg(result.robot, foot)
        ankle = feet[:, k, :3, 3] + feet[:, k, :3, :3] @ own.ankle_in_frame - own.hip
        assert ankle @ _turn(target) == pytest.approx(result.scale[k] * walker[:, k], abs=1e-5)


def test_inclined_hips_come_near():
    facts = retarget(GAIT, "g1").facts()
    assert facts["position_error_mm"]["max"] < 10
    assert facts["remarks"]


def test_a_taller_walker_is_scaled_down_more():
    small, tall = (retarget(GAIT, "talos", Body.from_stature(x)).scale[0] for x in (1.6, 1.9))
    assert small / tall == pytest.approx(1.9 / 1.6, rel=1e-4)


def test_unknown_robots_are_refused():
    with pytest.raises(UnknownNameError, match="talos"):
        retarget(GAIT, "taloss")


def test_the_command_writes_the_legs_angles(tmp_path, capsys):
    path = tmp_path / "joints.csv"
    assert main(["retarget", "slow", "--robot", "romeo", "--json", "-o", str(path)]) == 0
    assert json.loads(capsys.readouterr().out)["robot"] == "romeo"
    head, *rows = path.read_text().splitlines()
    assert head.split(",")[:2] == ["time_s", "LHipYaw_deg"]
    assert len(rows) == len(normative_gait("slow"))
    assert main(["retarget", "--robot", "r2d2"]) == 2

"""Retargeting: the robot's feet do what the walker's feet do, scaled, on every robot of the table."""

import json

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, SIDES, Body
from exo_pin.cli import main
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.gait import Gait, normative_gait
from exo_pin.kinematics import poses
from exo_pin.retarget import TARGETS, joint_by_joint, load, retarget
from exo_pin.robot import load_robot

GAIT = normative_gait().resampled(20)
SIX = [name for name in TARGETS if name != "bolt"]
REACHED = 2e-6  # metres and radians: twice what the solver is asked for
ROUNDED = 1e-4  # radians: the axes in the files have four digits
WALKER = load_robot()


@pytest.fixture(scope="module")
def walked():
    return {name: retarget(GAIT, name) for name in TARGETS}


def _walker(gait, link):
    return poses(WALKER, WALKER.from_gait(gait), [f"{side}_{link}" for side in SIDES], base=np.eye(4))


def _feet(biped, q):
    """Poses of the feet's links in the walker's axes, their attitude seen from the standing robot."""
    T = poses(biped.robot, q, [leg.foot for leg in biped.legs])
    R = biped.rotation.T @ T[..., :3, :3] @ np.array([leg.T[:3, :3].T for leg in biped.legs])
    return R, T[..., :3, 3] @ biped.rotation


@pytest.mark.parametrize("name", TARGETS)
def test_each_movement_has_one_joint_that_turns_the_way_its_name_says(name):
    biped = load(name)
    for leg in biped.legs:
        assert set(leg.movements) <= {joint.removeprefix("left_") for joint in JOINTS}
        for joint, movement, axis in zip(leg.joints, leg.movements, leg.axes, strict=True):
            assert biped.robot.column(joint) >= 0
            main_axis = {"flexion": 1, "adduction": 0, "rotation": 2, "dorsiflexion": 1, "inversion": 0}
            assert abs(axis[main_axis[movement.split("_")[1]]]) > 0.9


@pytest.mark.parametrize("name", TARGETS)
def test_left_is_left_and_up_is_up(name):
    left, right = load(name).legs
    assert left.ankle[1] > 0 > right.ankle[1]
    for leg in (left, right):
        assert leg.hip[2] - leg.ankle[2] > 0.95 * leg.reach  # it stands on straight legs


@pytest.mark.parametrize("name", TARGETS)
@pytest.mark.parametrize(
    ("movement", "axis", "sign"),
    [("hip_flexion", 0, 1), ("hip_adduction", 1, -1), ("knee_flexion", 0, -1)],
)
def test_positive_angles_move_the_left_foot_as_the_walker_s(name, movement, axis, sign):
    bent = np.zeros((2, 12))
    bent[:, JOINTS.index(f"left_{movement}")] = 0.3
    biped = load(name)
    _, before = _feet(biped, biped.stand)
    _, after = _feet(biped, joint_by_joint(Gait([0.0, 1.0], bent), biped)[0])
    assert sign * (after - before)[0, axis] > 0.05
    assert after[1] == pytest.approx(before[1], abs=1e-9)  # the other foot keeps still


@pytest.mark.parametrize("name", SIX)
def test_joint_by_joint_gives_the_feet_the_walker_s_attitude_whatever_the_hip_s_order(name, rng):
    gait = Gait(np.arange(10) / 10, rng.uniform(-0.4, 0.4, (10, 12)))
    biped = load(name)
    R, _ = _feet(biped, joint_by_joint(gait, biped))
    assert np.abs(R - _walker(gait, "sole_plate")[..., :3, :3]).max() < ROUNDED


@pytest.mark.parametrize("name", SIX)
def test_foot_by_foot_reaches_every_foot_within_the_limits(walked, name):
    result = walked[name]
    place, turn = result.errors
    assert place.max() <= REACHED
    assert turn.max() <= REACHED
    assert result.copied_errors[1].max() <= ROUNDED
    result.robot.check_limits(result.q)
    assert result.samples_missed == 0
    assert max(uses.used.use for uses in result.limit_use.values()) <= 1 + 1e-9
    assert not any(
        uses.copied.samples_outside for uses in result.limit_use.values()
    )  # as docs/robots.md says


@pytest.mark.parametrize("name", TARGETS)
def test_in_the_world_ankles_go_the_walker_s_way_scaled_and_feet_are_turned_alike(walked, name):
    result = walked[name]
    walker = GAIT.base[:, None] @ _walker(GAIT, "sole_plate")
    hips = GAIT.base[:, None] @ _walker(GAIT, "thigh")
    R, place = _feet(result.biped, result.q)
    root = result.base[:, :3, :3] @ result.biped.rotation
    for k, leg in enumerate(result.biped.legs):
        ankle = place[:, k] + R[:, k] @ leg.T[:3, :3] @ leg.ankle_in_foot
        path = (root @ (ankle - leg.hip)[..., None])[..., 0]
        asked = (walker - hips)[:, k, :3, 3]
        assert path == pytest.approx(result.scale[k] * asked, abs=REACHED)
        if len(leg.joints) == 6:
            assert root @ R[:, k] == pytest.approx(walker[:, k, :3, :3], abs=REACHED)
        size = WALKER.body.leg(leg.side)
        assert 0.95 <= result.scale[k] * (size.thigh + size.shank) / leg.reach <= 1


def test_point_feet_are_placed_and_their_attitude_is_reported_as_lost(walked):
    result = walked["bolt"]
    place, turn = result.errors
    assert place.max() <= REACHED
    assert np.degrees(turn.max()) > 5
    assert not result.missed.any()


def test_the_robot_s_root_goes_the_pelvis_s_way_scaled(walked):
    for result in walked.values():
        middle = result.biped.rotation @ (result.biped.legs[0].hip + result.biped.legs[1].hip) / 2
        hips = result.base[:, :3, :3] @ middle + result.base[:, :3, 3]
        assert hips == pytest.approx(np.mean(result.scale) * GAIT.base[:, :3, 3], abs=1e-12)


def test_the_trunk_is_upright_on_average_where_the_pelvis_leans(walked):
    leans = np.degrees(np.arctan2(-GAIT.base[:, 2, 0], GAIT.base[:, 2, 2]))
    assert leans.mean() > 5
    for result in walked.values():
        trunk = result.base[:, :3, :3] @ result.biped.rotation
        assert np.degrees(np.arctan2(-trunk[:, 2, 0], trunk[:, 2, 2])).mean() == pytest.approx(0, abs=0.05)
        assert np.degrees(result.lean) == pytest.approx(leans.mean(), abs=0.05)


def test_the_permuted_limits_of_simple_humanoid_are_not_used(walked):
    robot = walked["simple_humanoid"].robot
    for side in "LR":
        k = robot.joints.index(f"{side}LEG_KNEE")
        assert robot.lower[k] == 0
        assert robot.upper[k] > 2
    low, high = (robot.lower, robot.upper)
    left, right = (robot.joints.index(f"{side}LEG_HIP_Y") for side in "LR")
    assert (low[left], high[left]) == (-high[right], -low[right])
    raw = load(TARGETS["talos"]).robot
    assert retarget(GAIT, raw).samples_missed == 0  # a loaded robot is taken as it is
    assert "limits" in TARGETS["simple_humanoid"].remarks


def test_a_taller_walker_is_scaled_down_more():
    small, tall = (retarget(GAIT, "talos", Body.from_stature(x)).scale[0] for x in (1.6, 1.9))
    assert small / tall == pytest.approx(1.9 / 1.6, rel=1e-4)


def test_unknown_and_unfit_robots_are_refused_with_the_reason():
    with pytest.raises(UnknownNameError, match="talos"):
        retarget(GAIT, "taloss")
    with pytest.raises(DescriptionError, match="loops"):
        retarget(GAIT, "cassie")


def test_the_command_writes_the_legs_angles(tmp_path, capsys):
    path = tmp_path / "joints.csv"
    assert main(["retarget", "slow", "--robot", "romeo", "--json", "-o", str(path)]) == 0
    assert json.loads(capsys.readouterr().out)["robot"] == "romeo"
    head, *rows = path.read_text().splitlines()
    assert head.split(",")[:2] == ["time_s", "LHipYaw_deg"]
    assert len(rows) == len(normative_gait("slow"))
    assert main(["retarget", "--robot", "r2d2"]) == 2


def test_the_command_prints_residuals_limits_and_what_to_know(capsys):
    assert main(["retarget", "--robot", "bolt"]) == 0
    said = capsys.readouterr().out
    assert all(part in said for part in ("roll-pitch", "FL_KFE", "point feet", "joint by joint"))

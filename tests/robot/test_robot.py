"""Robots: names, limits, loading, and the way between gaits and configurations."""

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import CORNERS, FEET, HIP_ORDERS, JOINTS, Body
from exo_pin.errors import DescriptionError, LimitError, UnknownNameError
from exo_pin.gait import Gait, normative_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot, load_urdf

ROBOT = load_robot()


def _gait(rng, n=5, base=None):
    q = rng.uniform(ROBOT.lower, ROBOT.upper, (n, 12)) * 0.8
    return Gait(np.arange(n) / 100, q, base=base)


def test_joints_of_the_default_robot_are_in_the_gait_s_order():
    assert ROBOT.joints == JOINTS
    assert {"pelvis", *FEET, *CORNERS} <= set(ROBOT.frames)


def test_limits_are_those_of_the_body():
    body = Body.from_stature(limits={"left_knee_flexion": (0.1, 1.1)})
    robot = load_robot(body)
    k = robot.joints.index("left_knee_flexion")
    assert (robot.lower[k], robot.upper[k]) == (0.1, 1.1)


def test_q_is_built_by_name():
    q = ROBOT.q({"right_knee_flexion": 0.5})
    assert q[JOINTS.index("right_knee_flexion")] == 0.5
    assert np.count_nonzero(q) == 1


def test_an_unknown_joint_suggests_the_right_one():
    with pytest.raises(UnknownNameError, match="left_knee_flexion"):
        ROBOT.q({"left_kne_flexion": 0.5})


def test_check_limits_names_the_worst_joint():
    q = np.stack([ROBOT.q({"left_knee_flexion": -0.1}), ROBOT.q({"left_knee_flexion": -0.2})])
    with pytest.raises(LimitError, match="left_knee_flexion in frame 1") as caught:
        ROBOT.check_limits(q)
    assert caught.value.joint == "left_knee_flexion"
    assert caught.value.value == -0.2
    ROBOT.check_limits(ROBOT.q())


def test_outside_marks_the_joints_that_check_limits_refuses():
    q = np.stack([ROBOT.q(), ROBOT.q({"left_knee_flexion": -0.1})])
    outside = ROBOT.outside(q)
    assert outside.sum() == 1
    assert outside[1, ROBOT.joints.index("left_knee_flexion")]


def test_what_is_not_a_number_is_within_no_limits():
    one = ROBOT.neutral
    one[ROBOT.column("left_knee_flexion")] = np.nan
    for q in (one, np.full(12, np.nan)):
        with pytest.raises(LimitError, match="nan"):
            ROBOT.check_limits(q)


@pytest.mark.parametrize(
    "body", [Body.from_stature(), Body.from_stature(left_thigh=0.5)], ids=["even", "uneven"]
)
@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_the_longer_leg_stands_on_the_ground_at_zero(body, base):
    robot = load_robot(body, base=base)
    heights = poses(robot, robot.q())[:, 2, 3]
    lengths = np.array([leg.length for leg in body.legs])
    assert heights == pytest.approx(lengths.max() - lengths, abs=1e-15)


def test_pinocchio_s_own_world_is_the_ground():
    import pinocchio as pin

    data = ROBOT.model.createData()
    pin.framesForwardKinematics(ROBOT.model, data, ROBOT.q())
    assert data.oMf[ROBOT.frame("left_foot")].translation[2] == pytest.approx(0, abs=1e-15)
    assert data.oMf[ROBOT.frame("pelvis")].translation[2] == pytest.approx(ROBOT.body.leg_length)


@pytest.mark.parametrize("hip_order", HIP_ORDERS)
@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_gait_to_robot_and_back(hip_order, base, rng):
    pelvis = np.tile(np.eye(4), (5, 1, 1))
    pelvis[:, 0, 3] = np.linspace(0, 1, 5)
    gait = _gait(rng, base=pelvis)
    robot = load_robot(hip_order=hip_order, base=base)
    q = robot.from_gait(gait)
    assert q.shape == (5, robot.nq)
    back = robot.to_gait(q, gait)
    assert back.q == pytest.approx(gait.q, abs=1e-9)
    assert back.base == pytest.approx(gait.base, abs=1e-12)


@pytest.mark.parametrize("base", ["fixed", "floating"])
def test_both_hip_orders_put_the_feet_in_the_same_place(base, rng):
    gait = _gait(rng)
    feet = [
        poses(robot, robot.from_gait(gait))
        for robot in (load_robot(hip_order=order, base=base) for order in HIP_ORDERS)
    ]
    assert feet[0] == pytest.approx(feet[1], abs=1e-12)


def test_any_urdf_can_be_loaded_from_text_or_file(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(ROBOT.urdf)
    for source in (ROBOT.urdf, path, str(path)):
        assert load_urdf(source).joints == JOINTS


@pytest.mark.parametrize("text", ["<robot", "<robot name='x'/>", "<html></html>"])
def test_text_that_is_no_urdf_is_refused(text):
    with pytest.raises(DescriptionError):
        load_urdf(text)


def test_a_missing_urdf_is_refused(tmp_path):
    with pytest.raises(DescriptionError, match="no such file"):
        load_urdf(tmp_path / "none.urdf")


def test_unknown_device_order_and_base_are_refused():
    for words in ({"device": "x"}, {"hip_order": "x"}, {"base": "x"}):
        with pytest.raises(UnknownNameError):
            load_robot(**words)


def test_quaternions_of_any_length_are_attitudes_and_zero_is_refused():
    robot = load_robot(base="floating")
    q = np.array(robot.from_gait(normative_gait("free"))[:5])
    T = poses(robot, q)
    longer = q.copy()
    longer[:, 3:7] *= np.array([[2.0], [0.5], [1.0], [-3.0], [1e3]])
    np.testing.assert_allclose(poses(robot, longer), T, atol=1e-12)  # rounding of a walk some metres long
    assert robot.unit_quaternion(q) is q
    targets = {"left_foot": T[:, 0], "right_foot": T[:, 1]}
    track = ik.track(robot, targets, longer)
    np.testing.assert_allclose(np.linalg.norm(track.q[:, 3:7], axis=1), 1.0, atol=1e-12)
    loop = ik.Online(robot, longer[1])
    np.testing.assert_allclose(loop.step(*T[1]), q[1], atol=1e-9)
    assert loop.reached
    zero = q.copy()
    zero[3, 3:7] = 0.0
    for use in (
        lambda: poses(robot, zero),
        lambda: ik.track(robot, targets, zero),
        lambda: ik.Online(robot, zero[3]),
    ):
        with pytest.raises(DescriptionError, match="quaternion"):
            use()

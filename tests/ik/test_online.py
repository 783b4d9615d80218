"""Online: the answers of `track`, sample by sample, within limits and speeds, and never a false 'reached'."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot, load_urdf

ANGLE = 1e-9  # [rad] both come from the same formula
MILLISECOND = 1e-3


@pytest.fixture(scope="module")
def walk(robot):
    cycle = normative_gait("free", leg_length=0.93).resampled(200)
    q = np.clip(robot.from_gait(cycle), robot.lower, robot.upper)
    return q, poses(robot, q)


def test_a_walk_comes_back_sample_by_sample(robot, walk):
    q, T = walk
    loop = ik.Online(robot, q[0])
    for k in range(len(q)):
        answer = loop.step(T[k, 0], T[k, 1])
        assert loop.reached
        np.testing.assert_allclose(answer, q[k], atol=ANGLE)


def test_one_foot_alone_moves_one_leg_alone(robot, walk):
    q, T = walk
    loop = ik.Online(robot, q[0], frames=("right_foot",))
    answer = loop.step(T[50, 1])
    np.testing.assert_allclose(answer[6:], q[50, 6:], atol=ANGLE)
    np.testing.assert_array_equal(answer[:6], q[0, :6])


@pytest.mark.parametrize("foot", [0, 1])
def test_one_foot_out_of_reach_keeps_the_last_good_answer_and_says_so(robot, walk, foot):
    q, T = walk
    loop = ik.Online(robot, q[0])
    loop.step(T[10, 0], T[10, 1])
    targets = T[11].copy()
    targets[foot, 2, 3] -= 0.5
    answer = loop.step(*targets)
    assert not loop.reached
    np.testing.assert_allclose(answer, q[10], atol=ANGLE)
    loop.step(T[12, 0], T[12, 1])
    assert loop.reached


@pytest.mark.parametrize("foot", [0, 1])
def test_a_foot_that_misses_by_more_than_the_tolerance_is_noticed(robot, walk, foot):
    """The knee at its limit cannot follow 1e-6 m; the other foot is at its target."""
    stretched = robot.q({f"{side}_hip_flexion": 0.2 for side in ("left", "right")})
    targets = poses(robot, stretched)
    hip = robot.leg(FEET[foot]).hip
    away = targets[foot, :3, 3] - hip
    targets[foot, :3, 3] += 1e-6 * away / np.linalg.norm(away)
    loop = ik.Online(robot, stretched)
    loop.step(*targets)
    assert not loop.reached


@pytest.mark.parametrize("bad", [np.nan, np.inf, 2.0])
def test_nonsense_is_not_reached(robot, walk, bad):
    q, T = walk
    loop = ik.Online(robot, q[0])
    broken = T[5, 0].copy()
    broken[1, 1] = bad
    np.testing.assert_array_equal(loop.step(broken, T[5, 1]), q[0])
    assert not loop.reached


def test_speed_limits_hold_and_the_target_is_caught_up_with(robot, walk):
    q, T = walk
    loop = ik.Online(robot, q[0], dt=MILLISECOND)
    before = q[0].copy()
    for _ in range(1000):
        answer = loop.step(T[60, 0], T[60, 1])
        assert (np.abs(answer - before) <= robot.velocity * MILLISECOND * (1 + 1e-9)).all()
        assert loop.reached != loop.slowed
        before = answer.copy()
        if loop.reached:
            break
    np.testing.assert_allclose(answer, q[60], atol=ANGLE)


def test_a_pelvis_that_stands_elsewhere(robot, walk):
    q, _ = walk
    base = np.eye(4)
    base[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    base[:3, 3] = [1.0, 2.0, 0.9]
    T = poses(robot, q[20], base=base)
    loop = ik.Online(robot, base=base)
    np.testing.assert_allclose(loop.step(T[0], T[1]), q[20], atol=ANGLE)
    assert loop.reached


def test_a_floating_pelvis_stays_where_it_is(walk):
    robot = load_robot(base="floating")
    q = robot.neutral
    q[:3] = [0.3, -0.2, 1.1]
    q[7:] = walk[0][30]
    T = poses(robot, q)
    start = q.copy()
    start[7:] = walk[0][29]
    loop = ik.Online(robot, start)
    np.testing.assert_allclose(loop.step(T[0], T[1]), q, atol=ANGLE)
    assert loop.reached


def test_a_leg_without_closed_form_is_followed(robot, walk):
    skewed = robot.urdf.replace('axis xyz="0 1 0"', 'axis xyz="0.03 0.9995498987044118 0"')
    assert skewed != robot.urdf
    other = load_urdf(skewed, placement=robot.placement)
    q = walk[0]
    T = poses(other, q)
    loop = ik.Online(other, q[0])
    for k in range(0, 60, 3):
        loop.step(T[k, 0], T[k, 1])
        assert loop.reached
    apart = poses(other, loop.q)[..., :3, 3] - T[57, :, :3, 3]
    assert np.abs(apart).max() < ANGLE


def test_wrong_use_is_refused(robot):
    with pytest.raises(DescriptionError, match="q0"):
        ik.Online(robot, np.zeros(3))
    with pytest.raises(DescriptionError, match="not on a leg of six"):
        ik.Online(robot, frames=("left_shank",))
    with pytest.raises(UnknownNameError):
        ik.Online(robot, frames=("left_paw",))
    with pytest.raises(DescriptionError, match="1 targets were given for 2 frames"):
        ik.Online(robot).step(np.eye(4))


def test_the_answer_is_kept_between_calls(robot, walk):
    q, T = walk
    loop = ik.Online(robot, q[0])
    assert loop.step(T[3, 0], T[3, 1]) is loop.q
    assert loop.step(T[4, 0], T[4, 1]) is loop.q

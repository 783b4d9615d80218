"""Online: the answers of `track`, sample by sample, within limits and speeds, and never a false 'reached'."""

from __future__ import annotations

import pickle

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.errors import DescriptionError, UnknownNameError
from exo_pin.gait import normative_gait
from exo_pin.ik.least_squares.nearest_posture import NearestPosture
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


@pytest.mark.parametrize("name", ["left_ankle_inversion", "left_knee_flexion", "universe"])
def test_a_foot_may_have_the_name_of_a_joint_or_of_pinocchios_root(robot, walk, name):
    q, T = walk
    shared = load_urdf(robot.urdf.replace('"left_foot"', f'"{name}"'), placement=robot.placement)
    loop = ik.Online(shared, q[0], frames=(name, "right_foot"))
    for k in (1, 50):
        np.testing.assert_allclose(loop.step(T[k, 0], T[k, 1]), q[k], atol=ANGLE)
        assert loop.reached
    far = T[49:52].copy()
    far[:, 0, 2, 3] -= 0.5  # the nearest posture has a model of its own
    track, plain = (
        ik.track(made, {foot: far[:, 0]}) for made, foot in ((shared, name), (robot, "left_foot"))
    )
    np.testing.assert_allclose(track.q, plain.q, atol=ANGLE)


@pytest.mark.parametrize(
    "frames", [("left_foot", "left_foot"), ("right_foot", "left_foot", "left_sole_plate")]
)
def test_two_frames_on_one_leg_are_refused(robot, frames):
    with pytest.raises(DescriptionError, match=r"one leg; one frame for each leg"):
        ik.Online(robot, frames=frames)


@pytest.mark.parametrize("foot", [0, 1])
def test_one_foot_out_of_reach_says_so_and_the_other_leg_goes_on(robot, walk, foot):
    q, T = walk
    loop = ik.Online(robot, q[10])
    targets = T[11].copy()
    targets[foot, 2, 3] -= 0.5
    answer = loop.step(*targets)
    assert not loop.reached
    assert loop.reached_by_foot == (foot == 1, foot == 0)
    other = robot.leg(FEET[1 - foot]).columns
    np.testing.assert_allclose(answer[other], q[11, other], atol=ANGLE)
    loop.step(T[12, 0], T[12, 1])
    assert loop.reached
    assert loop.reached_by_foot == (True, True)


@pytest.mark.parametrize(
    "move",
    [
        pin.SE3(np.eye(3), np.array([0.0, 0.0, -0.06])),
        pin.SE3(np.eye(3), np.array([0.25, 0.0, 0.0])),
        pin.SE3(np.eye(3), np.array([0.0, 0.4, -0.1])),
        pin.SE3(np.eye(3), np.array([0.0, 0.0, 0.6])),
        pin.SE3(pin.exp3(np.array([0.0, 1.2, 0.0])), np.zeros(3)),
        pin.SE3(pin.exp3(np.array([0.9, 0.0, 0.0])), np.zeros(3)),
    ],
    ids=["down", "forward", "left", "up", "pitched", "rolled"],
)
def test_out_of_reach_the_nearest_posture_is_followed(robot, walk, move):
    """No free joint has a gradient left, by central differences; a held one is pushed outwards."""
    q, T = walk
    targets = T[40].copy()
    targets[0] = targets[0] @ move.homogeneous
    loop = ik.Online(robot, q[40])
    for _ in range(40):
        loop.step(*targets)
    assert loop.reached_by_foot == (False, True)
    columns = robot.leg("left_foot").columns
    h = 1e-6
    for column, lower, upper in zip(columns, robot.lower[columns], robot.upper[columns], strict=True):
        sides = np.array([loop.q, loop.q])
        sides[0, column] -= h
        sides[1, column] += h
        down, up = (_cost(x, targets[0]) for x in poses(robot, sides)[:, 0])
        slope = (up - down) / (2 * h)
        assert lower <= loop.q[column] <= upper
        if loop.q[column] > lower + 1e-9:
            assert slope < 1e-5  # of costs of 0.002 to 0.5: steps end at a gain of 1e-5 of the cost
        if loop.q[column] < upper - 1e-9:
            assert slope > -1e-5
    same = {name: np.array(targets[f])[None] for f, name in enumerate(FEET)}
    best = ik.track(robot, same, q[40], settings=ik.Dls(restarts=0))
    own = _cost(poses(robot, loop.q[None])[0, 0], targets[0])
    assert own <= _cost(poses(robot, best.q)[0, 0], targets[0]) * (1 + 1e-6)


def _cost(T, target):
    """Squared distance plus squared angle."""
    apart = pin.log3(T[:3, :3].T @ target[:3, :3])
    return float((T[:3, 3] - target[:3, 3]) @ (T[:3, 3] - target[:3, 3]) + apart @ apart)


@pytest.fixture(scope="module")
def fine_walk(robot):
    """A walk at 1 kHz."""
    gait = normative_gait("free")
    time = np.arange(0.0, 1.0, MILLISECOND)
    q = np.stack([np.interp(time, gait.time, x) for x in robot.from_gait(gait).T], axis=1)
    q = np.clip(q, robot.lower, robot.upper)
    return time, q, poses(robot, q)


@pytest.mark.parametrize("foot", [0, 1])
@pytest.mark.parametrize("dt", [None, MILLISECOND])
@pytest.mark.parametrize("away", [(0.0, 0.0, -0.06), (0.2, 0.0, 0.0), (0.0, 0.2, -0.03)])
def test_a_foot_leaves_the_reach_and_comes_back_without_a_jump(robot, fine_walk, foot, dt, away):
    time, q, T = fine_walk
    share = np.where((time > 0.3) & (time < 0.8), 0.5 - 0.5 * np.cos(4 * np.pi * (time - 0.3)), 0.0)
    targets = T.copy()
    targets[:, foot, :3, 3] += share[:, None] * np.array(away) * (1.0, 1.0 - 2.0 * foot, 1.0)
    loop = ik.Online(robot, q[0], dt=dt)
    answers, reached = [], []
    for pair in targets:
        answers.append(loop.step(*pair).copy())
        reached.append(loop.reached_by_foot)
    assert not all(a for a, _ in reached) or not all(b for _, b in reached)
    assert loop.reached
    assert all(by_foot[1 - foot] for by_foot in reached)
    found = poses(robot, np.array(answers))[:, 1 - foot, :3, 3]
    assert np.linalg.norm(found - T[:, 1 - foot, :3, 3], axis=1).max() <= 1e-9
    steps = np.abs(np.diff(answers, axis=0))
    most = np.radians(5.0) if dt is None else robot.velocity * dt * (1 + 1e-9)  # the knee's root at the reach
    assert (steps <= most).all()


def test_white_noise_on_the_feet_is_calmed_by_the_speed_limits(robot, fine_walk, rng):
    """5 mm per axis at 1 kHz is 8.0 mm of distance on average; following it exactly would be no better."""
    _, q, T = fine_walk
    targets = T.copy()
    targets[..., :3, 3] += rng.normal(0.0, 0.005, targets[..., :3, 3].shape)
    loop = ik.Online(robot, q[0], dt=MILLISECOND)
    answers = np.array([loop.step(*pair).copy() for pair in targets])
    off = np.linalg.norm(poses(robot, answers)[..., :3, 3] - T[..., :3, 3], axis=-1)
    assert off.mean() < 0.007


def test_a_step_out_of_reach_is_short(robot, fine_walk, monkeypatch):
    """It takes few evaluations of the leg's pose, 12 us each, whatever is wrong with the target."""
    _, q, T = fine_walk
    counts: list[int] = []
    evaluate = NearestPosture._evaluate

    def counted(self, q, target):
        counts.append(1)
        return evaluate(self, q, target)

    monkeypatch.setattr(NearestPosture, "_evaluate", counted)
    for bad in (np.diag([-1.0, -1.0, 1.0]), pin.exp3(np.array([0.0, 1.2, 0.0])), np.eye(3)):
        loop, spent = ik.Online(robot, q[0]), []
        for left, right in T[:300]:
            target = left.copy()
            target[:3, :3] = target[:3, :3] @ bad
            target[2, 3] -= 0.06
            counts.clear()
            loop.step(target, right)
            spent.append(len(counts))
        assert np.median(spent) <= 5
        assert max(spent) <= 12


def test_a_worse_minimum_is_left_for_the_formula_s_nearer_answer(robot):
    """Steps from the straight leg alone end at a cost of 0.10 here; 0.011 is to be had."""
    target = poses(robot, robot.neutral)[0].copy()
    target[:3, :3] = pin.exp3(np.array([-0.6, -0.1, 0.4]))
    target[:3, 3] += [0.11, -0.17, 0.36]
    loop = ik.Online(robot, frames=("left_foot",))
    for _ in range(30):
        loop.step(target)
    assert not loop.reached
    best = ik.track(robot, {"left_foot": target[None]})
    own = _cost(poses(robot, loop.q[None])[0, 0], target)
    assert own <= _cost(poses(robot, best.q)[0, 0], target) * (1 + 1e-6)


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
def test_nonsense_is_not_reached_and_leaves_its_leg_where_it_is(robot, walk, bad):
    q, T = walk
    loop = ik.Online(robot, q[0])
    broken = T[5, 0].copy()
    broken[1, 1] = bad
    answer = loop.step(broken, T[5, 1])
    np.testing.assert_array_equal(answer[:6], q[0, :6])
    np.testing.assert_allclose(answer[6:], q[5, 6:], atol=ANGLE)
    assert loop.reached_by_foot == (False, True)
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


def test_the_pelvis_may_move_from_step_to_step(robot, walk):
    q, _ = walk
    loop = ik.Online(robot, q[20])
    base = np.array(robot.placement)
    for k in range(20, 40):
        base[:3, 3] += 0.01, -0.002, 0.003
        T = poses(robot, q[k], base=base)
        np.testing.assert_allclose(loop.step(*T, base=base), q[k], atol=ANGLE)
        assert loop.reached
    np.testing.assert_allclose(loop.step(*T), q[39], atol=ANGLE)  # it stays where it was
    with pytest.raises(DescriptionError, match="base"):
        loop.step(*T, base=2.0 * base)
    with pytest.raises(DescriptionError, match="base"):
        loop.step(*T, base=base[:3])


def test_a_floating_pelvis_is_carried_by_base(walk):
    robot = load_robot(base="floating")
    q = np.array(robot.from_gait(normative_gait("free"))[30])
    base = pin.XYZQUATToSE3(q[:7]).homogeneous
    T = poses(robot, q)
    loop = ik.Online(robot)
    np.testing.assert_allclose(loop.step(T[0], T[1], base=base)[7:], q[7:], atol=ANGLE)
    assert loop.reached
    np.testing.assert_allclose(poses(robot, loop.q), T, atol=ANGLE)


@pytest.mark.parametrize("dt", [None, MILLISECOND])
def test_a_loop_can_be_pickled_under_way(robot, walk, dt):
    q, T = walk
    base = np.array(robot.placement)
    base[0, 3] += 0.5
    loop = ik.Online(robot, q[0], dt=dt, base=base)
    loop.step(T[5, 0], T[5, 1])
    copy = pickle.loads(pickle.dumps(loop))
    assert (copy.reached, copy.slowed, copy.reached_by_foot) == (
        loop.reached,
        loop.slowed,
        loop.reached_by_foot,
    )
    for k in range(6, 10):
        np.testing.assert_array_equal(copy.step(T[k, 0], T[k, 1]), loop.step(T[k, 0], T[k, 1]))
        assert copy.reached_by_foot == loop.reached_by_foot


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
    low = T[57, 0].copy()
    low[2, 3] -= 0.1
    before = loop.q.copy()
    for _ in range(20):
        answer = loop.step(low, T[57, 1])
    assert loop.reached_by_foot == (False, True)
    np.testing.assert_allclose(answer[6:], before[6:], atol=ANGLE)
    assert _cost(poses(other, answer)[0], low) < _cost(poses(other, before)[0], low)


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

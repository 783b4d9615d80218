"""Batched descent of any subtree: derivatives, agreement with other solvers, limits, weights, redundancy."""

import dataclasses

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.compare import Conditions, best, robot_for, walk
from exo_pin.compare.recorded_walk import corners
from exo_pin.devices import find
from exo_pin.gait import normative_gait
from exo_pin.ik.least_squares.cost import evaluate, weighted_targets
from exo_pin.ik.least_squares.driver import minimise
from exo_pin.ik.least_squares.single_sample import SampleKernel
from exo_pin.ik.least_squares.subtree_kernel import SubtreeKernel, step_limits
from exo_pin.ik.problem import problem
from exo_pin.kinematics import poses
from exo_pin.robot import Subtree, load_robot

SAME = 1e-6  # rad, m: two iterations towards one flat minimum, the slower one stops its steps at 1e-10
SLOPE = 1e-9  # central differences of step 1e-5 of values of about 1
BOUNDS = 1e-9  # m^2: scipy starts inside its bounds only, which are therefore 1e-9 rad wider
EXACT = 1e-12  # the same arithmetic in another order
RATIO = 2.0  # how much faster than its target a joint may be that cannot reach it
DEVICES = ("lopes8", "planar9", "lokomat")


def _task(device, rng, n=20):
    """A subtree with slides and two legs under points with weights and a weighted pose."""
    robot = load_robot(device=device)
    feet = poses(load_robot(), rng.normal(0, 0.2, (n, 12)), FEET)
    local, far = rng.normal(0, 0.1, (5, 3)), rng.normal(0, 0.1, (n, 5, 3))
    far[3, 1] = np.nan  # an unseen marker
    targets = {
        "left_foot": ik.Points(local, far, rng.uniform(0, 2, 5)),
        "right_foot": ik.Pose(feet[:, 1], 1.3, 0.7),
    }
    task = problem(robot, targets, rng.normal(0, 0.2, (n, robot.nq)), None)
    return task, task.subtrees[0], task.goals_of(task.subtrees[0])


@pytest.mark.parametrize("device", DEVICES)
def test_arrays_and_pinocchio_put_the_frames_in_the_same_places(device, rng):
    task, subtree, _ = _task(device, rng)
    joints = subtree.arrays
    q = rng.uniform(subtree.lower, subtree.upper, (20, len(subtree.columns)))
    whole = np.zeros((20, task.robot.nq))
    whole[:, subtree.columns] = q
    expected = poses(task.robot, whole, subtree.frames)
    now = joints.pose(q.T)
    for f in range(len(subtree.frames)):
        R = np.einsum("abm,bc->mac", now.R[f], joints.frames[f, :3, :3])
        p = np.einsum("abm,b->ma", now.R[f], joints.frames[f, :3, 3]) + now.p[f].T
        assert np.abs(R - expected[:, f, :3, :3]).max() <= EXACT
        assert np.abs(p - expected[:, f, :3, 3]).max() <= EXACT


def _minimum(arrays, goals, seed, lower, upper, settings):
    kernel = SubtreeKernel(arrays, weighted_targets(arrays, goals, settings), _column(lower), _column(upper))
    return minimise(kernel, seed, settings)


def _column(limit):
    return np.reshape(limit, (len(limit), -1))


@pytest.mark.parametrize("device", DEVICES)
def test_gradient_and_hessian_are_the_derivatives_of_half_the_cost(device, rng):
    _, subtree, goals = _task(device, rng)
    arrays, step = subtree.arrays, 1e-5
    targets = weighted_targets(arrays, goals, ik.Dls(position_weight=1.2))
    q = rng.uniform(-0.4, 0.4, (len(subtree.columns), 20))
    gradient, gauss_newton, second_order = evaluate(arrays, targets, q).model
    for j in range(len(q)):
        aside = np.zeros((len(q), 1))
        aside[j] = step
        up, down = evaluate(arrays, targets, q + aside), evaluate(arrays, targets, q - aside)
        assert (up.cost - down.cost) / (4 * step) == pytest.approx(gradient[j], abs=SLOPE)
        hessian = (up.model[0] - down.model[0]) / (2 * step)
        assert hessian == pytest.approx(gauss_newton[j] + second_order[j], abs=SLOPE)


@pytest.mark.parametrize("device", ["lokomat", "lopes8", "h2"])
def test_scipy_finds_the_same_compromise(device, rng):
    from scipy.optimize import least_squares

    robot = load_robot(device=device)
    recorded = walk(normative_gait().resampled(5))
    found = best(recorded, robot, Conditions("device"))
    stand = found.gait.base @ np.linalg.inv(robot.slid(found.q))
    for k in range(5):

        def missed(q, k=k):
            feet = poses(robot, q, FEET, base=stand[k])
            return (corners(robot, feet) - recorded.corners[k]).ravel()

        other = least_squares(
            missed, found.q[k], bounds=(robot.lower - 1e-9, robot.upper + 1e-9), xtol=1e-13, ftol=1e-15
        )
        assert np.sum(missed(found.q[k]) ** 2) <= 2 * other.cost + BOUNDS


@pytest.mark.parametrize("device", ["lokomat", "lopes7", "h2"])
@pytest.mark.parametrize("pelvis", ["recorded", "device"])
def test_all_at_once_answers_as_one_after_the_other(device, pelvis, monkeypatch):
    recorded, conditions = walk(normative_gait().resampled(12)), Conditions(pelvis)
    robot = robot_for(find(device), recorded.robot.body, conditions)
    together = best(recorded, robot, conditions)
    monkeypatch.setattr(Subtree, "arrays", None)
    one_by_one = best(recorded, robot, conditions)
    assert together.q == pytest.approx(one_by_one.q, abs=SAME)


def test_answers_keep_limits_of_each_sample_and_hold_joints_between_equal_ones(rng):
    _, subtree, goals = _task("lopes8", rng)
    seed = rng.uniform(-0.2, 0.2, (len(subtree.columns), 20))
    width = rng.uniform(0, 0.3, seed.shape)
    width[rng.random(seed.shape) < 0.3] = 0.0
    out = _minimum(subtree.arrays, goals, seed, seed - width, seed + width, ik.Dls(tolerance=1e-10))
    assert ((out.q >= seed - width) & (out.q <= seed + width)).all()
    assert np.array_equal(out.q[width == 0.0], seed[width == 0.0])


def test_no_free_joint_has_a_gradient_left_and_a_held_one_is_pushed_outwards(rng):
    _, subtree, goals = _task("lopes8", rng)
    joints, low, high = subtree.arrays, subtree.lower[:, None], subtree.upper[:, None]
    seed = np.zeros((len(subtree.columns), 20))
    out = _minimum(joints, goals, seed, subtree.lower, subtree.upper, ik.Dls())
    gradient = evaluate(joints, weighted_targets(joints, goals, ik.Dls()), out.q).model[0]
    inside = (out.q > low) & (out.q < high)
    assert np.abs(gradient[inside]).max() < SAME
    assert (gradient[out.q <= low] >= -SAME).all()
    assert (gradient[out.q >= high] <= SAME).all()


def test_samples_do_not_know_of_each_other(rng):
    _, subtree, goals = _task("planar9", rng)
    seed = rng.uniform(-0.2, 0.2, (len(subtree.columns), 20))
    all_of_them = _minimum(subtree.arrays, goals, seed, subtree.lower, subtree.upper, ik.Dls())
    order = rng.permutation(20)[:7]
    some = _minimum(
        subtree.arrays, [g.only(order) for g in goals], seed[:, order], subtree.lower, subtree.upper, ik.Dls()
    )
    assert some.q == pytest.approx(all_of_them.q[:, order], abs=SAME)


def test_a_reachable_target_is_met_from_far_away_by_other_starts(rng):
    robot = load_robot(device="planar7")
    q = rng.uniform(robot.lower, robot.upper, (40, robot.nq))
    targets = {foot: poses(robot, q, [foot])[:, 0] for foot in FEET}
    far = np.tile(robot.upper, (40, 1))
    settings = ik.Dls(tolerance=1e-9, warm_start=False)
    assert not ik.track(
        robot, targets, far, settings=dataclasses.replace(settings, restarts=0)
    ).converged.all()
    answer = ik.track(robot, targets, far, settings=settings)
    assert answer.position_error[answer.converged].max() <= 1e-9
    assert answer.converged.mean() > 0.9


def _feet(samples):
    gait, robot = normative_gait().resampled(samples), load_robot()
    return gait, dict(
        zip(FEET, poses(robot, robot.from_gait(gait), FEET, base=gait.base).swapaxes(0, 1), strict=True)
    )


@pytest.mark.parametrize("device", ["lopes8", "planar5"])
@pytest.mark.parametrize("pelvis", ["recorded", "device"])
def test_the_motion_after_targets_out_of_reach_is_continuous(device, pelvis):
    """These devices jumped by 25 to 38 degrees here, at any sampling: a least error ceased to be one."""
    robot, fastest = load_robot(device=device), []
    for samples in (100, 300):
        gait, feet = _feet(samples)
        track = ik.track(robot, feet, base=gait.base if pelvis == "recorded" else None)
        assert not track.converged.any()
        task = problem(robot, feet, None, gait.base if pelvis == "recorded" else None)
        subtree = task.subtrees[0]
        most = step_limits(subtree.arrays, task.goals_of(subtree))[1:]
        assert (np.abs(np.diff(track.q[:, subtree.columns], axis=0)) <= most + EXACT).all()
        fastest.append(np.abs(np.diff(track.q, axis=0)).max() * samples)
    assert fastest[1] == pytest.approx(fastest[0], rel=0.2)  # a speed, not a jump


def test_targets_that_are_met_need_no_step_limit():
    robot = load_robot(device="planar7")
    q = np.zeros((40, robot.nq))
    q[20:] = np.clip(robot.q({"left_knee_flexion": 0.5, "right_hip_flexion": 0.4}), robot.lower, robot.upper)
    targets = {foot: poses(robot, q, [foot])[:, 0] for foot in FEET}
    assert ik.track(robot, targets, robot.q()).converged.all()


def test_the_step_limit_is_the_path_over_the_lever_arm_and_the_angle():
    robot = load_robot(device="lokomat")
    T = np.tile(poses(robot, robot.q(), ["left_foot"])[0], (4, 1, 1))
    T[1:, 0, 3] += 0.02
    T[2:, :3, :3] = T[0, :3, :3] @ _about_y(0.1)
    task = problem(robot, {"left_foot": T}, None, None)
    joints = task.subtrees[0].arrays
    most = step_limits(joints, task.goals_of(task.subtrees[0]))
    leg = robot.body.leg("left")
    arms = np.array([np.inf, leg.thigh + leg.shank + leg.ankle_height, leg.shank + leg.ankle_height])
    assert np.isinf(most[0]).all()
    assert most[1] == pytest.approx(RATIO * np.array([0.02, *(0.02 / arms[1:])]))
    assert most[2] == pytest.approx(np.maximum(most[1], RATIO * np.array([0.0, 0.1, 0.1])))
    assert np.array_equal(most[3], most[2])


def _about_y(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


@pytest.mark.parametrize("device", ["lokomat", "lopes8", "h2"])
def test_one_sample_and_many_have_the_same_cost_and_hessian(device, rng):
    _, subtree, goals = _task(device, rng) if device != "h2" else _legs(device, rng)
    arrays, data = subtree.arrays, subtree.model.createData()
    q = rng.uniform(-0.4, 0.4, (len(subtree.columns), 20))
    many = evaluate(arrays, weighted_targets(arrays, goals, ik.Dls(position_weight=1.2)), q)
    gradient, gauss_newton, second_order = many.model
    for k in range(20):
        one = SampleKernel(subtree, data, goals, k, position_weight=1.2, compromise=True)
        now = one.evaluate(q[:, k : k + 1])
        e, J, rest = (part[..., 0] for part in now.model)
        assert now.cost[0] == pytest.approx(many.cost[k], abs=EXACT)
        assert -J.T @ e == pytest.approx(gradient[:, k], abs=EXACT)
        assert np.abs(J.T @ J - gauss_newton[..., k]).max() < EXACT
        assert rest == pytest.approx(second_order[..., k], abs=EXACT)
        assert now.errors[..., 0] == pytest.approx(many.errors[..., k], abs=EXACT, nan_ok=True)


def _legs(device, rng):
    robot = load_robot(device=device)
    feet = poses(load_robot(), rng.normal(0, 0.2, (20, 12)), FEET)
    task = problem(robot, {"left_foot": feet[:, 0]}, None, None)
    return task, task.subtrees[0], task.goals_of(task.subtrees[0])

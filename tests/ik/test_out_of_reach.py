"""Targets that cannot be met: refused early, answered by the nearest posture that neighbours lead to."""

from __future__ import annotations

import time

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.gait import normative_gait
from exo_pin.ik.least_squares import dls
from exo_pin.ik.least_squares.nearest_posture import NearestPosture
from exo_pin.ik.leg.geometry import exact_geometry
from exo_pin.kinematics import poses

BACKWARD = np.diag([-1.0, -1.0, 1.0])
MOST_STEPS = 2 * 2 * 50  # of two feet, settled and settled again where they follow neighbours


@pytest.fixture(scope="module")
def walk(robot):
    """100 samples of a walk."""
    q = np.clip(robot.from_gait(normative_gait("free")), robot.lower, robot.upper)
    return poses(robot, q)


def _pair(T):
    return dict(zip(FEET, T.swapaxes(0, 1), strict=True))


def _turned(T, R):
    out = T.copy()
    out[..., :3, :3] = out[..., :3, :3] @ R
    return out


def _costs(track):
    return track.position_error**2 + track.rotation_error**2


@pytest.mark.parametrize("count", [1, 20])
@pytest.mark.parametrize("kind", ["backward", "pelvis", "far"])
def test_a_missed_sample_takes_few_steps(robot, walk, kind, count):
    T = walk[:count].copy()
    if kind == "backward":
        T = _turned(T, BACKWARD)
    T[..., :3, 3] = robot.placement[:3, 3] if kind == "pelvis" else T[..., :3, 3]
    T[..., 2, 3] -= 0.5 * (kind == "far")
    track = ik.track(robot, _pair(T))
    assert not track.converged.any()
    assert track.iterations.max() <= MOST_STEPS
    assert np.median(track.iterations) <= 50


def test_ten_thousand_samples_with_a_tenth_out_of_reach_take_seconds(robot, walk):
    T = np.tile(walk, (100, 1, 1, 1))
    T[::10] = _turned(T[::10], BACKWARD)
    T[5::30, :, 2, 3] -= 0.3
    start = time.process_time()
    track = ik.track(robot, _pair(T))
    assert time.process_time() - start < 5.0  # 0.3 s on a quiet machine
    missed = np.zeros(len(T), dtype=bool)
    missed[::10] = missed[5::30] = True
    np.testing.assert_array_equal(track.converged, ~missed)


@pytest.mark.parametrize("side", FEET)
def test_where_the_only_branch_leaves_the_limits_many_starts_find_no_answer(robot, rng, side):
    leg = robot.leg(side)
    assert exact_geometry(leg).complete
    q = rng.uniform(robot.lower, robot.upper, (80, robot.nq))
    T = poses(robot, q)[:, FEET.index(side)]
    T[:, :3, :3] = [R @ pin.exp3(rng.uniform(-0.5, 0.5, 3)) for R in T[:, :3, :3]]
    formula = ik.track(robot, {side: T}, settings=ik.ClosedForm())
    missed = T[~formula.converged][:30]
    assert len(missed) == 30
    other = ik.track(robot, {side: missed}, settings=ik.Dls(warm_start=False, max_iterations=60))
    assert not other.converged.any()


@pytest.mark.parametrize("limit", [-0.1, 0.0])
def test_a_knee_that_bends_both_ways_has_a_second_branch(robot, limit):
    leg = robot.leg("left_foot")
    lower = leg.lower.copy()
    lower[3] = limit
    other = type(leg)(leg.frame, leg.columns, leg.axes, leg.points, leg.tip, lower, leg.upper)
    assert exact_geometry(other).complete == (limit == 0.0)


@pytest.mark.parametrize(
    "turn", [(0.6, 0.0, 0.0), (-0.9, 0.0, 0.0), (0.0, 0.0, 1.0), (0.7, 0.7, 0.7)], ids=str
)
def test_an_attitude_that_cannot_be_had_makes_no_joint_jump(robot, turn, monkeypatch):
    """Each on its own, neighbours find different minima: up to 60 degrees apart however finely sampled."""
    gait = normative_gait("free")
    fine = np.linspace(gait.time[0], gait.time[-1], 1000)
    q = np.stack([np.interp(fine, gait.time, x) for x in robot.from_gait(gait).T], axis=1)
    targets = _pair(_turned(poses(robot, q), pin.exp3(np.array(turn))))
    track = ik.track(robot, targets)
    assert not track.converged.any()
    largest = np.abs(np.diff(track.q, axis=0)).max()
    assert largest <= np.radians(4.0)
    monkeypatch.setattr(dls, "follow_leg", lambda *args: None)
    apart = ik.track(robot, targets)
    assert np.abs(np.diff(apart.q, axis=0)).max() > 2.0 * largest
    assert _costs(track).sum() <= 1.01 * _costs(apart).sum()


def test_a_stretch_out_of_reach_is_joined_where_its_step_is_least(robot, walk, monkeypatch):
    """The feet turn away from their path and back; where they can follow, the answers are exact."""
    share = 0.5 - 0.5 * np.cos(2 * np.pi * np.clip((np.arange(100) - 20) / 60, 0.0, 1.0))
    T = walk.copy()
    for k in range(100):
        T[k, :, :3, :3] = T[k, :, :3, :3] @ pin.exp3(np.array([0.0, 0.0, share[k]]))
    track = ik.track(robot, _pair(T))
    assert 10 < (~track.converged).sum() < 60
    monkeypatch.setattr(dls, "follow_leg", lambda *args: None)
    apart = ik.track(robot, _pair(T))
    largest, without = (np.abs(np.diff(x.q, axis=0)).max() for x in (track, apart))
    assert largest <= without + 1e-9
    kept = ik.track(robot, _pair(T), settings=ik.ClosedForm())
    good = kept.converged
    np.testing.assert_array_equal(track.q[good], kept.q[good])


def test_nearest_postures_cost_no_more_than_gauss_newton_s(robot, walk):
    T = walk.copy()
    T[..., 2, 3] -= 0.06
    own = ik.track(robot, _pair(T))
    other = ik.track(robot, _pair(T), settings=ik.Dls(restarts=0))
    assert _costs(own).sum() <= _costs(other).sum() * (1 + 1e-6)


def test_neighbours_share_the_restarts(robot, walk):
    track = ik.track(robot, _pair(_turned(walk[:6], BACKWARD)), settings=ik.Dls())
    assert not track.converged.any()
    assert track.iterations[1:].max() < 0.5 * track.iterations[0]


def test_the_nearest_posture_of_one_sample_keeps_the_weights(robot, walk):
    T = _turned(walk[10:11], pin.exp3(np.array([0.0, 0.8, 0.0])))[:, 0]
    answer = ik.track(robot, {"left_foot": ik.Pose(T, 3.0, 0.5)})
    leg = robot.leg("left_foot")
    posture = NearestPosture(leg, tolerance=1e-9, max_iterations=50, weights=(3.0, 0.5))
    q = answer.q[0, leg.columns] + 0.05
    for _ in range(20):
        q, cost = posture.from_start(q, pin.SE3(T[0]))
    np.testing.assert_allclose(q, answer.q[0, leg.columns], atol=1e-4)  # steps end at 1e-5 of the cost
    weighted = (3.0 * answer.position_error[0, 0]) ** 2 + (0.5 * answer.rotation_error[0, 0]) ** 2
    assert cost == pytest.approx(weighted, rel=1e-5)

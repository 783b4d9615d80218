"""The iteration itself: the cost falls, limits hold, restarts leave saddles, another optimiser agrees."""

import dataclasses

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.ik.least_squares import driver
from exo_pin.ik.least_squares.cost import weighted_targets
from exo_pin.ik.least_squares.driver import minimise, minimise_with_restarts
from exo_pin.ik.least_squares.kernel import spread_point
from exo_pin.ik.least_squares.leg_kernel import LegKernel
from exo_pin.ik.least_squares.single_sample import SampleKernel
from exo_pin.ik.least_squares.subtree_kernel import SubtreeKernel
from exo_pin.ik.problem import problem
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

SAME = 1e-6  # rad, m: two ways into one flat minimum
SETTINGS = ik.Dls(tolerance=1e-10, restarts=0)


def _leg(rng, n=30):
    """Reachable poses of a leg, and seeds all over its range."""
    robot = load_robot()
    leg = robot.leg("left_foot")
    q, seed = (rng.uniform(leg.lower, leg.upper, (n, 6)) for _ in range(2))
    whole = np.zeros((n, robot.nq))
    whole[:, leg.columns] = q
    T = poses(robot, whole, ["left_foot"])[:, 0]
    return LegKernel.of(leg, T[:, :3, :3], T[:, :3, 3], position_weight=1.0, rotation_weight=1.0), seed.T


def _subtree(device, rng, n=30):
    """Poses that a device can hardly reach, and seeds all over its range."""
    robot = load_robot(device=device)
    feet = poses(load_robot(), rng.normal(0, 0.3, (n, 12)), FEET)
    task = problem(robot, dict(zip(FEET, feet.swapaxes(0, 1), strict=True)), None, None)
    subtree = task.subtrees[0]
    return (
        subtree,
        task.goals_of(subtree),
        rng.uniform(subtree.lower, subtree.upper, (n, len(subtree.lower))).T,
    )


def _kernels(rng):
    yield _leg(rng)
    for device in ("lopes8", "planar9"):
        subtree, goals, seed = _subtree(device, rng)
        targets = weighted_targets(subtree.arrays, goals, SETTINGS)
        yield SubtreeKernel(subtree.arrays, targets, subtree.lower[:, None], subtree.upper[:, None]), seed
        data = subtree.model.createData()
        for compromise in (False, True):
            yield SampleKernel(subtree, data, goals, 3, compromise=compromise), seed[:, 3:4]


def test_the_cost_never_rises_however_many_steps_are_taken(rng):
    for kernel, seed in _kernels(rng):
        before = kernel.evaluate(kernel.inside(seed)).cost
        for steps in (1, 2, 3, 5, 9, 20, 60):
            now = minimise(kernel, seed, dataclasses.replace(SETTINGS, max_iterations=steps))
            assert (now.cost <= before).all()
            assert (now.steps <= steps).all()
            before = now.cost


def test_results_lie_within_the_limits_even_if_the_seed_does_not(rng):
    for kernel, seed in _kernels(rng):
        out = minimise(kernel, seed + rng.normal(0, 3.0, seed.shape), SETTINGS)
        assert np.array_equal(kernel.inside(out.q), out.q)


def test_cost_and_errors_belong_to_the_configurations(rng):
    for kernel, seed in _kernels(rng):
        out = minimise(kernel, seed, SETTINGS)
        again = kernel.evaluate(out.q)
        assert out.cost == pytest.approx(again.cost, rel=1e-9, abs=1e-24)
        assert out.errors == pytest.approx(again.errors, abs=1e-12, nan_ok=True)


def test_a_straight_knee_is_left_by_a_restart():
    """The foot shall move along the straight leg, which no joint does: a saddle of the cost."""
    robot = load_robot()
    T = poses(robot, np.zeros((1, robot.nq)), ["left_foot"])[:, 0]
    T[:, 2, 3] += 0.05
    leg, seed = robot.leg("left_foot"), np.zeros((6, 1))
    kernel = LegKernel.of(leg, T[:, :3, :3], T[:, :3, 3], position_weight=1.0, rotation_weight=1.0)
    assert not minimise(kernel, seed, ik.Dls()).reached(1e-9)[0]
    out = minimise_with_restarts(kernel, seed, ik.Dls(), retry=np.ones(1, dtype=bool))
    assert out.reached(1e-9)[0]
    assert out.q[3, 0] > np.radians(20.0)


def test_restarts_count_only_where_they_reach_the_target(rng):
    kernel, seed = _leg(rng, 60)
    alone = minimise(kernel, seed, SETTINGS)
    settings = dataclasses.replace(SETTINGS, restarts=8)
    retry = np.arange(60) % 2 == 0
    out = minimise_with_restarts(kernel, seed, settings, retry=retry)
    stuck = ~alone.reached(1e-10)
    assert stuck[retry].any()
    assert stuck[~retry].any()
    assert out.reached(1e-10)[retry].mean() > 0.95
    kept = ~retry | ~out.reached(1e-10)
    assert np.array_equal(out.q[:, kept], alone.q[:, kept])
    assert (out.steps >= alone.steps).all()
    assert np.array_equal(out.steps[~retry], alone.steps[~retry])


def test_a_pool_smaller_than_the_samples_changes_no_answer(rng, monkeypatch):
    for kernel, seed in _kernels(rng):
        whole = minimise(kernel, seed, SETTINGS)
        monkeypatch.setattr(driver, "_POOL", 8)
        parts = minimise(kernel, seed, SETTINGS)
        monkeypatch.undo()
        assert parts.q == pytest.approx(whole.q, abs=SAME)
        assert np.array_equal(parts.steps, whole.steps)


@pytest.mark.parametrize("device", ["lokomat", "lopes8", "planar5", "planar9", "h2"])
def test_scipy_started_from_the_same_seed_finds_no_better_minimum_nearby(device, rng):
    from scipy.optimize import least_squares

    subtree, goals, seed = _subtree(device, rng, 6)
    targets = weighted_targets(subtree.arrays, goals, SETTINGS)
    kernel = SubtreeKernel(subtree.arrays, targets, subtree.lower[:, None], subtree.upper[:, None])
    out = minimise(kernel, seed, SETTINGS)
    for k in range(6):
        one = SampleKernel(subtree, subtree.model.createData(), goals, k)

        def residual(q, one=one):
            return one.evaluate(q[:, None]).model[0][:, 0]

        wider = subtree.lower - 1e-9, subtree.upper + 1e-9  # scipy starts inside its bounds only
        other = least_squares(residual, out.q[:, k], bounds=wider, xtol=1e-13, ftol=1e-15)
        assert out.cost[k] <= 2 * other.cost + 1e-9


def test_restarts_spread_over_the_range_and_are_always_the_same():
    lower, upper = np.array([[-1.0], [0.0], [-np.inf]]), np.array([[1.0], [4.0], [np.inf]])
    points = np.stack([spread_point(i, lower, upper, np.full((3, 1), 7.0))[:, 0] for i in range(64)])
    assert points[0] == pytest.approx([0.0, 2.0, 7.0])
    assert ((points[:, :2] >= lower[:2, 0]) & (points[:, :2] <= upper[:2, 0])).all()
    counts, *_ = np.histogram2d(points[:, 0], points[:, 1], bins=4)
    assert counts.min() >= 2  # of four on average: no corner is left out
    assert np.array_equal(points[63], spread_point(63, lower, upper, np.full((3, 1), 7.0))[:, 0])

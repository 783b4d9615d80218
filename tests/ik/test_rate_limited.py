"""Motions under limits of speed and acceleration: these hold between samples too, and cost little."""

import dataclasses
import functools

import numpy as np
import pytest

from exo_pin.anatomy import FEET, Body
from exo_pin.compare import Conditions, best, projected, robot_for, walk
from exo_pin.compare.best_motion import rate_limits
from exo_pin.compare.recorded_walk import corners, sole_targets
from exo_pin.devices import find
from exo_pin.formats import load_gait
from exo_pin.gait import normative_gait, time_series
from exo_pin.ik.least_squares.limit_rows import CycleRows, LocalRows
from exo_pin.ik.least_squares.rate_limited import RateLimits, rate_limited
from exo_pin.ik.least_squares.rate_rows import Clock
from exo_pin.kinematics import poses

ROUNDED = 1 + 1e-9  # of rates near their limits
SETTLED = 1e-6  # metres of rms: where two ways to one smooth minimum stop
BODY = Body.from_stature()


@functools.cache
def _case(device, samples, pelvis="device", speed="free"):
    conditions = Conditions(pelvis)
    recorded, robot = (
        walk(normative_gait(speed).resampled(samples)),
        robot_for(find(device), BODY, conditions),
    )
    return recorded, robot, best(recorded, robot, conditions), projected(recorded, robot, conditions)


def _stand(robot, motion):
    return motion.gait.base @ np.linalg.inv(robot.slid(motion.q))


def _rms(recorded, robot, q, base):
    missed = corners(robot, poses(robot, q, FEET, base=base)) - recorded.corners
    return float((missed**2).sum(axis=-1).mean() ** 0.5)


def _solved(device, samples, *, speed=1.0, acceleration=1.0):
    """The motion (n, nq) with the limits scaled, and what it was found from."""
    recorded, robot, motion, _ = _case(device, samples)
    own = rate_limits(recorded.gait, robot)
    limits = dataclasses.replace(
        own, velocity=speed * own.velocity, acceleration=acceleration * own.acceleration
    )
    base = _stand(robot, motion)
    assert (limits.use(motion.q) > 1.0).any()
    q = rate_limited(robot, sole_targets(robot, recorded.corners), motion.q, limits, base=base)
    return recorded, robot, limits, base, q


@pytest.mark.parametrize("pelvis", ["recorded", "device"])
@pytest.mark.parametrize(
    ("device", "speed"), [("lokomat", "free"), ("planar5", "very_slow"), ("exo12", "fast")]
)
def test_the_best_motion_sampled_ten_times_finer_keeps_speeds_and_accelerations(device, speed, pelvis):
    _, robot, motion, _ = _case(device, 100, pelvis, speed)
    for walked in (motion.gait, motion.gait.resampled(1000)):
        for k, joint in enumerate(robot.joints):
            if not joint.startswith("pelvis_"):
                column = _column(joint)
                assert np.abs(walked.dq[:, column]).max() <= ROUNDED * robot.velocity[k]
                assert np.abs(walked.ddq[:, column]).max() <= ROUNDED * 200.0
    robot.check_limits(motion.q)


def _column(joint):
    from exo_pin.anatomy import JOINTS

    return JOINTS.index(joint)


@pytest.mark.parametrize("device", ["lokomat", "exo12"])
def test_a_recording_keeps_them_too(device, shared):
    gait = load_gait(shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot")
    body, conditions = Body.from_stature(mass=72.6), Conditions("device")
    found = best(walk(gait, body), robot_for(find(device), body, conditions), conditions).gait
    for n in (len(gait), 10 * len(gait), 10 * (len(gait) - 1) + 1):
        fine = found.resampled(n)
        assert np.abs(fine.ddq).max() <= 200.0
        assert np.abs(fine.dq).max() <= 12.0


@pytest.mark.parametrize("device", ["lokomat", "lopes8"])
def test_the_limit_of_acceleration_costs_less_than_half_a_percent(device):
    recorded, robot, motion, _ = _case(device, 100, "recorded")
    targets, base = sole_targets(robot, recorded.corners), recorded.base
    limits = rate_limits(recorded.gait, robot)
    endless = dataclasses.replace(limits, acceleration=np.full(len(robot.joints), np.inf))
    q = rate_limited(robot, targets, motion.q, endless, base=base)
    assert np.array_equal(q, motion.q)  # it keeps the speeds already
    plain = projected(recorded, robot).q
    free = rate_limited(
        robot, targets, plain + 0.2 * np.sin(40 * recorded.gait.time)[:, None], endless, base=base
    )
    limited, unlimited = (_rms(recorded, robot, each, base) for each in (motion.q, free))
    assert unlimited <= limited + SETTLED
    assert limited <= 1.005 * unlimited


def test_a_motion_that_keeps_its_limits_is_returned_as_it_is():
    recorded, robot, motion, _ = _case("h2", 100)
    targets = sole_targets(robot, recorded.corners)
    again = rate_limited(robot, targets, motion.q, rate_limits(recorded.gait, robot), base=recorded.base)
    assert np.array_equal(again, motion.q)


def test_a_cycle_may_be_cut_open_anywhere():
    recorded, robot, limits, base, q = _solved("lokomat", 60, speed=0.5)
    start = _case("lokomat", 60)[2].q
    rolled = [np.roll(x, 17, axis=0) for x in (recorded.corners, start, base)]
    again = rate_limited(robot, sole_targets(robot, rolled[0]), rolled[1], limits, base=rolled[2])
    one, other = (_rms(recorded, robot, each, base) for each in (q, np.roll(again, -17, axis=0)))
    assert one == pytest.approx(other, abs=SETTLED)


@pytest.mark.parametrize("device", ["planar7", "lopes8", "lokomat"])
def test_redundant_and_hurried_devices_keep_a_third_of_their_rates(device):
    _, robot, limits, _, q = _solved(device, 60, speed=0.3, acceleration=0.3)
    assert (limits.use(q) <= ROUNDED).all()
    assert limits.use(q).max() > 0.95  # the limits were in the way, and are used
    robot.check_limits(q)


def _open(rows, *, speed, acceleration):
    """The motion of some samples of a cycle on their own, its speeds scaled, and its limits."""
    recorded, robot, motion, _ = _case("lokomat", 45)
    clock = Clock(recorded.gait.time[rows], None)
    limits = RateLimits(clock, speed * robot.velocity, np.full(len(robot.joints), acceleration))
    targets = sole_targets(robot, recorded.corners[rows])
    return rate_limited(robot, targets, motion.q[rows], limits, base=_stand(robot, motion)[rows]), limits


def test_an_open_motion_does_not_return_to_its_start():
    q, limits = _open(slice(0, 20), speed=0.5, acceleration=100.0)
    assert (limits.use(q) <= ROUNDED).all()
    assert np.abs(q[0] - q[-1]).max() > 0.1


@pytest.mark.parametrize("samples", [2, 3, 4, 5])
def test_short_recordings_keep_their_limits(samples):
    q, limits = _open(slice(20, 20 + samples), speed=0.2, acceleration=10.0)
    assert (limits.use(q) <= ROUNDED).all()


def test_another_optimiser_finds_no_better_motion():
    from scipy.optimize import minimize

    recorded, robot, limits, base, found = _solved("lokomat", 8, speed=0.3, acceleration=0.3)
    rows = CycleRows.of(limits.clock, limits.velocity, np.minimum(limits.acceleration, 1e6))

    def cost(flat):
        return 1e3 * 64 * _rms(recorded, robot, flat.reshape(8, -1), base) ** 2

    def room(flat):
        rates = rows.rates(flat.reshape(8, -1).T).ravel()
        return np.concatenate([1 - rates, 1 + rates])

    bounds = list(zip(np.tile(robot.lower, 8), np.tile(robot.upper, 8), strict=True))
    other = minimize(
        cost, found.ravel(), bounds=bounds, constraints={"type": "ineq", "fun": room}, method="SLSQP"
    )
    assert cost(found.ravel()) <= other.fun * 1.01  # the spare of the limits, 0.2 %, counts twice and more


def test_both_kinds_of_rows_agree_on_a_smooth_cycle(rng):
    clock = Clock(np.arange(100) / 100, 1.0)
    phase = 2 * np.pi * clock.time
    x = np.array([np.sin(phase), 0.3 * np.cos(5 * phase + 1)])
    limits = np.array([3.0, 5.0]), np.array([70.0, 90.0])
    whole, local = CycleRows.of(clock, *limits), LocalRows.of(clock, *limits)
    for rows in (whole, local):  # the transpose is the transpose
        f = rng.normal(size=rows.rates(x).shape)
        assert (rows.rates(x) * f).sum() == pytest.approx((rows.forces(f) * x).sum())
    most = [np.abs(rows.rates(x)).max(axis=1) for rows in (whole, local)]
    assert most[0] == pytest.approx(most[1], rel=2e-3)  # between points a peak may hide


@pytest.mark.parametrize("period", [None, 1.0])
def test_banded_and_full_equations_have_one_solution(rng, period):
    even = np.arange(30) / 30
    clock = Clock(even if period else even + rng.uniform(0, 0.01, 30), period)
    rows = LocalRows.of(clock, np.array([3.0, 5.0]), np.array([70.0, 90.0]))
    blocks = np.einsum("ij,k->ijk", [[2.0, 0.5], [0.5, 1.0]], rng.uniform(1, 2, 30))
    stiff = rng.uniform(0, 1, rows.rates(np.zeros((2, 30))).shape)
    right = rng.normal(size=(2, 30))
    x = rows.solution(blocks, stiff, right)
    back = np.einsum("ijn,jn->in", blocks, x) + rows.forces(stiff * rows.rates(x))
    assert back == pytest.approx(right, abs=1e-9)


@pytest.mark.parametrize("even", [True, False])
def test_rates_of_a_recording_are_those_of_its_pieces(rng, even):
    time = np.linspace(0, 1, 12) if even else np.sort(rng.uniform(0, 1, 12))
    y = rng.normal(size=(12, 1))
    rows = LocalRows.of(Clock(time, None), np.ones(1), np.ones(1))
    fine = np.linspace(time[0], time[-1], 20001)
    dense = time_series.resampled(time, y, fine, periodic=False)
    for order, k in ((1, slice(0, 3)), (2, slice(3, 5))):
        measured = np.abs(time_series.derivative(fine, dense, order, None)).max()
        stated = np.abs(rows.rates(y.T).reshape(1, 11, 5)[..., k]).max()
        assert stated == pytest.approx(measured, rel=0.15 if order == 1 else 1e-2)

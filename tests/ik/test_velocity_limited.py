"""Motions under speed limits: the limits hold, nothing is lost without need, another optimiser agrees."""

import functools

import numpy as np
import pytest

from exo_pin.anatomy import FEET, Body
from exo_pin.compare import Conditions, best, projected, robot_for, walk
from exo_pin.compare.best_motion import velocity_step_limits
from exo_pin.compare.recorded_walk import corners, sole_targets
from exo_pin.devices import find
from exo_pin.gait import normative_gait
from exo_pin.ik.least_squares.velocity_limited import velocity_limited
from exo_pin.kinematics import poses

SPARED = 1.001  # the penalty leaves about 1e-5 rad of a step of 0.1 rad
HURRIED = 1.005  # the same excess of a smaller step
SAME = 1e-3  # mm: where two ways to one smooth minimum may stop
BODY = Body.from_stature()
TIGHT = ("lokomat", "lopes8", "planar5")


@functools.cache
def _case(device, samples, pelvis="device"):
    conditions = Conditions(pelvis)
    recorded, robot = walk(normative_gait().resampled(samples)), robot_for(find(device), BODY, conditions)
    return recorded, robot, best(recorded, robot, conditions), projected(recorded, robot, conditions)


def _stand(robot, motion):
    return motion.gait.base @ np.linalg.inv(robot.slid(motion.q))


def _missed(recorded, robot, q, base):
    return float(((corners(robot, poses(robot, q, FEET, base=base)) - recorded.corners) ** 2).sum())


def _speeds(q):
    return np.abs(np.diff(q, axis=0, append=q[:1]))


@pytest.mark.parametrize("device", TIGHT)
def test_the_best_motion_keeps_the_device_s_speeds_and_ranges(device):
    recorded, robot, motion, plain = _case(device, 100)
    assert (_speeds(motion.q) <= SPARED * velocity_step_limits(recorded.gait, robot)).all()
    robot.check_limits(motion.q)
    assert ((motion.corners - recorded.corners) ** 2).sum() < ((plain.corners - recorded.corners) ** 2).sum()


@pytest.mark.parametrize("device", TIGHT)
def test_a_motion_without_speed_limits_jumps_and_loses_hardly_less(device, monkeypatch):
    recorded, robot, motion, _ = _case(device, 100)
    monkeypatch.setattr(
        "exo_pin.compare.best_motion.velocity_limited", lambda robot, targets, q, pace, base: q
    )
    free = best(recorded, robot, Conditions("device"))
    assert (_speeds(free.q) > 1.5 * velocity_step_limits(recorded.gait, robot)).any()
    slow, quick = (((m.corners - recorded.corners) ** 2).sum(axis=-1).mean() ** 0.5 for m in (motion, free))
    assert quick <= slow < quick + 0.0005  # metres


def test_a_motion_that_keeps_its_step_limits_is_returned_as_it_is():
    recorded, robot, motion, _ = _case("h2", 100)
    targets = sole_targets(robot, recorded.corners)
    again = velocity_limited(
        robot, targets, motion.q, velocity_step_limits(recorded.gait, robot), base=recorded.base
    )
    assert np.array_equal(again, motion.q)


def test_a_cycle_may_be_cut_open_anywhere():
    recorded, robot, motion, plain = _case("lokomat", 60)
    base, steps = _stand(robot, motion), 0.5 * velocity_step_limits(recorded.gait, robot)
    whole = velocity_limited(robot, sole_targets(robot, recorded.corners), plain.q, steps, base=base)
    rolled = [np.roll(x, 17, axis=0) for x in (recorded.corners, plain.q, base)]
    again = velocity_limited(robot, sole_targets(robot, rolled[0]), rolled[1], steps, base=rolled[2])
    one, other = (
        1e3 * (_missed(recorded, robot, q, base) / 480) ** 0.5 for q in (whole, np.roll(again, -17, axis=0))
    )
    assert one == pytest.approx(other, abs=SAME)
    assert (_speeds(again) <= SPARED * steps).all()


def test_an_open_motion_does_not_return_to_its_start():
    recorded, robot, motion, _ = _case("lokomat", 45)
    base, targets = _stand(robot, motion), sole_targets(robot, recorded.corners)
    steps = 0.3 * velocity_step_limits(recorded.gait, robot)
    part, rows = {f: _first(t, 20) for f, t in targets.items()}, slice(0, 20)
    q = velocity_limited(robot, part, motion.q[rows], steps[:19], base=base[rows])
    assert (np.abs(np.diff(q, axis=0)) <= SPARED * steps[:19]).all()
    assert (np.abs(q[0] - q[-1]) > steps[19]).any()


def _first(points, count):
    return type(points)(points.local, points.p[:count])


def test_another_optimiser_finds_no_better_motion():
    from scipy.optimize import minimize

    recorded, robot, motion, _ = _case("lokomat", 6)
    base, targets = _stand(robot, motion), sole_targets(robot, recorded.corners)
    steps = 0.4 * velocity_step_limits(recorded.gait, robot)
    found = velocity_limited(robot, targets, motion.q, steps, base=base)
    assert (_speeds(motion.q) > steps).any()
    assert (_speeds(found) <= SPARED * steps).all()

    def cost(flat):
        return 1e3 * _missed(recorded, robot, flat.reshape(6, -1), base)

    def room(flat):
        move = np.diff(flat.reshape(6, -1), axis=0, append=flat.reshape(6, -1)[:1])
        return np.concatenate([(SPARED * steps - move).ravel(), (SPARED * steps + move).ravel()])

    bounds = list(zip(np.tile(robot.lower, 6), np.tile(robot.upper, 6), strict=True))
    other = minimize(
        cost, found.ravel(), bounds=bounds, constraints={"type": "ineq", "fun": room}, method="SLSQP"
    )
    assert cost(found.ravel()) <= other.fun * 1.001 + 1e-6


@pytest.mark.parametrize("device", ["planar7", "lopes8", "lokomat"])
def test_redundant_and_hurried_devices_keep_a_third_of_their_velocity(device):
    recorded, robot, motion, _ = _case(device, 60)
    steps = 0.3 * velocity_step_limits(recorded.gait, robot)
    assert (_speeds(motion.q) > steps).any()
    q = velocity_limited(
        robot, sole_targets(robot, recorded.corners), motion.q, steps, base=_stand(robot, motion)
    )
    assert (_speeds(q) <= HURRIED * steps).all()
    robot.check_limits(q)

"""Demand on joints: required against available, in the robot's own coordinates, the same in all rooms."""

import dataclasses
import math

import numpy as np
import pytest

from exo_pin import crosscheck, edit
from exo_pin.anatomy import JOINTS, Body
from exo_pin.demand import ACCELERATION_LIMIT, PeakDemand, RangeDemand, joint_demands, range_demands
from exo_pin.feasible import feasible
from exo_pin.gait import Gait, Torques, normative_gait, time_series
from exo_pin.robot import load_robot

GAIT = normative_gait().resampled(50)
KNEE = JOINTS.index("left_knee_flexion")
ROUNDED = 1e-12  # [rad, rad/s] a few operations on numbers of size one
BEYOND = 1e-3  # a factor this much beyond a limit exceeds it, this much below keeps it


def _of(demands, joint):
    return next(demand for demand in demands if demand.joint == joint)


def test_a_range_counts_what_lies_outside_and_on_its_limits():
    demand = RangeDemand(np.array([-1.0, -0.5, 0.0, 2.0, 2.5]), (-1.0, 2.0))
    assert demand.outside.tolist() == [False, False, False, False, True]
    assert (demand.samples_outside, demand.samples_at_limit) == (1, 3)
    assert (demand.lowest, demand.highest, demand.worst) == (-1.0, 2.5, 2.5)
    assert demand.margin == -0.5
    assert demand.use == pytest.approx(4 / 3)


def test_rounding_at_a_limit_does_not_count():
    assert not RangeDemand(np.array([1.0 + 5e-10]), (0.0, 1.0)).outside.any()
    assert RangeDemand(np.array([1.0 + 5e-9]), (0.0, 1.0)).outside.all()
    assert not PeakDemand(np.array([-1.0 - 5e-10]), 1.0).exceeded.any()
    assert PeakDemand(np.array([-1.0 - 5e-9]), 1.0).exceeded.all()


def test_the_worst_position_is_the_closest_to_a_limit_while_all_are_inside():
    assert RangeDemand(np.array([0.2, 0.5, 0.9]), (0.0, 1.0)).worst == 0.9
    assert RangeDemand(np.array([0.05, 0.5, 0.9]), (0.0, 1.0)).worst == 0.05


def test_a_locked_joint_has_no_share_of_its_range():
    assert math.isnan(RangeDemand(np.zeros(3), (0.0, 0.0)).use)


def test_a_position_that_is_not_a_number_is_outside():
    assert RangeDemand(np.array([np.nan]), (0.0, 1.0)).samples_outside == 1


def test_a_peak_is_a_size_and_unknown_values_do_not_count():
    demand = PeakDemand(np.array([np.nan, 1.0, -3.0]), 2.0)
    assert (demand.peak, demand.use) == (3.0, 1.5)
    assert demand.exceeded.tolist() == [False, False, True]
    unknown = PeakDemand(np.full(2, np.nan), 2.0)
    assert math.isnan(unknown.peak)
    assert not unknown.exceeded.any()


def test_without_an_actuator_any_demand_is_infinite_and_none_is_zero():
    assert PeakDemand(np.array([0.1]), 0.0).use == math.inf
    assert PeakDemand(np.zeros(1), 0.0).use == 0.0


def test_ranges_are_those_of_the_robot_in_its_own_order(robot):
    found = range_demands(robot, robot.from_gait(GAIT))
    assert tuple(found) == robot.joints
    limits = [demand.available for demand in found.values()]
    np.testing.assert_array_equal(limits, np.column_stack([robot.lower, robot.upper]))
    outside = robot.outside(robot.from_gait(GAIT))
    np.testing.assert_array_equal(np.column_stack([d.outside for d in found.values()]), outside)


def test_demands_are_the_gaits_own_angles_and_derivatives(robot):
    for k, demand in enumerate(joint_demands(robot, GAIT)):
        assert demand.joint == JOINTS[k]
        np.testing.assert_array_equal(demand.position.required, GAIT.q[:, k])
        np.testing.assert_array_equal(demand.speed.required, GAIT.dq[:, k])
        np.testing.assert_array_equal(demand.acceleration.required, GAIT.ddq[:, k])
        assert demand.speed.available == robot.velocity[k]
        assert demand.torque is None
        assert demand.power is None


def test_another_hip_order_has_its_own_angles_and_rates():
    robot = load_robot(hip_order="yaw_roll_pitch")
    angles = robot.angles(robot.from_gait(GAIT))
    demands = joint_demands(robot, GAIT)
    for j, joint in enumerate(robot.joints):
        demand = _of(demands, joint)
        np.testing.assert_array_equal(demand.position.required, angles[:, j])
        dq = time_series.derivative(GAIT.time, angles[:, j : j + 1], 1, GAIT.duration)[:, 0]
        np.testing.assert_allclose(demand.speed.required, dq, atol=ROUNDED)
    clinical = _of(joint_demands(load_robot(), GAIT), "left_hip_rotation")
    assert _of(demands, "left_hip_rotation").speed.peak != pytest.approx(clinical.speed.peak, rel=0.01)


def test_locked_joints_have_no_demand():
    robot = load_robot(device="hk4")
    assert {demand.joint for demand in joint_demands(robot, GAIT)} == set(robot.joints) & set(JOINTS)


def test_the_cadence_factor_leads_exactly_to_a_limit(robot):
    factor = min(demand.cadence_factor for demand in joint_demands(robot, GAIT))
    for faster, ok in ((factor * (1 - BEYOND), True), (factor * (1 + BEYOND), False)):
        assert all(demand.ok for demand in joint_demands(robot, GAIT.slowed(1 / faster))) is ok


def test_the_amplitude_factor_leads_exactly_to_a_limit(robot):
    factor, mean = min(d.amplitude_factor for d in joint_demands(robot, GAIT)), GAIT.q.mean(axis=0)
    for larger, ok in ((factor * (1 - BEYOND), True), (factor * (1 + BEYOND), False)):
        gait = dataclasses.replace(GAIT, q=mean + larger * (GAIT.q - mean))
        assert all(demand.ok for demand in joint_demands(robot, gait)) is ok


def test_a_joint_whose_mean_is_out_of_range_has_no_amplitude():
    robot = load_robot(Body.from_stature(limits={"left_knee_flexion": (0.0, 0.1)}))
    knee = _of(joint_demands(robot, GAIT), "left_knee_flexion")
    assert knee.amplitude_factor == 0.0
    assert not knee.ok


def test_standing_still_leaves_every_factor_open(robot):
    demands = joint_demands(robot, Gait(np.arange(5) / 10, np.zeros((5, 12))))
    assert {demand.cadence_factor for demand in demands} == {math.inf}
    assert {demand.amplitude_factor for demand in demands} == {math.inf}


def test_power_is_torque_times_velocity_and_has_no_limit(robot):
    tau = np.full((50, 12), np.nan)
    tau[:, KNEE] = 40.0
    demands = joint_demands(robot, GAIT, torques=Torques(GAIT.time, tau))
    knee = _of(demands, "left_knee_flexion")
    np.testing.assert_allclose(knee.power.required, 40.0 * GAIT.dq[:, KNEE])
    assert not knee.power.exceeded.any()
    assert knee.torque.available == robot.effort[KNEE]
    assert [demand.joint for demand in demands if demand.torque is not None] == ["left_knee_flexion"]


def test_every_room_reads_the_same_limits(robot):
    own = joint_demands(robot, GAIT)
    ranges = crosscheck.check(robot, GAIT).limits
    for demand, judged, again in zip(
        own, feasible(GAIT).joints, edit.recheck(robot, GAIT).demands, strict=True
    ):
        assert demand.joint == judged.joint == again.joint
        assert demand.acceleration.available == ACCELERATION_LIMIT
        for other in (judged, again):
            assert other.position.available == demand.position.available == ranges[demand.joint].available
            assert other.speed.available == demand.speed.available
            assert other.acceleration.available == demand.acceleration.available

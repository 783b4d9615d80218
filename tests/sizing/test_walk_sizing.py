"""Sizing of a walk: against the torques it comes from, the device's rectangle, support, passive joints."""

import dataclasses

import numpy as np
import pytest

from exo_pin import dynamics
from exo_pin.anatomy import JOINTS
from exo_pin.sizing import find_motor, joint_loads, size, stride_time


@pytest.fixture(scope="module")
def walk_dynamics(robot, gait):
    return dynamics.torques(robot, gait)


def test_loads_are_the_torques_and_rates_of_the_dynamics(walk_dynamics):
    loads = joint_loads(walk_dynamics)
    assert tuple(loads) == JOINTS
    for k, (name, load) in enumerate(loads.items()):
        np.testing.assert_array_equal(load.torque, walk_dynamics.torque[:, k], name)
        peak = walk_dynamics.facts()["joints"][name]
        assert load.facts()["peak_Nm"] == peak["peak_Nm"]
        assert load.peak_power == peak["peak_W"]


def test_speed_and_acceleration_are_derivatives_of_the_angle(walk_dynamics):
    step = walk_dynamics.time[1]
    for load in joint_loads(walk_dynamics).values():
        for curve, rate in ((load.angle, load.speed), (load.speed, load.acceleration)):
            central = (np.roll(curve, -1) - np.roll(curve, 1)) / (2 * step)
            # a central difference of 100 samples misses the 8th harmonic by (0.5)^2 / 6
            np.testing.assert_allclose(central, rate, atol=0.06 * np.abs(rate).max())


def test_without_a_motor_the_rectangle_of_the_record_counts(walk_dynamics):
    found = size(walk_dynamics)
    assert found.limit.startswith("rectangle")
    for joint in found.joints:
        assert joint.fits == (
            joint.load.peak_torque <= joint.effort and joint.load.peak_speed <= joint.velocity
        )
    assert found.reaction == "predicted"
    assert "predicted" in found.source


def test_energy_is_that_of_the_stride(walk_dynamics, robot, gait):
    stride = stride_time(robot, gait)
    assert stride == pytest.approx(len(gait) * gait.time[1], rel=1e-6)
    for joint in size(walk_dynamics, stride=stride).joints:
        power = joint.load.power
        expected = np.maximum(power, 0.0).sum() * gait.time[1]
        assert joint.load.energy() == pytest.approx(expected, rel=1e-6)


def test_without_a_stride_there_is_no_energy_and_a_remark(walk_dynamics):
    found = size(walk_dynamics, motor=find_motor("maxon-ec-90-flat-48v"))
    facts = found.facts()["joints"]["left_knee_flexion"]
    assert facts["energy_J_per_stride"] is None
    assert facts["motor"]["electrical_energy_J_per_stride"] is None
    assert "No stride time" in found.remarks[-1]


def test_frames_that_are_not_valid_are_left_out(walk_dynamics):
    torque = np.array(walk_dynamics.torque)
    torque[10:30] = np.nan
    valid = np.isfinite(torque).all(axis=1)
    partly = dataclasses.replace(walk_dynamics, torque=torque, valid=valid)
    load = joint_loads(partly)["left_hip_flexion"]
    assert len(load.torque) == len(torque) - 20
    assert load.share.sum() == pytest.approx(1.0)
    said = " ".join(size(partly).remarks)
    assert f"{len(torque) - 20} of {len(torque)} frames" in said
    assert "are valid; a whole stride" not in " ".join(size(walk_dynamics).remarks)


def test_a_given_ratio_decides_and_others_are_still_named(walk_dynamics):
    found = size(walk_dynamics, motor=find_motor("maxon-ec-90-flat-48v"), ratio=50.0)
    for joint in found.joints:
        assert joint.given.ratio == 50.0
        assert joint.fits == joint.given.fits
        inside = any(low <= 50.0 <= high for low, high in joint.ratios.ranges)
        assert inside == joint.given.fits

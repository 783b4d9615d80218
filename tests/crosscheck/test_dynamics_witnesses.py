"""Inverse dynamics by the paper's recursion, MuJoCo and OpenSim, against Pinocchio; and by closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import crosscheck
from exo_pin.anatomy import Body
from exo_pin.crosscheck import dynamics_witnesses, mujoco_inverse, random_states
from exo_pin.dynamics import floating_robot
from exo_pin.errors import DescriptionError
from exo_pin.robot import load_robot, load_urdf

UNEVEN = Body.from_stature(1.58, mass=52, sex="female", left_thigh=0.37, right_shank=0.36)
ROUNDING = 1e-12  # of a recursion over seven links, as a part of the state's largest force


def differences(robot, witness, n):
    """Largest relative difference of a witness to Pinocchio over n states."""
    model = floating_robot(robot, robot.masses)
    states = random_states.random_states(model, n)
    ours = dynamics_witnesses.by_pinocchio(model, states)
    off = np.abs(witness(model, states) - ours).max(axis=1)
    return float((off / np.abs(ours).max(axis=1)).max())


@pytest.mark.parametrize("hip_order", ["clinical", "yaw_roll_pitch"])
def test_the_recursion_agrees_on_a_thousand_states(hip_order):
    robot = load_robot(UNEVEN, hip_order=hip_order)
    assert differences(robot, dynamics_witnesses.by_recursion, 1000) <= ROUNDING


@pytest.mark.parametrize("device", ["lokomat", "planar9"])
def test_the_recursion_agrees_on_devices_with_fewer_and_with_further_joints(device):
    assert differences(load_robot(device=device), dynamics_witnesses.by_recursion, 100) <= ROUNDING


def test_mujoco_agrees_on_a_thousand_states(robot):
    pytest.importorskip("mujoco", reason="MuJoCo is not installed")
    assert differences(robot, mujoco_inverse.generalized_forces, 1000) <= crosscheck.DYNAMICS_TOLERANCE


def test_opensim_agrees_on_a_thousand_states(robot):
    pytest.importorskip("opensim", reason="OpenSim is not installed (extra `oracle`)")
    assert differences(robot, dynamics_witnesses.by_opensim, 1000) <= crosscheck.DYNAMICS_TOLERANCE


@pytest.mark.parametrize("what", ["velocity", "acceleration", "dq", "ddq", "wrench"])
def test_a_witness_that_leaves_out_a_part_of_the_state_does_not_agree(robot, what):
    model = floating_robot(robot, robot.masses)
    states = random_states.random_states(model, 5)
    lacking = states._replace(**{what: np.zeros_like(getattr(states, what))})
    ours = dynamics_witnesses.by_pinocchio(model, states)
    theirs = dynamics_witnesses.by_recursion(model, lacking)
    assert np.abs(theirs - ours).max() > 1e-3 * np.abs(ours).max()


def test_the_masses_of_the_wearer_alone_are_checked_as_they_are(robot):
    wearer = floating_robot(robot, "wearer")
    found = dynamics_witnesses.inverse_dynamics(wearer, 20)
    assert set(found) >= {"recursion"}
    assert max(found.values()) <= crosscheck.DYNAMICS_TOLERANCE


def test_a_urdf_from_elsewhere_has_no_witness(robot):
    with pytest.raises(DescriptionError, match="load_robot"):
        crosscheck.inverse_dynamics(load_urdf(robot.urdf))


def test_the_check_of_dynamics_covers_a_simulated_cycle(robot, gait):
    pytest.importorskip("mujoco")
    found = crosscheck.check(robot, gait.resampled(20), dynamics=True)
    assert found.dynamics["simulation"] <= crosscheck.DYNAMICS_TOLERANCE
    assert found.dynamics_ok

"""Planned walks with nothing at the pelvis: they stand, fall without their torques, and take pushes."""

import dataclasses
import math

import numpy as np
import pytest

from exo_pin.control import Reference
from exo_pin.control.stabiliser import Stabiliser
from exo_pin.dynamics import generalized_forces, torques
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.simulation import Push, simulate
from exo_pin.walking import footsteps, plan_walk

WITHOUT, WITH = 60.0, 40.0
"""Largest way of the pelvis off its path without and with the stabiliser [mm]."""


@pytest.fixture(scope="module")
def exo():
    return load_robot()


@pytest.fixture(scope="module")
def plan(exo):
    return plan_walk(exo, footsteps(4, 0.30))


@pytest.fixture(scope="module")
def steady(exo, plan):
    return simulate(exo, plan.gait, "pd_stabilised", support="none")


def test_a_plan_stands_without_and_better_with_the_stabiliser(exo, plan, steady):
    free = simulate(exo, plan.gait, "pd_free", support="none")
    assert free.stands, free.verdict.why
    assert free.free_numbers.pelvis_off_path_max_mm < WITHOUT
    assert steady.stands, steady.verdict.why
    assert steady.free_numbers.pelvis_off_path_max_mm < min(
        WITH, 0.5 * free.free_numbers.pelvis_off_path_max_mm
    )
    assert steady.free_numbers.zmp_outside_percent == 0.0
    assert steady.free_numbers.slip_max_mm < 20.0
    assert steady.witness < 1e-10


def test_without_feed_forward_and_stabiliser_it_falls(exo, plan):
    run = simulate(exo, plan.gait, "pd_only", support="none")
    assert run.verdict.word == "falls"
    assert not run.stands
    assert "outside" not in run.verdict.why  # the plan itself can be carried


def test_a_clinical_walk_falls_because_no_floor_can_carry_it(exo):
    run = simulate(exo, normative_gait(), support="none", cycles=2)
    assert run.verdict.word == "falls"
    assert run.free_numbers.zmp_outside_percent > 50.0
    assert "no floor alone can carry it" in run.verdict.why


def test_the_stabiliser_takes_a_push_and_comes_back_to_the_path(exo, plan):
    push = Push(0.0, 100.0, 0.1, 2.0)
    run = simulate(exo, plan.gait, "pd_stabilised", support="none", pushes=[push])
    assert run.stands, run.verdict.why
    off = np.linalg.norm((run.base - run.reference.base)[:, :2, 3], axis=1)
    assert off[-1] < 0.5 * off[2000:3000].max()


def test_the_mirrored_plan_runs_mirrored(exo, plan, steady):
    run = simulate(exo, plan.gait.mirrored(), "pd_stabilised", support="none")
    np.testing.assert_allclose(np.roll(run.q, 6, axis=1), steady.q, atol=1e-6)
    np.testing.assert_allclose(run.base[:, 1, 3], -steady.base[:, 1, 3], atol=1e-6)


@pytest.mark.parametrize(("forward", "left"), [(0.01, 0.0), (-0.01, 0.0), (0.0, 0.01), (0.0, -0.01)])
def test_the_ankles_press_where_the_body_errs(exo, plan, forward, left):
    """Standing still, the pelvis off by 10 mm: the added torques move the centre of pressure that way."""
    controller = Stabiliser()
    found = torques(exo, plan.gait, cutoff=None, free=True)
    controller.reset(found.robot, plan.gait)
    still, rest = np.zeros(12), np.zeros(6)
    q = found.motion.q[0, 7:]
    wanted = Reference(0.0, q, still, still, still, still)
    base = np.array(plan.gait.base[0])
    controller.sense(base, rest)
    before = controller(0.0, q, still, wanted)
    base[:2, 3] += [forward, left]
    controller.sense(base, rest)
    added = controller(0.0, q, still, wanted) - before
    moved = dataclasses.replace(found.ground, point=found.ground.point + 2.5 * np.array([forward, left, 0.0]))
    expected = generalized_forces(found.robot, found.motion, moved.wrench)[0, 6:] - found.torque[0]
    ankles = [4, 5, 10, 11]
    np.testing.assert_allclose(added[ankles], expected[ankles], atol=0.5)  # [N m]
    assert not np.delete(added, ankles).any()
    assert math.hypot(*added[ankles]) > 5.0


def test_on_a_walk_that_repeats_the_stabiliser_is_the_servo(exo):
    one, two = (simulate(exo, normative_gait("slow"), name, cycles=1) for name in ("pd", "pd_stabilised"))
    np.testing.assert_array_equal(one.q, two.q)

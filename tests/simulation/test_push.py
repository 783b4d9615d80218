"""Pushes at the pelvis: their direction, what they do, and what is refused."""

import dataclasses

import numpy as np
import pytest

from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait, normative_gait
from exo_pin.robot import load_robot
from exo_pin.simulation import Push, simulate

WITNESS = 1e-10
"""Largest relative difference of accelerations: rounding is 1e-13."""


@pytest.fixture(scope="module")
def exo():
    return load_robot()


@pytest.fixture(scope="module")
def slow(exo):
    return simulate(exo, normative_gait("slow"), cycles=1)


@pytest.mark.parametrize(("forward", "left"), [(200, 0), (-200, 0), (0, 200), (0, -200)])
def test_a_push_moves_the_pelvis_its_way(exo, slow, forward, left):
    run = simulate(exo, normative_gait("slow"), cycles=1, pushes=[Push(forward, left, 0.1, 0.5)])
    moved = run.base[600, :2, 3] - slow.base[600, :2, 3]
    assert moved @ [forward, left] > 0.8 * np.linalg.norm(moved) * 200
    np.testing.assert_array_equal(run.base[:500], slow.base[:500])
    assert run.witness < WITNESS


def test_forward_is_where_the_pelvis_heads(exo):
    time = np.linspace(0.0, 1.0, 101)
    turned = np.tile(exo.placement, (101, 1, 1))
    turned[:, :2, :2] = [[0.0, -1.0], [1.0, 0.0]]  # it heads left
    still = Gait(time, np.zeros((101, 12)), base=turned)
    one, two = (
        simulate(exo, gait, pushes=[Push(100.0, 0.0, 0.1, 0.2)])
        for gait in (still, dataclasses.replace(still, base=np.tile(exo.placement, (101, 1, 1))))
    )
    np.testing.assert_allclose(one.base[300, 1, 3], two.base[300, 0, 3], rtol=1e-6)


def test_the_support_s_wrench_leaves_the_push_out(exo):
    run = simulate(
        exo, normative_gait("slow"), cycles=1, pushes=[Push(300.0, 0.0, 0.05, 0.5)], support="none"
    )
    assert (run.support_wrench == 0.0).all()


@pytest.mark.parametrize("values", [(np.nan, 0, 0.1, 1), (0, 2e4, 0.1, 1), (1, 1, 0, 1), (1, 1, 0.1, -1)])
def test_a_push_with_a_wrong_number_is_refused(values):
    with pytest.raises(DescriptionError, match="push"):
        Push(*values)


def test_a_push_after_the_end_is_refused(exo):
    with pytest.raises(DescriptionError, match="after the end"):
        simulate(exo, normative_gait(), cycles=1, pushes=[Push(60, 0, 0.1, 30.0)])

"""The step within limits: optimal by the conditions of Karush, Kuhn and Tucker, for one sample and many."""

import numpy as np
import pytest

from exo_pin.ik.least_squares.box_qp import box_step, convex_hessian, definite, newton_step

EXACT = 1e-9  # of gradients of about 1: the systems have condition numbers up to 1e4


@pytest.fixture(params=[1, 2, 6, 9])
def programs(request, rng):
    """Random strictly convex programs of 60 samples; a third of the bounds is zero."""
    size, m = request.param, 60
    J = rng.normal(size=(size + 1, size, m))
    A = np.einsum("kim,kjm->ijm", J, J) + 1e-3 * np.eye(size)[..., None]
    b = rng.normal(size=(size, m))
    lower, upper = (rng.uniform(0, 1, (size, m)) * (rng.random((size, m)) > 1 / 3) for _ in range(2))
    return A, b, -lower, upper


def test_the_step_stays_in_the_box_and_no_feasible_direction_improves_it(programs):
    A, b, lower, upper = programs
    x = box_step(A, b, lower, upper)
    descent = b - np.einsum("ijm,jm->im", A, x)
    assert ((lower <= x) & (x <= upper)).all()
    assert np.abs(descent[(lower < x) & (x < upper)]).max(initial=0.0) < EXACT
    assert (descent[(x == lower) & (x < upper)] < EXACT).all()
    assert (descent[(x == upper) & (x > lower)] > -EXACT).all()


def test_one_sample_and_many_take_the_same_step(programs):
    A, b, lower, upper = programs
    x = box_step(A, b, lower, upper)
    for k in range(x.shape[1]):
        one = box_step(A[..., k], b[:, k], lower[:, k], upper[:, k])
        assert one == pytest.approx(x[:, k], abs=EXACT)


def test_a_wide_box_leaves_the_free_minimum(programs):
    A, b, _, _ = programs
    x = box_step(A, b, np.full(b.shape, -np.inf), np.full(b.shape, np.inf))
    assert np.einsum("ijm,jm->im", A, x) == pytest.approx(b, abs=EXACT)


def test_definite_matrices_are_told_from_indefinite_ones(rng):
    values = (
        rng.uniform(0.1, 1.0, (6, 40))
        * np.where(np.arange(40) < 20, 1.0, -1.0) ** (np.arange(6) == 2)[:, None]
    )
    Q = np.linalg.qr(rng.normal(size=(40, 6, 6)))[0]
    A = np.einsum("mij,jm,mkj->ikm", Q, values, Q)
    expected = np.arange(40) < 20
    assert np.array_equal(definite(A), expected)
    assert [bool(definite(A[..., k])) for k in range(40)] == expected.tolist()


def test_an_indefinite_hessian_falls_back_to_gauss_newton():
    gauss_newton, negative = np.diag([1.0, 2.0]), np.diag([-3.0, 0.0])
    free = np.array([True, True])
    assert np.array_equal(convex_hessian(gauss_newton, negative, 0.5, free), np.diag([1.5, 2.5]))
    assert np.array_equal(convex_hessian(gauss_newton, -negative, 0.5, free), np.diag([4.5, 2.5]))


def test_a_joint_that_is_pressed_against_its_limit_does_not_spoil_the_others():
    b, second_order = np.array([-1.0, 1.0]), np.diag([-5.0, 1.0])
    x = newton_step(b, np.eye(2), second_order, 0.0, np.array([0.0, -9.0]), np.array([9.0, 9.0]))
    assert x == pytest.approx(
        [0.0, 0.5]
    )  # the whole Hessian of the second joint, though the first is concave

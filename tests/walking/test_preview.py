"""Preview control and the tridiagonal solution are each other's witness; SciPy is the gains'."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from exo_pin.errors import DescriptionError
from exo_pin.walking import Preview, com_of_zmp
from tests.walking.test_pendulum import DT, HEIGHT, zmp_steps


@pytest.mark.parametrize("jerk", [1e-6, 1e-3])
def test_the_cost_is_scipys_solution_of_the_riccati_equation(jerk):
    servo = Preview(DT, HEIGHT, jerk=jerk)
    A, B = servo.system
    P = solve_discrete_are(A, B, np.diag([1.0, 0.0, 0.0, 0.0]), [[jerk]])
    assert np.abs(servo.cost - P).max() < 1e-9 * np.abs(P).max()
    gain = np.linalg.solve([[jerk]] + B.T @ P @ B, B.T @ P @ A)[0]
    assert np.allclose(servo.gains[0], gain, rtol=1e-7)


def test_the_closed_loop_is_stable():
    servo = Preview(DT, HEIGHT)
    A, B = servo.system
    assert np.abs(np.linalg.eigvals(A - B @ servo.gains[0][None])).max() < 1.0


def test_the_further_it_sees_the_nearer_it_comes_to_the_exact_path():
    zmp = zmp_steps()
    exact = com_of_zmp(zmp, DT, HEIGHT)
    off = [np.abs(Preview(DT, HEIGHT, horizon=h).com(zmp) - exact).max() for h in (1.0, 1.6, 2.4)]
    assert off[0] > off[1] > off[2]
    assert off[1] < 0.002
    assert off[2] < 0.0002


@pytest.mark.parametrize("bad", [{"dt": 0.0}, {"horizon": 0.005}, {"jerk": -1.0}, {"height": np.nan}])
def test_what_is_no_servo_is_refused(bad):
    with pytest.raises(DescriptionError):
        Preview(**({"dt": DT, "height": HEIGHT} | bad))

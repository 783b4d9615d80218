"""The pendulum against its closed form, its own inverse, and the physics that its words promise."""

import numpy as np
import pytest

from exo_pin.errors import DescriptionError
from exo_pin.physics import GRAVITY
from exo_pin.walking import (
    com_of_zmp,
    divergent_component,
    fall,
    orbital_energy,
    time_constant,
    zmp_of_com,
)

HEIGHT = 0.9
DT = 0.005


def zmp_steps(n=1600):
    """A ZMP that rests, jumps from foot to foot and rests."""
    time = DT * np.arange(n)
    x = 0.3 * np.clip(np.floor((time - 2.0) / 0.8), 0, 4)
    y = 0.085 * np.where((time > 2.0) & (time < 6.0), np.sign(np.sin(np.pi * (time - 2.0) / 0.8)), 0.0)
    return np.stack([x, y], axis=1)


def test_the_centre_of_mass_has_exactly_the_zmp_that_was_asked_for():
    zmp = zmp_steps()
    assert np.abs(zmp_of_com(com_of_zmp(zmp, DT, HEIGHT), DT, HEIGHT) - zmp).max() < 1e-11


def test_between_two_jumps_of_the_zmp_the_path_is_the_closed_form():
    zmp = zmp_steps()
    com = com_of_zmp(zmp, DT, HEIGHT)
    a, b = 430, 550  # within the first step, between 2 s and 2.8 s
    velocity = (com[a + 1] - com[a - 1]) / (2 * DT)
    closed = fall(com[a], velocity, zmp[a], HEIGHT, DT * np.arange(b - a))
    assert np.abs(closed - com[a:b]).max() < 2e-5  # second differences of 5 ms steps


def test_the_end_of_the_walk_is_at_rest_over_its_foot():
    zmp = zmp_steps()
    com = com_of_zmp(zmp, DT, HEIGHT)
    assert np.abs(com[-1] - zmp[-1]).max() == 0.0
    assert np.abs(com[-1] - com[-2]).max() / DT < 0.01  # 2 s = 7 time constants after the last step


def test_a_pendulum_whose_foot_is_put_at_the_capture_point_stops_above_it():
    x, v = np.array([0.1, -0.02]), np.array([0.5, 0.1])
    foot = divergent_component([x], [v], HEIGHT)[0]
    # e^-8 of the distance is left, and e^8 of the rounding
    assert np.abs(fall(x, v, foot, HEIGHT, [8 * time_constant(HEIGHT)])[0] - foot).max() < 1e-3


def test_the_divergent_component_leaves_the_zmp_exponentially():
    x, v, p = np.array([0.1, 0.0]), np.array([0.2, 0.3]), np.array([0.05, 0.1])
    t, step = 0.4, 1e-6
    now, before, after = fall(x, v, p, HEIGHT, [t, t - step, t + step])
    later = divergent_component([now], [(after - before) / (2 * step)], HEIGHT)[0]
    expected = p + (divergent_component([x], [v], HEIGHT)[0] - p) * np.exp(t / time_constant(HEIGHT))
    assert np.allclose(later, expected, atol=1e-8)


@pytest.mark.parametrize(("speed", "passes"), [(0.4, True), (0.2, False)])
def test_orbital_energy_is_constant_and_its_sign_says_whether_the_body_passes_its_foot(speed, passes):
    x, v, p = np.array([-0.1, 0.0]), np.array([speed, 0.0]), np.zeros(2)
    time, step = np.linspace(0.0, 1.0, 11), 1e-6
    path = fall(x, v, p, HEIGHT, time)
    rate = (fall(x, v, p, HEIGHT, time + step) - fall(x, v, p, HEIGHT, time - step)) / (2 * step)
    energy = orbital_energy(path, rate, np.zeros((11, 2)), HEIGHT)
    assert np.ptp(energy[:, 0]) < 1e-7
    assert (energy[0, 0] > 0) == passes == bool((path[:, 0] > 0).any())


def test_the_time_constant_is_the_root_of_height_over_gravity():
    assert time_constant(GRAVITY) == 1.0


@pytest.mark.parametrize("bad", [{"dt": 0.0}, {"dt": np.nan}, {"height": -1.0}, {"zmp": [[np.nan, 0.0]] * 3}])
def test_numbers_that_are_no_path_are_refused(bad):
    with pytest.raises(DescriptionError):
        com_of_zmp(**({"zmp": np.zeros((4, 2)), "dt": DT, "height": HEIGHT} | bad))

"""Loads of a sinusoid, known in closed form: rms, power, energy, spring, gear ratios."""

import math

import numpy as np
import pytest

from exo_pin.errors import DescriptionError
from exo_pin.sizing import JointLoad, Motor, fitting_ratios, geared, motor_torque

_N = 400
_OMEGA = 2 * math.pi / 1.2  # of a stride of 1.2 s
_ROUNDING = 1e-9  # sums of sinusoids over a whole period are exact
_SAMPLED = 1e-3  # sums of their positive parts are not: kinks between samples


def swinging(torque=20.0, amplitude=0.4, lag=0.0, offset=0.0, rest=0.0):
    """A joint that swings as a sine, with a sinusoidal torque that lags behind its speed by `lag`."""
    phase = 2 * np.pi * np.arange(_N) / _N
    return JointLoad(
        joint="left_knee_flexion",
        angle=rest + amplitude * np.sin(phase),
        speed=amplitude * _OMEGA * np.cos(phase),
        acceleration=-amplitude * _OMEGA**2 * np.sin(phase),
        torque=offset + torque * np.cos(phase - lag),
        share=np.full(_N, 1 / _N),
        stride=1.2,
    )


def motor(**changes):
    numbers = {"no_load_speed": 300.0, "peak_torque": 3.0, "continuous_torque": 0.5, "rotor_inertia": 1e-4}
    return Motor(name="m", source="a test", efficiency=0.8, **(numbers | changes))


def test_a_sinusoidal_torque_has_the_rms_power_and_energy_of_the_textbook():
    load = swinging()
    assert load.rms_torque == pytest.approx(20.0 / math.sqrt(2), rel=_ROUNDING)
    assert load.peak_speed == pytest.approx(0.4 * _OMEGA, rel=_ROUNDING)
    assert load.peak_power == pytest.approx(20.0 * 0.4 * _OMEGA, rel=_ROUNDING)
    # in phase with the speed: P = A cos^2, all of it driving; over a period pi x torque x amplitude
    assert load.energy() == pytest.approx(math.pi * 20.0 * 0.4, rel=_ROUNDING)
    assert load.energy(recovery=True) == pytest.approx(load.energy(), rel=_ROUNDING)


def test_recovery_gives_back_what_a_torque_across_the_speed_stores():
    load = swinging(lag=math.pi / 2)  # P = A sin(2 phase) / 2: as much driving as braking, A / pi / 2 each
    driving = 20.0 * 0.4 * _OMEGA / (2 * math.pi) * 1.2
    assert load.energy(recovery=True) == pytest.approx(0.0, abs=_ROUNDING)
    assert load.energy() == pytest.approx(driving, rel=_SAMPLED)
    spent = load.energy(efficiency=0.8, recovery=True)
    assert spent == pytest.approx(driving / 0.8 - driving * 0.8, rel=_SAMPLED)


def test_the_spring_is_found_again_and_takes_the_whole_torque():
    stiffness = 20.0 / 0.4
    load = swinging(lag=-math.pi / 2, rest=0.3)  # torque -20 sin: towards the middle of the swing
    spring = load.spring()
    assert spring.stiffness == pytest.approx(stiffness, rel=_ROUNDING)
    assert spring.rest == pytest.approx(0.3, rel=_ROUNDING)
    assert load.beside(spring).rms_torque == pytest.approx(0.0, abs=1e-7)


def test_a_spring_drives_the_joint_towards_its_rest_and_a_constant_torque_moves_that():
    load = swinging(lag=-math.pi / 2, offset=10.0)
    spring = load.spring()
    assert spring.torque(np.array([spring.rest + 0.1]))[0] < 0.0
    assert spring.torque(np.array([spring.rest - 0.1]))[0] > 0.0
    assert spring.rest == pytest.approx(10.0 / 50.0, rel=_ROUNDING)  # a rest further forward pushes forward


def test_no_spring_is_found_where_the_torque_drives_away_from_the_middle():
    assert swinging(lag=math.pi / 2).spring() is None
    assert swinging(amplitude=0.0).spring() is None


@pytest.mark.parametrize("lag", [0.0, 0.7, 2.0])
def test_no_other_spring_leaves_a_smaller_rms(lag):
    load = swinging(lag=lag - math.pi / 2, offset=5.0)
    spring = load.spring()
    least = math.inf if spring is None else load.beside(spring).rms_torque
    rng = np.random.default_rng(0)
    for stiffness, constant in zip(rng.uniform(0, 100, 200), rng.uniform(-20, 20, 200), strict=True):
        left = load.rms(load.torque + stiffness * load.angle - constant)
        assert spring is None or left >= least - _ROUNDING


def test_the_rotor_adds_its_reflected_inertia_in_the_direction_of_the_acceleration():
    load, heavy = swinging(torque=0.0), motor(rotor_inertia=1e-3)
    at_joint = 50.0 * motor_torque(load, heavy, 50.0)
    np.testing.assert_allclose(at_joint, 50.0**2 * 1e-3 * load.acceleration, rtol=1e-12)
    assert geared(load, heavy, 50.0).inertia == pytest.approx(2.5)


def test_the_best_ratio_without_other_limits_matches_inertias():
    """Thermal rms is smallest at ratio^2 = rms torque / (J rms acceleration), both across each other."""
    load, light = swinging(lag=0.0), motor(rotor_inertia=3e-4, no_load_speed=1e6, peak_torque=1e3)
    expected = math.sqrt(load.rms_torque / (3e-4 * load.rms(load.acceleration)))
    found = fitting_ratios(load, Motor(**{**vars(light), "continuous_torque": 10.0}))
    assert found.best.ratio == pytest.approx(expected, rel=0.02)  # one step of the ratios that are tried


@pytest.mark.parametrize("torque", [5.0, 20.0, 60.0])
def test_the_bounds_of_the_ratios_are_those_of_brute_force(torque):
    load, drive = swinging(torque=torque), motor(continuous_torque=0.8)
    tried = np.linspace(1.0, 400.0, 8001)  # every 0.05
    fits = np.array([geared(load, drive, float(ratio)).fits for ratio in tried])
    ((low, high),) = fitting_ratios(load, drive).ranges
    assert low == pytest.approx(tried[fits][0], abs=0.05)
    assert high == pytest.approx(tried[fits][-1], abs=0.05)


def test_of_several_walks_a_ratio_fits_them_all():
    easy, hard, drive = swinging(torque=5.0), swinging(torque=60.0), motor(continuous_torque=0.8)
    ((low, high),) = fitting_ratios([easy, hard], drive).ranges
    for ratio in (low, high):
        assert geared(easy, drive, ratio).fits
        assert geared(hard, drive, ratio).fits
    assert low == pytest.approx(fitting_ratios(hard, drive).ranges[0][0], rel=1e-9)


def test_a_motor_that_is_too_weak_has_no_ratio_but_the_nearest_one():
    found = fitting_ratios(swinging(torque=500.0), motor())
    assert found.ranges == ()
    assert found.best.worst > 1.0


@pytest.mark.parametrize("ratio", [0.0, -50.0, math.nan, math.inf])
def test_ratios_that_no_gear_has_are_refused(ratio):
    with pytest.raises(DescriptionError, match="ratio"):
        geared(swinging(), motor(), ratio)

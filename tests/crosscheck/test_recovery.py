"""Angles recovered from exact and from noisy feet, and the convergence of the iteration."""

import pytest

from exo_pin import crosscheck, ik

EVEN = 0.35  # how far a gait's rms error with 3 mm noise may lie from three times that with 1 mm, as a share


def test_the_loops_error_falls_to_the_tolerance(robot, gait):
    errors = crosscheck.errors_by_step(robot, gait, 30, tolerance=1e-9)
    assert errors[-1] <= 1e-9 < errors[-2]
    assert errors[0] > 0.1


def test_own_feet_are_exact_and_noise_grows_with_its_size(robot, gait):
    own = crosscheck.recover(robot, gait, settings=ik.Dls())
    assert max(own.largest_by_movement().values()) < 1e-6
    one, three = (crosscheck.recover_noisy(robot, gait, sd) for sd in (1e-3, 3e-3))
    for movement in ("hip_adduction", "hip_rotation"):  # far from singular: errors are linear in the noise
        ratio = three.rms_by_movement()[movement] / one.rms_by_movement()[movement]
        assert ratio == pytest.approx(3, rel=EVEN)
    damped = crosscheck.recover_noisy(robot, gait, 3e-3, damping=0.05)
    assert damped.rms_by_movement()["knee_flexion"] < three.rms_by_movement()["knee_flexion"]

"""Motor files: units, sources, and one line for what is not accepted."""

import math

import numpy as np
import pytest

from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.sizing import Motor, example_motors, find_motor, load_motor

ENTRIES = {
    "name": '"a motor"',
    "source": '"its data sheet"',
    "no_load_speed_rpm": "3000",
    "peak_torque_nm": "4.0",
    "continuous_torque_nm": "0.5",
    "rotor_inertia_kgm2": "1e-4",
    "efficiency": "0.8",
}


def written(tmp_path, **changes):
    """A motor file with entries changed, or left out where they are None."""
    entries = {name: text for name, text in (ENTRIES | changes).items() if text is not None}
    path = tmp_path / "motor.toml"
    path.write_text("\n".join(f"{name} = {text}" for name, text in entries.items()), encoding="utf-8")
    return path


def test_speeds_in_rpm_and_in_rad_s_mean_the_same(tmp_path):
    turns = load_motor(written(tmp_path))
    radians = load_motor(written(tmp_path, no_load_speed_rpm=None, no_load_speed_rad_s=f"{100 * math.pi!r}"))
    assert turns.no_load_speed == pytest.approx(radians.no_load_speed, rel=1e-12)
    assert turns.peak_torque == 4.0


@pytest.mark.parametrize("name", example_motors())
def test_every_example_names_its_source_and_its_line_yields_a_plausible_power(name):
    motor = find_motor(name)
    assert len(motor.source) > 20
    assert motor.continuous_torque < motor.peak_torque
    # largest power of a straight line: half the torque at half the speed
    assert 50.0 < motor.peak_torque * motor.no_load_speed / 4 < 1000.0


@pytest.mark.parametrize("missing", [name for name in ENTRIES if name != "name"])
def test_an_entry_that_is_missing_is_named(tmp_path, missing):
    with pytest.raises(FormatError, match=missing) as caught:
        load_motor(written(tmp_path, **{missing: None}))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "changes",
    [
        {"no_load_speed_rpm": "0"},
        {"no_load_speed_rpm": '"fast"'},
        {"no_load_speed_rad_s": "300"},
        {"peak_torque_nm": "-1"},
        {"peak_torque_nm": "nan"},
        {"continuous_torque_nm": "5.0"},
        {"rotor_inertia_kgm2": "-1e-4"},
        {"efficiency": "85"},
        {"efficiency": "true"},
        {"source": '" "'},
        {"colour": '"red"'},
    ],
)
def test_numbers_that_no_motor_has_are_refused_with_the_file(tmp_path, changes):
    path = written(tmp_path, **changes)
    with pytest.raises(FormatError, match=r"motor\.toml"):
        load_motor(path)


def test_an_unknown_example_is_answered_with_the_known_ones():
    with pytest.raises(UnknownNameError, match="maxon"):
        find_motor("maxon-ec-90")


def test_driving_is_limited_by_the_line_and_braking_by_the_peak_torque():
    motor = Motor("m", "s", 100.0, 4.0, 0.5, 0.0, 1.0)
    torque, speed = np.array([2.0, -2.0, 2.0, 4.0]), np.array([50.0, -50.0, -50.0, 0.0])
    np.testing.assert_allclose(motor.line_use(torque, speed), [1.0, 1.0, 0.5, 1.0])

"""Patients: passive moments push back, files say what they mean, motors and person share a torque."""

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.control import PATIENTS, find_patient, load_patient, passive_moments, shares
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError


def at(**degrees):
    """Joint angles with both legs at these movements."""
    return np.radians([next((d for name, d in degrees.items() if j.endswith(name)), 0.0) for j in JOINTS])


def moment(joint, **degrees):
    return passive_moments(at(**degrees))[JOINTS.index(f"left_{joint}")]


@pytest.mark.parametrize(
    ("joint", "degrees", "expected"),
    [  # computed by hand from the published coefficients
        ("hip_flexion", {"hip_flexion": -20.0}, 25.4),
        ("hip_flexion", {"hip_flexion": 100.0, "knee_flexion": 60.0}, -12.8),
        ("knee_flexion", {"knee_flexion": 0.0, "hip_flexion": 20.0}, 13.7),
        ("knee_flexion", {"knee_flexion": 120.0, "hip_flexion": 20.0}, -10.2),
    ],
)
def test_a_moment_pushes_back_from_the_end_of_a_range(joint, degrees, expected):
    assert moment(joint, **degrees) == pytest.approx(expected, abs=0.3)


def test_the_ankle_is_pushed_back_from_both_ends():
    assert moment("ankle_dorsiflexion", ankle_dorsiflexion=20.0) < -20.0
    assert moment("ankle_dorsiflexion", ankle_dorsiflexion=-40.0) > 0.0


def test_the_gastrocnemius_gives_less_as_the_knee_bends():
    straight, bent = (
        moment("ankle_dorsiflexion", ankle_dorsiflexion=15.0, knee_flexion=k) for k in (0.0, 60.0)
    )
    assert straight < bent < 0.0


def test_one_sample_and_many_are_alike():
    q = np.random.default_rng(0).uniform(-1.5, 2.0, (20, 12))
    np.testing.assert_allclose(passive_moments(q), [passive_moments(row) for row in q], rtol=1e-13)


def test_beyond_the_data_the_moment_stays():
    beyond, last = (moment("knee_flexion", knee_flexion=k) for k in (150.0, 120.0))
    assert beyond == pytest.approx(last, abs=1e-12)


def test_a_joint_s_row_goes_before_its_movement_and_that_before_its_side(tmp_path):
    path = tmp_path / "paretic.toml"
    path.write_text(
        'name = "after a stroke"\npassive = false\ndelay_s = 0.05\n[activity]\nright = 0.5\n'
        "knee_flexion = 0.7\nright_knee_flexion = 0.2\n[stiffness_nm_rad]\nleft = 20\n"
    )
    patient = load_patient(path)
    activity = dict(zip(JOINTS, patient.activity, strict=True))
    assert (patient.name, patient.passive, patient.delay) == ("after a stroke", False, 0.05)
    assert activity["right_hip_flexion"] == 0.5
    assert activity["left_knee_flexion"] == 0.7
    assert activity["right_knee_flexion"] == 0.2
    assert activity["left_hip_flexion"] == 1.0
    assert patient.stiffness.tolist() == [20.0] * 6 + [0.0] * 6


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("[activity]\nright = 3\n", "from 0 to 1"),
        ("[activity]\nrihgt = 0.3\n", "right"),
        ("[activity]\nright = true\n", "number"),
        ("activity = 0.3\n", "table"),
        ("actvity = 0.3\n", "activity"),
        ("delay_s = 30\n", "from 0 to 1"),
        ("passive = 1\n", "true or false"),
        ("[activity]\nright = nan\n", "finite"),
    ],
)
def test_a_file_with_a_mistake_is_refused_with_what_is_accepted(tmp_path, text, word):
    path = tmp_path / "patient.toml"
    path.write_text(text)
    with pytest.raises(FormatError, match=word):
        load_patient(path)


def test_presets_are_found_as_people_type_them():
    assert find_patient("Paretic-Right").activity.tolist() == [1.0] * 6 + [0.5] * 6
    with pytest.raises(UnknownNameError, match="plegic"):
        find_patient("plegik")


def test_motors_and_person_share_the_torque():
    rng = np.random.default_rng(1)
    tau, q, dq = rng.normal(size=(3, 5, 12))
    for patient in (None, *(make() for make in PATIENTS.values())):
        for assist in (None, 0.0, 0.5, 1.0):
            motors, person = shares(tau, q, dq, patient, assist)
            np.testing.assert_allclose(motors + person, tau, atol=1e-12)
    healthy = find_patient("healthy")
    motors, _ = shares(tau, q, dq, healthy)
    np.testing.assert_allclose(motors, -healthy.tissues(q), atol=1e-12)  # nothing but what the tissues take
    half, _ = shares(tau, q, dq, find_patient("plegic"), 0.5)
    np.testing.assert_allclose(half, 0.5 * (tau - passive_moments(q)), atol=1e-12)
    with pytest.raises(DescriptionError, match="from 0 to 1"):
        shares(tau, q, dq, healthy, 1.5)


def test_spasticity_acts_against_fast_movement_alone(tmp_path):
    path = tmp_path / "spastic.toml"
    path.write_text(
        "spastic_threshold_rad_s = 2\n[spasticity_nms_rad]\nankle_dorsiflexion = 4\n"
        "[stiffness_nm_rad]\nleft = 0\n[damping_nms_rad]\nleft = 0\n"
    )
    patient = load_patient(path)
    k, still = JOINTS.index("left_ankle_dorsiflexion"), np.zeros(12)
    assert patient.own(still, np.full(12, 1.9), still, still)[k] == 0.0
    assert patient.own(still, np.full(12, 3.0), still, still)[k] == pytest.approx(-4.0)
    assert patient.own(still, np.full(12, -3.0), still, still)[k] == pytest.approx(4.0)

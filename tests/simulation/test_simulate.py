"""Simulated walks: what walks, what hangs, what the numbers mean, and what is refused."""

import dataclasses

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.control import Patient, find_controller
from exo_pin.errors import DescriptionError, ExoPinError, UnknownNameError
from exo_pin.gait import Gait, normative_gait
from exo_pin.robot import load_robot
from exo_pin.simulation import PelvisSupport, Plant, motor_torques, simulate, walked, wanted

ENERGY = 0.2
"""Largest error of the energy balance [%]: the step is 1 ms."""

STEP = 0.03
"""Largest relative change of a number where the step is halved or doubled."""


@pytest.fixture(scope="module")
def exo():
    return load_robot()


@pytest.fixture(scope="module")
def free(exo):
    return simulate(exo, normative_gait(), cycles=3)


def test_the_free_walk_walks(free):
    assert free.verdict.word == "walks", free.verdict.why
    assert free.numbers.tracking_rms_deg < 0.75
    assert free.numbers.swing_contact_percent == {"left": 0.0, "right": 0.0}
    assert free.numbers.vertical_force_mean_bw == pytest.approx(1.0, abs=0.005)
    assert free.energy_balance_percent < ENERGY


def test_motors_off_and_nobody_inside_it_hangs(exo):
    run = simulate(exo, normative_gait("slow"), "off", cycles=2)
    assert (run.verdict.word, run.numbers.motor_rms["left_knee_flexion"]) == ("falls", 0.0)
    assert "hangs" in run.verdict.why


def test_body_weight_support_takes_its_part_of_the_weight(exo):
    run = simulate(exo, normative_gait("slow"), cycles=3, body_weight_support=0.3)
    assert run.verdict.word == "walks", run.verdict.why
    assert run.numbers.vertical_force_mean_bw == pytest.approx(0.7, abs=0.005)


def test_the_step_hardly_matters(exo):
    gait = normative_gait("slow")
    found = [simulate(exo, gait, cycles=2, timestep=step).numbers for step in (0.002, 0.001, 0.0005)]
    for one in (found[0], found[2]):
        assert one.tracking_rms_deg == pytest.approx(found[1].tracking_rms_deg, rel=STEP)
        assert one.vertical_force_mean_bw == pytest.approx(found[1].vertical_force_mean_bw, rel=STEP)


def test_a_stiff_support_carries_weight_itself(exo):
    soft, stiff = (
        simulate(exo, normative_gait("slow"), cycles=2, support=name).numbers.vertical_force_mean_bw
        for name in ("soft", "stiff")
    )
    assert stiff < soft - 0.01


def test_the_mirrored_walk_runs_mirrored(exo):
    activity = np.r_[np.ones(6), np.full(6, 0.5)]
    mirrored = np.roll(activity, 6)
    gait = normative_gait("slow")
    pair = [
        simulate(exo, walk, patient=Patient("p", share), cycles=1)
        for walk, share in ((gait, activity), (gait.mirrored(), mirrored))
    ]
    np.testing.assert_allclose(np.roll(pair[1].q, 6, axis=1), pair[0].q, atol=1e-9)
    np.testing.assert_allclose(pair[1].base[:, 1, 3], -pair[0].base[:, 1, 3], atol=1e-9)


def test_softer_means_more_error_and_less_torque(exo):
    gait, runs = normative_gait("slow"), {}
    for name in ("pd_only", "impedance"):
        runs[name] = simulate(exo, gait, name, patient="healthy", body_weight_support=0.4, cycles=3).numbers
    assert runs["impedance"].tracking_rms_deg > runs["pd_only"].tracking_rms_deg
    assert runs["impedance"].motor_share < runs["pd_only"].motor_share


def test_the_weak_leg_gets_more_help(exo):
    run = simulate(exo, normative_gait("slow"), patient="paretic_right", body_weight_support=0.4, cycles=3)
    motor, person = (np.abs(tau).sum(axis=0).reshape(2, 6).sum(axis=1) for tau in (run.motor, run.person))
    left, right = motor / person
    assert right > 1.5 * left


@pytest.mark.parametrize("device", ["lokomat", "lopes8"])
def test_a_device_walks_on_its_own_stand(device):
    run = simulate(
        load_robot(device=device), normative_gait("slow"), cycles=2, support="stand", body_weight_support=0.3
    )
    assert run.verdict.word == "walks", run.verdict.why
    assert not run.motor[:, [k for k, name in enumerate(JOINTS) if name not in run.robot.joints]].any()


def test_a_device_without_a_stand_says_so():
    with pytest.raises(DescriptionError, match="no stand"):
        simulate(load_robot(device="h2"), normative_gait(), support="stand")


def test_motors_end_at_their_limits_unless_these_are_taken_off(exo):
    gait = normative_gait("very_fast")
    tight = simulate(exo, gait, cycles=1)
    loose = simulate(exo, gait, cycles=1, plant=Plant(limits=False))
    k = JOINTS.index("left_hip_flexion")
    assert np.abs(tight.motor[:, k]).max() == pytest.approx(150.0)
    assert np.abs(loose.motor[:, k]).max() > 150.0
    assert "left_hip_flexion" in tight.numbers.saturated
    assert loose.numbers.saturated == {}


def test_the_machine_may_differ_from_the_model(exo):
    run = simulate(exo, normative_gait("slow"), cycles=1, plant=Plant(mass_error=0.1, length_error=0.02))
    exact = simulate(exo, normative_gait("slow"), cycles=1)
    assert run.weight == pytest.approx(1.1 * exact.weight, rel=1e-9)
    assert run.witness < 1e-10
    assert run.numbers.tracking_rms_deg > exact.numbers.tracking_rms_deg


def test_a_delay_and_a_seed_are_repeated_exactly(exo):
    plant = Plant(delay=0.002, noise=1e-4, encoder_step=1e-4, rate=500.0, joint_friction=1.0)
    gait = normative_gait("slow")
    one, two, other = (
        simulate(exo, gait, "impedance_ff", cycles=1, plant=plant, seed=seed) for seed in (3, 3, 4)
    )
    np.testing.assert_array_equal(one.q, two.q)
    assert np.abs(one.q - other.q).max() > 0.0


def test_the_free_pelvis_of_a_clinical_walk_falls(exo):
    run = simulate(exo, normative_gait(), support="none", cycles=5)
    assert run.verdict.word in ("falls", "diverges")


class Wild:
    """A servo of the wrong sign."""

    def __call__(self, time, q, dq, reference):
        return 1e5 * (q - reference.q) + 1e3 * dq


def test_a_run_that_diverges_ends_at_its_last_good_time_and_leaves_no_file(exo, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run = simulate(exo, normative_gait(), Wild(), cycles=2, plant=Plant(limits=False))
    assert run.verdict.word == "diverges"
    assert 0 < len(run.time) < 1000
    assert np.isfinite(run.q).all()
    assert list(tmp_path.iterdir()) == []


def test_a_run_is_a_gait_again(free):
    gait = free.to_gait()
    assert isinstance(gait, Gait)
    assert gait.time[1] - gait.time[0] == pytest.approx(0.01)
    np.testing.assert_allclose(gait.q[0], free.q[0], atol=1e-12)
    np.testing.assert_allclose(gait.base[5], free.base[50], atol=1e-12)


def test_on_the_belt_it_walks_on_the_spot_beside_the_walk_to_follow(free):
    run, plan, motors = walked(free), wanted(free), motor_torques(free)
    np.testing.assert_array_equal(run.time, plan.time)
    np.testing.assert_array_equal(run.time, motors.time)
    assert np.abs(run.base[:, :3, 3] - plan.base[:, :3, 3]).max() < 0.05  # the support gives way by mm
    assert np.ptp(run.base[:, 0, 3]) < 0.1 < np.ptp(free.base[:, 0, 3])
    strikes = [e.time for e in run.events if (e.side, e.kind) == ("left", "heel_strike")]
    np.testing.assert_allclose(np.diff(strikes), free.gait.duration, rtol=1e-9)
    for rate in (0.0, -1.0, float("nan")):
        with pytest.raises(DescriptionError, match="rate"):
            walked(free, rate=rate)


def test_a_recording_from_a_treadmill_walks_on_the_belt_too(exo, recording, free):
    run = simulate(exo, recording)
    assert run.verdict.word == "walks", run.verdict.why
    assert run.reference.belt_speed == pytest.approx(free.reference.belt_speed, rel=0.05)


class Answer:
    """A controller with a fixed answer."""

    def __init__(self, answer):
        self.answer = answer

    def __call__(self, time, q, dq, reference):
        return self.answer() if callable(self.answer) else self.answer


def wrong():
    raise ValueError("no idea")


def leaving():
    raise SystemExit(0)


def forever():
    while True:
        try:
            continue
        except Exception:
            continue


@pytest.mark.parametrize(
    ("answer", "word"),
    [
        (np.full(12, np.nan), "finite"),
        (np.zeros(11), "12 finite"),
        (np.zeros(12) * 1j, "12 finite"),
        (["1"] * 12, "12 finite"),
        (None, "12 finite"),
        (wrong, r"test_simulate.py:\d+: ValueError: no idea"),
        (leaving, "SystemExit"),
        (forever, "does not answer"),
    ],
)
def test_a_controller_whose_answer_cannot_be_used_is_refused(exo, answer, word, monkeypatch):
    monkeypatch.setattr("exo_pin.simulation.loop.LONGEST_ANSWER", 0.3)
    with pytest.raises(DescriptionError, match=word):
        simulate(exo, normative_gait(), Answer(answer), cycles=1)


class Changing:
    """The servo alone, which changes all that it is given and answers with a list."""

    def __call__(self, time, q, dq, reference):
        answer = find_controller("pd_only")[1](time, q, dq, reference).tolist()
        for values in (q, dq, reference.q, reference.dq, reference.ddq, reference.missing):
            values += 1.0
        reference.q = None
        return answer


def test_a_controller_that_changes_what_it_is_given_changes_its_answer_alone(exo):
    gait = normative_gait("slow")
    kept, changed = (
        simulate(exo, gait, name, patient="healthy", cycles=1) for name in ("pd_only", Changing())
    )
    np.testing.assert_array_equal(kept.q, changed.q)
    np.testing.assert_array_equal(kept.reference.q, changed.reference.q)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"timestep": 0.0}, "timestep"),
        ({"timestep": 1.0}, "timestep"),
        ({"timestep": float("nan")}, "timestep"),
        ({"cycles": 0}, "cycles"),
        ({"cycles": 1_000_000}, "fewer cycles"),
        ({"body_weight_support": 1.0}, "support"),
        ({"body_weight_support": float("nan")}, "support"),
        ({"support": "sofft"}, "soft"),
        ({"controller": "pdd"}, "pd"),
        ({"patient": "helthy"}, "healthy"),
    ],
)
def test_numbers_and_names_out_of_range_are_refused(exo, changes, word):
    with pytest.raises(ExoPinError, match=word):
        simulate(exo, normative_gait(), **changes)


@pytest.mark.parametrize("field", [f.name for f in dataclasses.fields(Plant) if f.name != "limits"])
def test_every_number_of_the_machine_has_a_range(field):
    for value in (-1.0, 1e9, float("nan")):
        with pytest.raises(DescriptionError, match=field):
            Plant(**{field: value})


def test_a_support_has_six_numbers():
    with pytest.raises(DescriptionError, match="shape"):
        PelvisSupport("odd", (1.0,), (1.0,) * 6)
    with pytest.raises(UnknownNameError):
        simulate(load_robot(), normative_gait(), support="chair")

"""`exo-pin torques`: what it prints and writes, for people and programs, and which inputs it refuses."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.cli import main
from exo_pin.formats import load_torques

RELATIVE = 1e-9  # the same doubles, summed up in another order


def run(capsys, *words):
    code = main(["torques", *map(str, words)])
    out, err = capsys.readouterr()
    return code, out, err


def facts(capsys, *words):
    code, out, err = run(capsys, *words, "--json")
    assert code == 0, err
    return json.loads(out)


@pytest.fixture(scope="module")
def subject01(shared):
    """Words of a recorded walk with its plates."""
    folder = shared / "opensim_subject01_walk"
    model, forces = folder / "subject01_simbody.osim", folder / "subject01_walk1_grf.mot"
    return [folder / "subject01_walk1_ik.mot", "--model", model, "--forces", forces]


def test_numbers_are_those_of_the_curves(capsys):
    found = facts(capsys, "--curves", "--patient", "paretic_right")
    assert set(found["joints"]) == set(JOINTS)
    time = np.array(found["time"])
    assert all(found["valid"])
    for name, joint in found["joints"].items():
        tau, power = (np.array(found[key][name]) for key in ("torque_Nm", "power_W"))
        motor, person = (np.array(found[key][name]) for key in ("motor_Nm", "person_Nm"))
        assert joint["peak_Nm"] == pytest.approx(np.abs(tau).max(), rel=RELATIVE)
        assert joint["rms_Nm"] == pytest.approx(math.sqrt((tau**2).mean()), rel=RELATIVE)
        assert joint["peak_W"] == pytest.approx(np.abs(power).max(), rel=RELATIVE)
        assert joint["peak_Nm_per_kg"] == pytest.approx(joint["peak_Nm"] / 70, rel=RELATIVE)
        np.testing.assert_allclose(motor + person, tau, atol=1e-9)
        both = np.abs(motor).sum() + np.abs(person).sum()
        assert joint["motor_share"] == pytest.approx(np.abs(motor).sum() / both, rel=RELATIVE)
        mean = power.mean() * len(time) * (time[1] - time[0])  # exact for a periodic curve
        assert joint["work_J_per_stride"] == pytest.approx(mean, abs=0.1)  # linear between 100 samples
        parts = joint["positive_work_J_per_stride"] + joint["negative_work_J_per_stride"]
        assert joint["work_J_per_stride"] == pytest.approx(parts, abs=1e-9)
    weak, sound = (found["joints"][f"{side}_hip_adduction"]["motor_share"] for side in ("right", "left"))
    assert (weak, sound) == (pytest.approx(0.5), pytest.approx(0.0))  # no tissue's moment there


def test_the_motors_share_is_assist_where_no_tissue_helps_and_all_without_a_person(capsys):
    half = facts(capsys, "--assist", "0.3")
    assert all(j["motor_share"] == pytest.approx(0.3) for j in half["joints"].values())
    assert all(j["motor_share"] == 1.0 for j in facts(capsys)["joints"].values())


def test_body_weight_support_takes_load_from_the_legs(capsys):
    full, half = facts(capsys), facts(capsys, "--bws", "0.5")
    assert half["body_weight_support_N"] == pytest.approx(half["mass_kg"] * 9.81 / 2, rel=1e-3)
    for name in ("left_ankle_dorsiflexion", "right_ankle_dorsiflexion"):
        assert half["joints"][name]["peak_Nm"] < 0.8 * full["joints"][name]["peak_Nm"]


def test_predicted_is_said_beside_every_joint_and_the_support(capsys):
    code, out, _ = run(capsys)
    assert code == 0
    lines = [
        line for line in out.splitlines() if line.strip().startswith(JOINTS) or "the support gives" in line
    ]
    assert len(lines) == len(JOINTS) + 2
    assert all("predicted" in line for line in lines)
    assert facts(capsys)["ground_reaction"] == "predicted"


def test_a_device_s_locked_joints_are_left_out_and_the_copy_is_said(capsys):
    code, out, err = run(capsys, "--device", "lokomat", "--json")
    found = json.loads(out)
    assert code == 0
    assert {name.partition("_")[2] for name in found["joints"]} == {"hip_flexion", "knee_flexion"}
    assert "copy the walk" in err


@pytest.mark.parametrize("suffix", ["csv", "sto", "mot"])
def test_a_recorded_walk_s_torques_load_again(capsys, subject01, tmp_path, suffix):
    path = tmp_path / f"torques.{suffix}"
    found = facts(capsys, *subject01, "--curves", "-o", path)
    assert found["ground_reaction"] == "measured"
    assert found["masses"] == "wearer"
    loaded = load_torques(path)
    for name in JOINTS:
        np.testing.assert_allclose(loaded.tau[:, JOINTS.index(name)], found["torque_Nm"][name], atol=1e-12)
    assert loaded.source == found["source"]


def test_a_trial_uses_its_own_plates_and_frames_beside_them_are_null_and_counted(capsys, shared, tmp_path):
    trial = shared / "c3d_pig_walk_HC036A" / "HC036A10_walk.c3d"
    path = tmp_path / "torques.csv"
    code, out, err = run(capsys, trial, "--json", "--curves", "-o", path)
    found = json.loads(out)
    assert code == 0
    missing = found["frames"] - found["valid_frames"]
    assert 0 < missing < found["frames"]
    assert f"{missing} of {found['frames']} frames are not valid" in err
    for valid, tau in zip(found["valid"], found["torque_Nm"]["left_knee_flexion"], strict=True):
        assert valid == (tau is not None)
    known = np.isfinite(load_torques(path).tau[:, 0])
    np.testing.assert_array_equal(known, found["valid"])


def test_plates_that_are_not_wanted_are_not_used(capsys, shared):
    found = facts(capsys, shared / "c3d_pig_walk_HC036A" / "HC036A10_walk.c3d", "--forces", "none")
    assert found["ground_reaction"] == "predicted"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--bws", "1.2"], "0 to 1"),
        (["--assist", "-0.1"], "0 to 1"),
        (["--assist", "nan"], "--assist"),
        (["--patient", "paretik"], "did you mean 'paretic_right'"),
        (["--curves"], "--json"),
        (["-o", "torques.xlsx"], ".csv, .sto, .mot"),
        (["-o", "torques.csv", "--as", "opensim-gait2392"], ".sto or .mot"),
        (["--no-wearer", "--masses", "wearer"], "wearer"),
        (["--forces", "no_such.mot"], "no_such.mot"),
    ],
)
def test_bad_input_is_one_line(capsys, words, said):
    code, out, err = run(capsys, *words)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert said in err


def test_a_patient_more_active_than_able_is_refused(capsys, tmp_path):
    path = tmp_path / "p.toml"
    path.write_text("[activity]\nright = 3\n")
    code, _, err = run(capsys, "--patient", path)
    assert code == 2
    assert "activity of right_hip_flexion is 3" in err


def changed_forces(source, path, change):
    """A force file with its numbers changed, `change(name, value)`."""
    lines = source.read_text().splitlines()
    end = next(k for k, line in enumerate(lines) if line.strip() == "endheader")
    names = lines[end + 1].split()
    rows = [
        "\t".join(repr(change(name, float(x))) for name, x in zip(names, line.split(), strict=True))
        for line in lines[end + 2 :]
        if line.strip()
    ]
    path.write_text("\n".join([*lines[: end + 2], *rows, ""]))
    return path


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda name, x: x + 100 * (name == "time"), "same clock"),
        (lambda name, x: x + 0.15 * (name == "time"), "ms earlier"),
        (lambda name, x: x * (1000 if "torque" in name else 1), "N mm"),
        (lambda name, x: x * (-1 if "_v" in name else 1), "sign"),
        (lambda name, x: x / (1000 if "_v" in name else 1), "kN"),
    ],
)
def test_forces_of_another_clock_unit_or_sign_are_refused(capsys, subject01, tmp_path, change, said):
    forces = changed_forces(subject01[-1], tmp_path / "grf.mot", change)
    code, _, err = run(capsys, *subject01[:-1], forces)
    assert code == 2
    assert said in err.splitlines()[-1]
    assert "grf.mot" in err.splitlines()[-1]


def test_the_walk_s_own_torques_decide_what_a_device_can_do(capsys):
    words = ["feasible", "fast", "--stature", "1.9", "--mass", "110"]
    assert main([*words]) == 0
    capsys.readouterr()
    assert main([*words, "--torques", "own", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert "too much torque" in found["reason"]
    assert "predicted" in found["torques"]
    own = facts(capsys, *words[1:])["joints"]["left_hip_flexion"]["peak_Nm"]
    assert f"{own:.1f} of 150 N m" in found["reason"]


def test_the_report_shows_the_walk_s_own_torques_and_says_predicted(tmp_path):
    page = tmp_path / "walk.html"
    assert main(["report", "--torques", "own", "--no-player", "-o", str(page)]) == 0
    text = page.read_text()
    assert "Source: inverse dynamics of Schwartz 2008" in text
    assert "ground reaction predicted" in text


def test_own_torques_of_a_trial_are_those_of_its_plates(capsys, subject01):
    code = main(["feasible", *map(str, subject01), "--torques", "own", "--json"])
    found = json.loads(capsys.readouterr().out)
    assert code in (0, 1)
    assert "measured by 2 force plates" in found["torques"]

"""The command line: what people type, what they get, and what happens to bad input."""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import time
import tomllib
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest

from exo_pin.cli import COMMANDS, main, show
from exo_pin.formats import load_gait, load_poses, save_gait
from exo_pin.gait import normative_gait

ROOT = Path(__file__).resolve().parents[2]


def run(capsys, *words):
    code = main(list(map(str, words)))
    out, err = capsys.readouterr()
    return code, out, err


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_s_help_shows_an_example(capsys, command):
    with pytest.raises(SystemExit) as stop:
        main([command, "--help"])
    assert stop.value.code == 0
    assert f"exo-pin {command}" in capsys.readouterr().out.split("examples:")[1]


def test_without_a_word_the_help_is_shown(capsys):
    code, out, _ = run(capsys)
    assert code == 0
    assert all(command in out for command in COMMANDS)


@pytest.mark.parametrize(
    "words",
    [
        ["replay", "no_such_file.mot"],
        ["no_such_file.mot"],
        ["info", "fre"],
        ["chekc"],
        ["check", "free", "--preset", "vicon-pig"],
        ["fk", "free", "-o", "poses.mot"],
        ["body", "--set", "limits=3"],
        ["urdf", "limits:=3"],
        ["urdf", "left_knee_flexion_lower:=2", "left_knee_flexion_upper:=1"],
        ["check", "--stature", "17.5"],
        ["check", "--mass", "0"],
        ["check", "--set", "tigh=0.4"],
        ["check", "--set", "thigh"],
        ["check", "--body", "none.toml"],
        ["urdf", "left_thigh:=-1"],
        ["urdf", "device:=exo13"],
        ["urdf", "foo:=1"],
        ["urdf", "-o", "no/such/folder/exo.urdf"],
        ["convert", "free", "walk.xyz"],
        ["ik", "none.csv", "-o", "angles.csv"],
        ["replay", "--html", "no/such/folder/walk.html"],
        ["replay", "--speed", "0", "--html", "w.html"],
    ],
    ids=" ".join,
)
def test_bad_input_is_one_line_and_exit_code_2(capsys, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    code, _, err = run(capsys, *words)
    assert code == 2
    assert len(err.splitlines()) == 1
    assert err.startswith("exo-pin: ")
    assert list(tmp_path.iterdir()) == []


def test_check_as_json_has_the_promised_keys(capsys):
    code, out, _ = run(capsys, "check", "slow", "--json")
    facts = json.loads(out)
    assert code == 0
    assert facts["ok"] is True
    assert set(facts["fk_max_difference"]) == {"recursion", "dh", "yourdfpy"}
    wanted = {"frames", "converged", "max_position_error_m", "max_rotation_error_rad", "max_angle_error_deg"}
    assert wanted <= set(facts["ik"])
    assert facts["limits"]["left_knee_flexion"].keys() == {"min", "max", "violated_frames"}


def test_check_says_no_with_exit_code_1(capsys, tmp_path):
    body = tmp_path / "stiff.toml"
    body.write_text("[limits_deg]\nleft_knee_flexion = [0, 20]\n")
    code, out, _ = run(capsys, "check", "--body", body)
    assert code == 1
    assert "left_knee_flexion" in out.split("verdict")[1]


def test_fk_then_ik_then_fk_is_the_same(capsys, tmp_path):
    poses, angles, again = (tmp_path / name for name in ("poses.csv", "angles.csv", "again.csv"))
    assert run(capsys, "fk", "fast", "-o", poses)[0] == 0
    assert run(capsys, "ik", poses, "-o", angles)[0] == 0
    assert run(capsys, "fk", angles, "-o", again)[0] == 0
    first, second = load_poses(poses), load_poses(again)
    for foot, T in first.targets.items():
        assert np.abs(second.targets[foot] - T).max() <= 1e-9  # the tolerance of inverse kinematics
    assert np.abs(second.base - first.base).max() <= 1e-12


def test_ik_reports_what_it_cannot_reach_and_exits_with_1(capsys, tmp_path):
    poses, angles = tmp_path / "poses.csv", tmp_path / "angles.csv"
    run(capsys, "fk", "free", "--stature", "1.95", "-o", poses)
    code, out, _ = run(capsys, "ik", poses, "-o", angles, "--stature", "1.5")
    assert code == 1
    assert "out of reach" in out
    assert np.isfinite(load_gait(angles).q).all()


@pytest.mark.parametrize("ending", [".csv", ".mot", ".sto"])
def test_convert_keeps_the_walk(capsys, tmp_path, ending):
    path = tmp_path / f"walk{ending}"
    assert run(capsys, "convert", "free", path)[0] == 0
    from exo_pin.gait import normative_gait

    assert load_gait(path).q == pytest.approx(normative_gait("free").q, abs=1e-9)


def test_body_file_and_its_use(capsys, tmp_path):
    path = tmp_path / "patient.toml"
    assert run(capsys, "body", "--stature", 1.82, "--set", "left_thigh=0.41", "-o", path)[0] == 0
    assert tomllib.loads(path.read_text())["left_thigh"] == 0.41
    code, out, _ = run(capsys, "urdf", "--body", path)
    assert code == 0
    assert 'xyz="0 0 -0.41"' in out
    assert run(capsys, "body", "--body", path, "--stature", 1.7)[0] == 2


@pytest.mark.parametrize("style", ["markdown", "csv", "latex", "matlab"])
def test_dh_prints_twelve_rows_and_the_difference(capsys, style):
    code, out, _ = run(capsys, "dh", "--format", style, "--set", "left_thigh=0.4")
    assert code == 0
    assert "difference to Pinocchio" in out
    assert "0.4" in out
    rows = [line for line in out.splitlines() if "left" in line.replace("\\", "") and "flexion" in line]
    assert len(rows) == 3  # hip, knee, ankle dorsiflexion


def test_an_inferred_sign_is_told(capsys, tmp_path):
    path = tmp_path / "walk.mot"
    run(capsys, "convert", "free", path)
    head, table = path.read_text().split("endheader")
    kept = ("Coordinates", "version", "nRows", "nColumns", "inDegrees")  # as OpenSim itself writes
    plain = "\n".join(line for line in head.splitlines() if line.startswith(kept))
    path.write_text(f"{plain}\nendheader{table}")
    _, out, err = run(capsys, "check", path, "--json")
    assert "knee" in err
    assert "inferred" in err
    json.loads(out)


def test_info_lists_ranges_and_events(capsys):
    code, out, _ = run(capsys, "info", "free", "--json")
    facts = json.loads(out)
    assert code == 0
    assert facts["samples"] == 100
    assert len(facts["events"]) == 4
    assert facts["joints"]["left_knee_flexion"]["max_deg"] == pytest.approx(59, abs=1)


def test_replay_writes_one_offline_page(capsys, tmp_path):
    page = tmp_path / "walk.html"
    code, out, _ = run(capsys, "replay", "--html", page)
    assert code == 0
    assert "feet reached" in out
    assert page.stat().st_size > 100_000
    assert [p.name for p in tmp_path.iterdir()] == ["walk.html"]


def test_replay_reports_violated_limits_and_still_plays(capsys, tmp_path):
    body = tmp_path / "stiff.toml"
    body.write_text("[limits_deg]\nleft_knee_flexion = [0, 20]\n")
    code, out, _ = run(capsys, "replay", "--body", body, "--html", tmp_path / "w.html")
    assert code == 0
    assert "left_knee_flexion" in out


@pytest.mark.parametrize("stop", [signal.SIGINT, signal.SIGTERM])
def test_replay_serves_until_it_is_stopped_and_leaves_nothing(stop):
    command = [sys.executable, "-m", "exo_pin", "replay", "--no-open", "--port", "0"]
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as process:
        lines = []
        try:
            while not any("--html" in line for line in lines):
                lines.append(process.stdout.readline())
                assert lines[-1], "ended before it served"
            url = next(word for line in lines for word in line.split() if word.startswith("http://"))
            assert "exo_pin" in urllib.request.urlopen(url, timeout=10).read().decode()
        finally:
            process.send_signal(stop)
        assert process.wait(10) == 0
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(url, timeout=2)


def test_the_reader_of_a_pipe_may_leave_early():
    command = f"{sys.executable} -m exo_pin urdf | head -1"
    ended = subprocess.run(command, shell=True, capture_output=True, text=True, cwd=ROOT, check=True)
    assert ended.stdout.startswith("<?xml")
    assert ended.stderr == ""


@pytest.mark.parametrize("words", [["devices"], ["devices", "--json"], ["--help"]], ids=" ".join)
def test_a_closed_pipe_ends_a_command_with_code_0_and_without_a_traceback(words):
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "exo_pin", *words]
    ended = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, cwd=ROOT)
    os.close(writer)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_a_missing_argument_explains_itself(capsys):
    with pytest.raises(SystemExit) as stop:
        main(["fk", "free"])
    assert stop.value.code == 2
    assert "--output" in capsys.readouterr().err


def test_help_is_quick():
    start = time.perf_counter()
    subprocess.run([sys.executable, "-m", "exo_pin", "--help"], capture_output=True, check=True)
    assert time.perf_counter() - start < 5  # an upper bound for slow machines; 0.1 s is usual


@pytest.mark.parametrize("width", ["20", "50", "300"])
def test_no_window_is_so_narrow_that_a_number_or_a_word_is_cut(capsys, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", width)
    rows = [["left_hip_flexion", "-277.25 .. 31.5", "hip_flexion, knee_flexion", "ok"], ["x", "-1", "", "NO"]]
    show.table("title", ["joint", "asked deg", "driven", ""], rows)
    shown = capsys.readouterr().out
    assert all(word in shown for row in rows for cell in row for word in cell.split(", "))
    assert "-277.25 .. 31.5" in shown
    assert "…" not in shown


def test_remarks_on_a_file_are_printed_once_as_notes_and_stand_in_the_json(capsys, tmp_path, monkeypatch):
    file = tmp_path / "walk.csv"
    save_gait(normative_gait("free"), file)
    walk = dataclasses.replace(load_gait(file), remarks=("the hip\x1b[31m was held",))
    monkeypatch.setattr("exo_pin.formats.load_gait", lambda *_, **__: walk)
    code, out, err = run(capsys, "info", file, "--json")
    assert code == 0
    assert err.count("note: the hip [31m was held") == 1
    assert json.loads(out)["remarks"] == list(walk.remarks)

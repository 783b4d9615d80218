"""`exo-pin plan`: what it prints and writes, and what it refuses in one line."""

import json

import pytest

from exo_pin.cli import main
from exo_pin.formats import load_gait


def test_a_walk_is_written_for_every_other_command(tmp_path, capsys):
    path = tmp_path / "walk.csv"
    assert main(["plan", "--steps", "2", "--length", "0.2", "-o", str(path), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["missed_frames"] == 0
    assert facts["zmp_rms_mm"]["forward"] < 3.0
    assert facts["polygon_margin_min_mm"] > 20.0
    assert facts["limits"]["left_knee_flexion"]["violated_frames"] == 0
    gait = load_gait(path)
    assert len(gait) == facts["frames"]
    assert gait.base is not None
    assert gait.base[-1, 0, 3] - gait.base[0, 0, 3] == pytest.approx(0.4, abs=1e-3)
    assert main(["feasible", str(path), "--json"]) == 0


def test_a_simulated_plan_stands_and_its_numbers_are_those_of_a_simulation(tmp_path, capsys):
    page = tmp_path / "walk.html"
    words = ["plan", "--steps", "2", "--length", "0.2", "--simulate", "--push", "30,0,0.1@1", "--json"]
    assert main([*words, "--html", str(page)]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["stands"]
    assert facts["support"] == "none"
    assert facts["pelvis_off_path_max_mm"] < 40.0
    assert facts["zmp_margin_min_mm"] == pytest.approx(facts["polygon_margin_min_mm"], abs=2.0)  # low-pass
    assert "simulated" in page.read_text("utf-8")


def test_motors_that_are_too_weak_make_the_verdict_no_and_the_walk_is_written(tmp_path, capsys):
    path = tmp_path / "walk.csv"
    assert main(["plan", "--steps", "2", "--step-time", "0.45", "-o", str(path)]) == 1
    assert "not good: left_hip" in capsys.readouterr().out
    assert path.exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--steps", "0"], "number of steps is 0"),
        (["--steps", "100000"], "number of steps is 100000"),
        (["--length", "0.6"], "fit"),
        (["--push", "60,0,0.1@1"], "add --simulate"),
        (["--simulate", "--push", "60"], "60,0,0.1@3.2"),
        (["--simulate", "--controller", "pid"], "controller"),
        (["--width", "5cm"], "too close"),
        (["--double-support", "1"], "double support is 1"),
        (["--step-time", "nan"], "step time is nan"),
        (["--turn", "60"], "turn of a step [deg] is 60"),
        (["--device", "lokomat"], "six driven joints"),
        (["--strides", "free"], "stays on the spot"),
        (["--strides", "free", "--length", "0.2"], "--length is for even steps"),
        (["-o", "walk.doc"], "unknown kind of file"),
    ],
)
def test_what_cannot_be_planned_is_one_line_and_exit_code_2(words, said, capsys):
    assert main(["plan", *words]) == 2
    out, err = capsys.readouterr()
    assert said in err
    assert err.count("\n") == 1
    assert out == ""

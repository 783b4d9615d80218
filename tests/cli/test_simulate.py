"""`exo-pin simulate`: the verdict as exit code and JSON, the files it writes, and what it refuses."""

import json
from pathlib import Path

import numpy as np
import pytest

from exo_pin.cli import main
from exo_pin.control import CONTROLLERS, PATIENTS
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import Gait

KEYS = {
    *("verdict", "why", "time_end_s", "tracking_rms_deg", "tracking_max_deg", "swing_contact_percent"),
    *("vertical_force_mean_bw", "peak_torque_Nm", "saturated", "motor_rms_Nm", "motor_share"),
    *("energy_balance_percent", "witness", "real_time_factor", "by_side"),
}


def run(capsys, *words):
    code = main(["simulate", *map(str, words)])
    out, err = capsys.readouterr()
    return code, out, err


def test_a_walk_that_holds_ends_with_zero_and_its_numbers_are_json(capsys, tmp_path):
    file, page = tmp_path / "run.csv", tmp_path / "run.html"
    words = ("slow", "--cycles", 1, "--bws", "0.3", "--json", "-o", file, "--html", page)
    code, out, err = run(capsys, *words)
    facts = json.loads(out)
    assert (code, facts["verdict"], err) == (0, "walks", "")
    assert set(facts) >= KEYS
    assert facts["witness"] < 1e-10
    assert facts["energy_balance_percent"] < 0.2
    walk = load_gait(file)
    assert walk.duration == pytest.approx(facts["time_end_s"], abs=0.011)
    assert np.ptp(walk.base[:, 0, 3]) < 0.1  # on the spot over the belt
    assert [event.kind for event in walk.events].count("heel_strike") >= 2
    assert "slow on exo12, simulated: walks" in page.read_text("utf-8")


def test_motors_off_end_with_one_and_the_reason_first(capsys, tmp_path):
    code, out, _ = run(capsys, "slow", "--cycles", 1, "--controller", "off", "-o", tmp_path / "run.mot")
    assert code == 1
    assert out.splitlines()[0].startswith("falls: in cycle 1 the legs carry")
    assert "body-weight support" in out.splitlines()[1]


def test_a_diverging_run_ends_at_its_last_good_time(capsys, tmp_path):
    wild = tmp_path / "wild.py"
    wild.write_text("def wild(t, q, dq, ref):\n    return 1e5 * (-1) ** round(1000 * t) + 0 * q\n")
    code, out, _ = run(capsys, "slow", "--controller", f"{wild}:wild", "--no-limits", "--json")
    facts = json.loads(out)
    assert (code, facts["verdict"]) == (1, "diverges")
    assert 0.0 <= facts["time_end_s"] < 0.1
    assert "NaN" not in out


def test_the_table_holds_every_pair_of_those_named(capsys):
    words = ("slow", "--cycles", 1, "--controller", "pd,off", "--patient", "none,healthy", "--table")
    code, out, _ = run(capsys, *words)
    assert code == 0
    pairs = [line.split()[:2] for line in out.splitlines() if line.split()[:1] in (["pd"], ["off"])]
    assert pairs == [["pd", "none"], ["pd", "healthy"], ["off", "none"], ["off", "healthy"]]


def test_help_names_every_controller_and_patient(capsys):
    with pytest.raises(SystemExit):
        main(["simulate", "--help"])
    words = capsys.readouterr().out.replace(",", " ").split()
    assert set(words) >= {*CONTROLLERS, *PATIENTS}
    assert "all your rights" in " ".join(words)


RAISES = "def bad(t, q, dq, ref):\n    raise ValueError('no idea')\n"
SHORT = "def bad(t, q, dq, ref):\n    return q[:3]\n"
NOT_A_NUMBER = "def bad(t, q, dq, ref):\n    return q * float('nan')\n"
BROKEN = "def bad(t, q, dq, ref)\n"


@pytest.mark.parametrize(
    ("text", "word"),
    [
        (RAISES, "bad.py:2: ValueError: no idea"),
        (SHORT, "12 finite"),
        (NOT_A_NUMBER, "12 finite"),
        (BROKEN, "SyntaxError"),
    ],
)
def test_a_controller_that_fails_is_one_line(capsys, tmp_path, text, word):
    path = tmp_path / "bad.py"
    path.write_text(text)
    code, out, err = run(capsys, "slow", "--controller", f"{path}:bad", "--json")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert word in err


@pytest.mark.parametrize(
    "words",
    [
        ("--controller", "pdd"),
        ("--controller", ","),
        ("--controller", "none.py:Class"),
        ("--patient", "helthy"),
        ("--patient", "none.toml"),
        ("--timestep", "0"),
        ("--timestep", "1"),
        ("--cycles", "0"),
        ("--cycles", "1000000"),
        ("--bws", "1"),
        ("--delay", "9"),
        ("--mass-error", "nan"),
        ("--seed", "-1"),
        ("--device", "h2", "--support", "stand"),
        ("--controller", "all", "-o", "run.csv"),
        ("--controller", "all", "--html", "run.html"),
        ("--html", "no/such/folder/run.html", "--cycles", "1"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(capsys, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    code, _, err = run(capsys, "free", "--table", *words)
    assert (code, err.count("\n")) == (2, 1), err
    assert list(Path().iterdir()) == []


def test_a_walk_without_stance_is_refused(capsys, tmp_path):
    still = tmp_path / "still.csv"
    save_gait(Gait(np.arange(200) / 100, np.zeros((200, 12))), still)
    code, _, err = run(capsys, still, "--json")
    assert code == 2
    assert "has no stance" in err.splitlines()[-1]

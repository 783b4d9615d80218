"""docs/simulate.md is held to what it says: its names, its keys, its example files, its table."""

import re
from pathlib import Path

import pytest

from exo_pin.cli import main
from exo_pin.control import CONTROLLERS, PATIENTS
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.simulation import simulate

PAGE = (Path(__file__).parents[2] / "docs" / "simulate.md").read_text("utf-8")
TABLE = [
    [cell.strip(" `") for cell in line.strip("|").split("|")]
    for line in PAGE.partition("<!-- table -->\n")[2].partition("<!-- end -->")[0].splitlines()[2:]
]


def example(name, language):
    (text,) = re.findall(rf"<!-- {name} -->\n```{language}\n(.*?)```", PAGE, re.DOTALL)
    return text


def test_every_controller_and_patient_has_its_row():
    assert [row[:2] for row in TABLE] == [[c, p] for c in CONTROLLERS for p in PATIENTS]
    for name in (*CONTROLLERS, *PATIENTS):
        assert f"\n| `{name}` |" in PAGE


def test_the_sentences_under_the_table_hold_in_it():
    rows = {(c, p): (verdict, [float(x) for x in rms.split("/")]) for c, p, verdict, rms, *_ in TABLE}
    assert rows["pd", "plegic"][0] == "walks"
    assert rows["impedance", "plegic"][0] == "falls"
    assert [rows["computed_torque", p][0] == "walks" for p in PATIENTS] == [True, True, False]
    assert 2.2 < sum(rows["computed_torque", "healthy"][1]) / 2 < 2.8
    assert rows["assist_as_needed", "plegic"][0] == "walks"
    assert rows["assist_as_needed", "plegic"][1][0] > rows["pd", "plegic"][1][0]


@pytest.mark.parametrize(("controller", "patient"), [("pd", "plegic"), ("impedance", "healthy")])
def test_the_table_s_numbers_come_out_again(controller, patient):
    """Of two cycles the second is like the second to tenth, within the spread of cycles."""
    run = simulate(
        load_robot(), normative_gait("slow"), controller, patient=patient, body_weight_support=0.4, cycles=2
    )
    (row,) = (row for row in TABLE if row[:2] == [controller, patient])
    rms, motors, share = ([float(x) for x in cell.split("/")] for cell in row[3:6])
    left = run.by_side["left"]
    assert left.tracking_rms_deg == pytest.approx(rms[0], rel=0.1)
    assert left.motor_rms == pytest.approx(motors[0], rel=0.1)
    assert left.motor_share == pytest.approx(share[0], abs=0.05)


def test_every_number_of_the_json_is_explained():
    run = simulate(load_robot(), normative_gait(), cycles=1)
    plain = {"why", "time_end_s", "controller", "patient", "support", "feet"}
    for key in set(run.facts()) - plain:
        assert f"`{key}`" in PAGE, key


def test_the_python_lines_run_as_they_stand(capsys):
    exec(example_of_use(), {})
    assert capsys.readouterr().out == "walks 0.9\n"


def example_of_use():
    return re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)[0]


def test_the_example_controller_and_the_example_patient_walk(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("damped.py").write_text(example("controller", "python"), "utf-8")
    Path("weak_right.toml").write_text(example("patient", "toml"), "utf-8")
    words = "slow --cycles 1 --bws 0.4 --controller damped.py:Damped --patient weak_right.toml -o run.npz"
    assert main(["simulate", *words.split()]) == 0
    out = capsys.readouterr().out
    assert out.startswith("walks: ")
    assert "weak right leg" in out
    assert Path("run.npz").exists()

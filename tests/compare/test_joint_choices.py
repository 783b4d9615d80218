"""The joint study: all 64 choices, consistent with each other and with the devices of those joints."""

import json
import xml.etree.ElementTree as ET
from itertools import combinations

import pytest

from exo_pin.anatomy import MOVEMENTS
from exo_pin.cli import main
from exo_pin.compare import compare, compare_joints
from exo_pin.devices import subset
from exo_pin.gait import normative_gait
from exo_pin.report.draw.pareto import pareto_svg

GAIT = normative_gait().resampled(4)
SEARCHED = 1e-9  # metres: ten times what the solver is asked for


@pytest.fixture(scope="module")
def study():
    return compare_joints(GAIT)


def test_every_choice_is_there_once(study):
    assert set(study.losses) == {frozenset(c) for k in range(7) for c in combinations(MOVEMENTS, k)}


def test_all_joints_lose_nothing_and_a_further_joint_never_costs(study):
    assert study.losses[frozenset(MOVEMENTS)] < 1e-9
    for chosen, loss in study.losses.items():
        for movement in set(MOVEMENTS) - chosen:
            assert study.losses[chosen | {movement}] <= loss + SEARCHED


@pytest.mark.parametrize("movements", [("hip_flexion", "knee_flexion"), MOVEMENTS[:2] + MOVEMENTS[3:5]])
def test_a_choice_loses_what_the_device_of_these_joints_loses(study, movements):
    device = compare(GAIT, [subset(movements)]).best[0]
    assert study.losses[frozenset(movements)] == pytest.approx(device.rms, abs=SEARCHED)


def test_the_front_falls_and_names_the_best_of_each_count(study):
    front = study.pareto
    assert [motors for motors, _, _ in front] == list(range(0, 13, 2))
    losses = [loss for _, _, loss in front]
    assert losses == sorted(losses, reverse=True)
    for motors, _, loss in front:
        assert loss == min(value for c, value in study.losses.items() if 2 * len(c) == motors)


def test_hip_flexion_is_worth_most_and_inversion_least(study):
    assert next(iter(study.leave_one_out)) == "hip_flexion"
    assert study.add_one_in[0][0] == "hip_flexion"
    assert study.add_one_in[-1][1] < 1e-9


def test_the_figure_is_svg_with_every_choice_and_the_front(study):
    root = ET.fromstring(pareto_svg(study))
    circles = [e for e in root.iter() if e.tag.endswith("circle")]
    assert len(circles) == 64 + 7
    for circle in circles:
        assert 0 < float(circle.get("cx")) < 760
        assert 0 < float(circle.get("cy")) < 430


def test_the_command_prints_json_and_writes_the_figure(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("exo_pin.compare.joint_choices._SAMPLES", 3)
    assert main(["joints", "--json", "-o", str(tmp_path / "p.svg")]) == 0
    assert len(json.loads(capsys.readouterr().out)["all"]) == 64
    assert (tmp_path / "p.svg").read_text().startswith("<svg")
    assert main(["joints", "-o", str(tmp_path / "p.png")]) == 2

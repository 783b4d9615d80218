"""Robustness studies: seeds of simulated conditions, the share that walks, resumed and in parallel."""

import json
import math

import pytest

from exo_pin.cli import main
from exo_pin.errors import DescriptionError, ExoPinError
from exo_pin.study import run_simulations, simulations, walking_shares
from exo_pin.study.walking_shares import wilson_interval


def plan(runs=2, **changes):
    options = {"controllers": ("pd", "off"), "cycles": 1, "timestep": 0.002} | changes
    return simulations(("slow",), runs=runs, **options)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    path = tmp_path_factory.mktemp("robustness") / "runs.csv"
    return run_simulations(plan(), path), path


def test_every_seed_of_every_condition_has_a_row_and_a_machine_of_its_own(done):
    rows = done[0].rows
    assert [(row.controller, row.seed) for row in rows] == [("pd", 0), ("pd", 1), ("off", 0), ("off", 1)]
    assert rows[0].run_mass_error != rows[1].run_mass_error
    assert rows[0].run_mass_error == rows[2].run_mass_error  # of the same seed
    assert {row.verdict for row in rows[:2]} == {"walks"}
    assert "walks" not in {row.verdict for row in rows[2:]}
    assert [share.share for share in walking_shares(rows)] == [1.0, 0.0]


def test_without_spread_all_runs_are_alike():
    one, two = run_simulations(plan(controllers=("pd",), spread=0.0)).rows
    assert (one.run_mass_error, one.run_floor_friction) == (0.0, 0.8)
    assert one.tracking_rms_deg == two.tracking_rms_deg


def test_two_workers_that_continue_a_study_end_with_the_same_bytes(done, tmp_path):
    path = tmp_path / "runs.csv"
    first = run_simulations(plan(runs=1), path)
    again = run_simulations(plan(), path, jobs=2)
    assert (first.computed, again.computed, again.kept) == (2, 2, 2)
    assert path.read_bytes() == done[1].read_bytes()


def test_an_edited_row_is_computed_again_and_another_plan_is_refused(done, tmp_path):
    path = tmp_path / "runs.csv"
    text = done[1].read_text()
    path.write_text(text.replace(",walks,", ",falls,", 1))
    again = run_simulations(plan(), path)
    assert (again.computed, again.kept) == (1, 3)
    assert "line 2" in again.remarks[0]
    assert path.read_text() == text
    with pytest.raises(DescriptionError, match="another study"):
        run_simulations(plan(delays=(0.004,)), path)


@pytest.mark.parametrize(("hits", "runs"), [(0, 50), (1, 1), (25, 50), (49, 50), (50, 50)])
def test_the_interval_s_ends_are_shares_that_make_the_count_just_probable(hits, runs):
    """Wilson's condition: (p - share)^2 = z^2 share (1 - share) / n at both ends."""
    for end in wilson_interval(hits, runs):
        assert (hits / runs - end) ** 2 == pytest.approx(1.959964**2 * end * (1 - end) / runs, abs=1e-12)


@pytest.mark.parametrize(
    "changes",
    [
        {"runs": 0},
        {"runs": 10**6},
        {"spread": -1.0},
        {"delays": (math.nan,)},
        {"controllers": ("pdd",)},
        {"patients": ("helthy",)},
        {"devices": ("h2",), "supports": ("stand",)},
        {"controllers": ()},
    ],
)
def test_what_makes_no_plan_is_refused(changes):
    with pytest.raises(ExoPinError):
        plan(**changes)


def test_the_command_prints_shares_and_refuses_options_of_the_other_study(done, tmp_path, capsys):
    path = tmp_path / "runs.csv"
    path.write_bytes(done[1].read_bytes())
    words = [
        "--runs",
        "2",
        "--speeds",
        "slow",
        "--controllers",
        "pd,off",
        "--cycles",
        "1",
        "--timestep",
        "0.002",
    ]
    assert main(["study", "--simulate", *words, "-o", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["kept"], [each["verdicts"].get("walks") for each in found["conditions"]]) == (4, [2, None])
    assert main(["study", "--simulate", "--recordings", str(tmp_path)]) == 2
    assert main(["study", "--runs", "3"]) == 2

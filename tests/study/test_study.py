"""Studies: the same numbers however they are computed, interrupted or continued; bad files are reported."""

import dataclasses
import json
import math
import re
from functools import cache

import joblib
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from threadpoolctl import threadpool_limits

from exo_pin import study
from exo_pin.anatomy import Body
from exo_pin.cli import main
from exo_pin.compare import Conditions, compare
from exo_pin.devices import Device, both
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import normative_gait
from exo_pin.kinematics import plausibility
from exo_pin.study.earlier_rows import earlier
from exo_pin.study.parallel import _in_turns
from tests.damaged_files import FILES, damaged

DEVICES = ("exo12", "hk4")
RECORDED = (Conditions("recorded"),)


def plan(speeds=("slow", "free"), of=(1.6,), devices=DEVICES, conditions=RECORDED):
    return study.plan(speeds, of, devices, conditions=conditions)


plan_once = cache(plan)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A finished study: its result and its table."""
    path = tmp_path_factory.mktemp("study") / "study.csv"
    return study.run(plan(), path), path


@pytest.fixture
def walks(tmp_path):
    """A folder with a good recording, a good one in a folder below, and two that cannot be read."""
    folder = tmp_path / "walks"
    (folder / "below").mkdir(parents=True)
    (folder / ".hidden").mkdir()
    gait = normative_gait().resampled(20)
    save_gait(gait, folder / "good.csv")
    save_gait(dataclasses.replace(gait, periodic=False), folder / "below" / "also good.npz")
    (folder / ".hidden" / "no.csv").write_text("")
    (folder / "empty.csv").write_text("")
    (folder / "letters.mot").write_text("no motion\n")
    for name in ("read.me", "notes.txt"):
        (folder / name).write_text("not a recording by its ending")
    return folder


def test_the_rows_are_the_comparison_s(done):
    rows = {(row.gait, row.device, row.motion): row for row in done[0].rows}
    body = study.bodies([1.6])[0]
    with threadpool_limits(limits=1):  # as the study: several threads of linear algebra round otherwise
        compared = compare(normative_gait("slow", leg_length=body.leg_length), ["hk4"], body)
    for motion, loss in (("best", compared.best[0]), ("copy", compared.projected[0])):
        row, facts = rows["slow", "hk4", motion], loss.facts()
        assert row.sole_rms_mm == facts["sole_error_mm"]["rms"]
        assert row.foot_max_deg == facts["rotation_error_deg"]["max"]
        assert row.pre_swing_rms_mm == facts["sole_error_by_phase_mm"]["pre-swing"]
        assert row.clearance_lost_mm == facts["clearance_lost_mm"]
        assert row.knee_change_deg == facts["angle_change_deg"]["knee_flexion"]
        assert (row.motors, row.stature_m, row.mass_kg) == (4, 1.6, body.mass)


def test_every_device_has_both_rows_for_every_walk_in_the_order_of_the_plan(done):
    keys = [(row.gait, row.device, row.motion) for row in done[0].rows]
    assert keys == [(s, d, m) for s in ("slow", "free") for d in DEVICES for m in ("best", "copy")]


def test_a_table_reads_back_as_it_was_written(done):
    assert study.load(done[1]) == list(done[0].rows)
    assert tuple(done[1].read_text().splitlines()[0].split(",")) == study.TABLE_COLUMNS


def test_what_is_unknown_is_an_empty_cell(tmp_path, done):
    row = dataclasses.replace(done[0].rows[0], clearance_mm=math.nan, source='a "b",\nc')
    study.save([row], tmp_path / "t.csv")
    (again,) = study.load(tmp_path / "t.csv")
    assert math.isnan(again.clearance_mm)
    assert again.source == 'a "b", c'
    assert again.sole_max_mm == row.sole_max_mm


def test_two_workers_write_the_same_bytes_as_one(tmp_path):
    own = [Conditions("device")]  # slides, and joints at their speeds: the solver's whole length
    for jobs in (1, 2):
        study.run(plan(devices=("planar5",), conditions=own), tmp_path / f"{jobs}.csv", jobs=jobs)
    assert (tmp_path / "2.csv").read_bytes() == (tmp_path / "1.csv").read_bytes()


def test_bodies_take_turns_so_that_no_two_workers_describe_the_same_one_first():
    cases = plan(("slow", "free", "fast"), (1.5, 1.6, 1.7))
    assert list(_in_turns(cases, 1)) == cases
    turns = list(_in_turns(cases, 2))
    assert [case.body.stature for case in turns] == [1.5, 1.6] * 3 + [1.7] * 3
    assert set(turns) == set(cases)


class Plain(joblib.parallel.ThreadingBackend):
    """A back end of joblib's that gives back all results at once, as some clusters' do."""

    supports_return_generator = False


@pytest.mark.parametrize("backend", ["threading", "plain"])
def test_joblib_s_configuration_names_the_back_end(tmp_path, done, backend):
    joblib.register_parallel_backend("plain", Plain)
    with joblib.parallel_config(backend=backend, n_jobs=2):
        study.run(plan(), tmp_path / "there.csv")
    assert (tmp_path / "there.csv").read_bytes() == done[1].read_bytes()


def stopping(outcomes, _):
    """A person who presses Ctrl-C when the first case is done."""
    for k, outcome in enumerate(outcomes):
        if k:
            raise KeyboardInterrupt
        yield outcome


def test_an_interrupted_study_goes_on_and_ends_as_if_it_had_not_been(tmp_path, done):
    path = tmp_path / "s.csv"
    with pytest.raises(KeyboardInterrupt):
        study.run(plan(), path, progress=stopping)
    assert not path.exists()
    assert len(study.load(study.part(path))) == 4
    with study.part(path).open("a") as file:
        file.write('free,"half a li')  # what a power cut leaves
    again = study.run(plan(), path)
    assert (again.kept, again.computed) == (4, 4)
    assert path.read_bytes() == done[1].read_bytes()
    assert [file.name for file in tmp_path.iterdir()] == ["s.csv"]


def test_a_finished_study_may_grow_and_computes_only_what_is_new(tmp_path, done):
    path = tmp_path / "s.csv"
    path.write_bytes(done[1].read_bytes())
    more = study.run(plan(devices=(*DEVICES, "lokomat")), path)
    assert (more.kept, more.computed) == (8, 4)
    assert [row for row in more.rows if row.device in DEVICES] == list(done[0].rows)


@pytest.mark.parametrize(
    "other",
    [
        {"of": (1.7,)},
        {"speeds": ("slow",)},
        {"conditions": (Conditions("device"),)},
    ],
)
def test_the_table_of_another_study_is_not_touched(tmp_path, done, other):
    path = tmp_path / "s.csv"
    path.write_bytes(done[1].read_bytes())
    with pytest.raises(DescriptionError, match="another study"):
        study.run(plan(**other), path)
    assert path.read_bytes() == done[1].read_bytes()


def test_another_version_s_rows_are_computed_again_and_that_is_said(tmp_path, done, monkeypatch):
    path = tmp_path / "s.csv"
    path.write_bytes(done[1].read_bytes())
    monkeypatch.setattr("exo_pin.version.__version__", "99.0")
    again = study.run(plan(), path)
    assert (again.kept, again.computed) == (0, 8)
    assert "8 rows of another state of exo_pin (theirs: 0.1.0)" in again.remarks[0]
    assert {row.version for row in study.load(path)} == {"99.0"}
    fresh = study.run(plan(("slow",), devices=("hk4",)), path, restart=True)
    assert (fresh.kept, fresh.remarks) == (0, ())


def test_rows_of_other_code_or_of_another_device_of_the_name_are_computed_again(tmp_path, done):
    path = tmp_path / "s.csv"
    path.write_bytes(done[1].read_bytes())
    (slow,) = plan(("slow",))
    other = study.run([dataclasses.replace(slow, code="another solver"), *plan(("free",))], path)
    assert (other.kept, other.computed) == (4, 4)
    assert "4 rows of another state" in other.remarks[0]
    path.write_bytes(done[1].read_bytes())
    hk4 = Device(name="hk4", joints=both("hip_flexion"), source="another of the name")
    changed = study.run(plan(devices=("exo12", hk4)), path)
    assert (changed.kept, changed.computed) == (4, 4)
    assert study.run(plan(devices=("exo12", hk4)), path).remarks == ()


def rounded(text):
    """As a spreadsheet saves it: fewer digits."""
    return re.sub(r"(\d\.\d{6})\d+", r"\1", text)


def edited(text):
    head, first, rest = text.split("\n", 2)
    name, _, cells = first.partition(",")
    return "\n".join([head, f"{name},edited{cells}", rest])


@pytest.mark.parametrize(
    ("damage", "kept"),
    [
        (edited, 6),
        (rounded, 0),
        (lambda text: text.replace(",best,", ",copy,", 1), 6),
        (lambda text: text.replace("slow,", '"slow,', 1), 6),  # a quote without an end costs its own line
        (lambda text: text + "1" * 200_000, 8),
        (lambda text: text + "\ufffd\0\n", 8),
        (lambda text: text.replace("\n", "\r\n"), 8),  # as Windows ends lines: the cells are the same
        (lambda text: text.replace("\n", "\n\n"), 8),
    ],
)
def test_edited_and_damaged_rows_are_computed_again_to_the_same_bytes(tmp_path, done, damage, kept):
    path = tmp_path / "s.csv"
    text = damage(done[1].read_text()) + "\n"
    (study.part(path) if damage is edited else path).write_bytes(text.encode())
    again = study.run(plan(), path)
    assert again.kept == kept
    assert path.read_bytes() == done[1].read_bytes()
    assert kept == 8 or "edited or damaged and not used: line 2" in again.remarks[0]


@settings(max_examples=FILES, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_damaged_table_gives_only_rows_that_were_written_or_one_line(tmp_path, done, data):
    """EXO_PIN_MUTATIONS=5000 tries as many."""
    path = tmp_path / "s.csv"
    pieces = [b",", b'"', b"\n", b"\0", b"\xff", b"9" * 5000, b"1e999", b"nan", b"=1+1", b"\x1b[2J"]
    path.write_bytes(data.draw(damaged(done[1].read_bytes(), pieces)))
    try:
        found = earlier(path, plan_once(), restart=False)
    except (FormatError, DescriptionError) as error:
        message = str(error)
        assert message.isprintable()
        return
    assert {row for rows in found.rows.values() for row in rows.values()} <= set(done[0].rows)


def test_a_worker_of_another_version_computes_nothing(monkeypatch):
    cases = plan(("slow",))
    monkeypatch.setattr("exo_pin.version.__version__", "99.0")
    result = study.run(cases)
    assert result.rows == ()
    assert result.failures == {"slow": "slow: the worker has exo_pin 99.0"}


def test_a_file_that_is_no_study_is_not_overwritten(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("precious,data\n1,2\n")
    for restart in (False, True):
        with pytest.raises(FormatError, match="not the table of a study"):
            study.run(plan(), path, restart=restart)
    assert path.read_text() == "precious,data\n1,2\n"


def test_a_damaged_row_is_reported_with_its_line(tmp_path, done):
    path = tmp_path / "s.csv"
    path.write_text(done[1].read_text().replace(",recorded,", ",", 1))
    with pytest.raises(FormatError, match=r"s\.csv:2"):
        study.load(path)


def test_every_recording_of_a_folder_is_studied_and_bad_ones_are_reported(walks):
    result = study.run(study.recordings(walks, devices=("hk4",), conditions=RECORDED))
    assert [row.gait for row in result.rows] == ["below/also good.npz"] * 2 + ["good.csv"] * 2
    assert set(result.failures) == {"empty.csv", "letters.mot"}
    assert all(name in why and "\n" not in why for name, why in result.failures.items())
    assert {row.stature_m for row in result.rows} == {Body.from_stature().stature}


def test_the_rows_hold_the_reasons_against_a_walk_that_info_gives(tmp_path, robot):
    """One sample off its curve, and a pelvis that drags the feet along: neither was in the table before."""
    walk = normative_gait().repeated(3)
    q, base = walk.q.copy(), np.array(walk.base)
    q[150, 3] += np.radians(15)
    base[:, 0, 3] += 2.0 * walk.time
    folder = tmp_path / "doubtful"
    folder.mkdir()
    save_gait(dataclasses.replace(walk, q=q, base=base), folder / "walk.npz")
    rows = study.run(study.recordings(folder, devices=("hk4",), conditions=RECORDED)).rows
    (doubts,) = {row.doubts for row in rows}
    reasons = plausibility(robot, load_gait(folder / "walk.npz")).reasons
    assert doubts == "; ".join(reasons)
    assert "stand" in doubts
    assert "slides" in doubts


def test_an_unexpected_error_costs_its_recording_only(walks, monkeypatch):
    def broken(file, **_):
        if file.path.name.endswith("good.npz"):
            raise IndexError("a bug")
        return normative_gait()

    monkeypatch.setattr("exo_pin.study.case.load_gait", broken)
    result = study.run(study.recordings(walks, devices=("hk4",), conditions=RECORDED))
    assert "unexpected IndexError: a bug" in result.failures["below/also good.npz"]
    assert "good.csv" in {row.gait for row in result.rows}


def test_a_changed_recording_is_studied_again(walks, tmp_path):
    path = tmp_path / "s.csv"
    study.run(study.recordings(walks, devices=("hk4",), conditions=RECORDED), path)
    save_gait(normative_gait("slow").resampled(20), walks / "good.csv")
    again = study.run(study.recordings(walks, devices=("hk4",), conditions=RECORDED), path)
    assert (again.kept, again.computed) == (2, 2)
    assert "a recording are computed again" in again.remarks[0]


def test_a_marker_trial_is_studied_on_its_own_body(shared, tmp_path, monkeypatch):
    from exo_pin.markers.reconstruction import Reconstruction

    gait, body = normative_gait().resampled(20), Body.from_stature(1.8)
    trial = Reconstruction(gait, body, "set", (), gait.time[:, None], 0)
    monkeypatch.setattr("exo_pin.markers.load_walk", lambda path: trial)
    (tmp_path / "a.trc").write_bytes((shared / "opensim_subject01_walk" / "subject01_walk1.trc").read_bytes())
    for on, stature in ((None, 1.8), (Body.from_stature(1.6), 1.6)):
        cases = study.recordings(tmp_path, [on], devices=("hk4",), conditions=RECORDED)
        assert {row.stature_m for row in study.run(cases).rows} == {stature}


@pytest.mark.parametrize("jobs", [0, -2, -5, 10**9, 1.5, "two", math.nan])
def test_a_number_of_workers_that_cannot_be_is_refused(jobs):
    with pytest.raises(DescriptionError, match=r"a number of processes from 1 to \d+, or -1"):
        study.run(plan_once(), jobs=jobs)


@pytest.mark.parametrize("jobs", ["two", "1.5", "9" * 5000, ""])
def test_the_command_refuses_jobs_that_are_no_number(capsys, jobs):
    with pytest.raises(SystemExit) as stop:
        main(["study", "--jobs", jobs])
    assert stop.value.code == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_statures_go_from_low_to_high_in_steps():
    assert study.statures() == pytest.approx([1.5 + 0.05 * k for k in range(10)])
    assert study.statures(1.6, 1.6) == (1.6,)
    for low, high, step in (
        (1.8, 1.6, 0.1),
        (1.5, 1.9, 0.0),
        (1.5, 1.9, -0.1),
        (1.5, math.nan, 0.1),
        (1, 2, 1e-9),
    ):
        with pytest.raises(DescriptionError, match="statures"):
            study.statures(low, high, step)


def test_masses_follow_the_body_mass_index_of_the_default_body():
    default, small = study.bodies([Body.from_stature().stature, 1.5])
    assert default.mass == pytest.approx(Body.from_stature().mass, abs=1e-3)
    assert small.mass / small.stature**2 == pytest.approx(default.mass / default.stature**2, rel=1e-4)
    assert study.bodies([1.5], mass=80.0)[0].mass == 80.0


def test_a_plan_with_unknown_or_repeated_names_is_refused(tmp_path):
    with pytest.raises(UnknownNameError, match="speed"):
        study.plan(("running",))
    with pytest.raises(UnknownNameError, match="device"):
        study.plan(devices=("hal",))
    with pytest.raises(DescriptionError, match="name of its own"):
        study.plan(devices=("hk4", "hk4"))
    with pytest.raises(FormatError, match="no such folder"):
        study.recordings(tmp_path / "none")
    with pytest.raises(FormatError, match="holds no recording"):
        study.recordings(tmp_path)


def test_the_summary_has_mean_and_worst_of_every_device(done):
    columns, lines = study.summary(done[0].rows)
    assert columns == ("device", "motors", "pelvis recorded: mean", "pelvis recorded: worst")
    assert [line[0] for line in lines] == ["exo12", "hk4"]
    errors = [r.sole_rms_mm for r in done[0].rows if (r.device, r.motion) == ("hk4", "best")]
    assert float(lines[1][2]) == pytest.approx(sum(errors) / 2, abs=0.05)
    assert float(lines[1][3]) == pytest.approx(max(errors), abs=0.05)


def test_the_command_writes_table_page_and_json_and_goes_on(tmp_path, capsys):
    table = tmp_path / "s.csv"
    words = ["study", "-o", str(table), "--speeds", "free", "--devices", "hk4", "--pelvis", "recorded"]
    assert main([*words, "--statures", "1.6", "1.7", "--step", "0.1", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert (facts["rows"], facts["computed"], facts["walks"]) == (4, 4, 2)
    assert "Against stature" in (tmp_path / "s.html").read_text()
    assert main([*words, "--statures", "1.6", "1.7", "--step", "0.1", "--no-page"]) == 0
    assert "4 rows (4 of them from before)" in capsys.readouterr().out
    assert main([*words, "--statures", "1.6", "1.6"]) == 2
    assert "another study" in capsys.readouterr().err


def test_bad_recordings_show_in_the_exit_code_of_the_command(walks, tmp_path, capsys):
    words = ["study", "--devices", "hk4", "--pelvis", "recorded", "-o", str(tmp_path / "s.csv")]
    assert main([*words, "--recordings", str(walks)]) == 1
    printed = capsys.readouterr()
    assert [line.split(":")[0] for line in printed.err.splitlines()] == ["left out"] * 2
    assert "2 left out" in printed.out
    (walks / "good.csv").unlink()
    (walks / "below" / "also good.npz").unlink()
    assert main([*words[:-1], str(tmp_path / "none.csv"), "--recordings", str(walks)]) == 2
    assert not list(tmp_path.glob("none*"))


def test_the_command_ends_on_ctrl_c_with_a_line(tmp_path, capsys, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("exo_pin.study.run", interrupted)
    assert main(["study", "-o", str(tmp_path / "s.csv")]) == 130
    assert "the same command continues" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        ["-o", "s.txt"],
        ["--page", "s.pdf"],
        ["--jobs", "0"],
        ["--jobs", "-5"],
        ["--jobs", str(10**9)],
        ["--step", "0"],
        ["--body", "b.toml"],
        ["--recordings", "none"],
        ["--devices", "hal"],
        ["--recordings", ".", "--body", "b.toml", "--statures", "1.6", "1.7"],
    ],
)
def test_the_command_refuses_what_makes_no_study(words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["study", *words]) == 2
    assert capsys.readouterr().err.startswith("exo-pin: ")
    assert not list(tmp_path.iterdir())

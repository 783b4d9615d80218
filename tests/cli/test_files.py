"""Commands on files of other laboratories: mapped tables, marker trials, cycles and adjustments."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, Body
from exo_pin.cli import main, options
from exo_pin.formats import load_gait, save_gait
from exo_pin.gait import Gait, leg_cycles, normative_gait
from exo_pin.viewer.scenes.compiler import phase_cycles

OPENSIM_RMS = 0.0225  # [m] OpenSim's own on that trial
EXACT = 1e-9  # [rad] degrees in text and back


def run(capsys, *words):
    code = main(list(map(str, words)))
    out, err = capsys.readouterr()
    return code, out, err


@pytest.fixture
def recording(tmp_path):
    """Three cycles of the normal walk as a recording without events."""
    long = normative_gait("free").repeated(3)
    path = tmp_path / "walk.csv"
    save_gait(Gait(long.time, long.q, base=long.base, source="three cycles"), path)
    return path


@pytest.mark.parametrize("ending", [".tsv", ".npz", ".yaml", ".json", ".c3d"])
def test_convert_writes_every_format(capsys, tmp_path, ending):
    path = tmp_path / f"walk{ending}"
    code, _, _ = run(capsys, "convert", "free", path)
    assert code == 0
    assert load_gait(path).q == pytest.approx(normative_gait("free").q, abs=1e-6)
    assert load_gait(path).base == pytest.approx(normative_gait("free").base, abs=1e-6)


def test_a_walk_between_the_frames_is_sampled_for_a_c3d_file(capsys, tmp_path):
    walk = normative_gait("free")
    save_gait(Gait(walk.time + 0.0037, walk.q, base=walk.base), tmp_path / "late.csv")
    words = ["convert", tmp_path / "late.csv", tmp_path / "walk.c3d"]
    code, _, err = run(capsys, *words)
    assert (code, len(err.splitlines())) == (2, 1)
    assert "sample the walk at a rate" in err
    code, _, _ = run(capsys, *words, "--rate", 100)
    assert code == 0
    assert load_gait(tmp_path / "walk.c3d").time[:2] == pytest.approx([0.01, 0.02])


def test_a_foreign_table_is_mapped_on_the_command_line(capsys, tmp_path):
    walk = normative_gait("free")
    table = tmp_path / "lab.csv"
    knee = np.degrees(walk.q[:, JOINTS.index("left_knee_flexion")])
    rows = "\n".join(f"{t!r};{-k!r}" for t, k in zip(walk.time.tolist(), knee.tolist(), strict=True))
    table.write_text("seconds;KneeL\n" + rows)
    others = ",".join(joint for joint in JOINTS if joint != "left_knee_flexion")
    words = [
        "--map",
        "seconds=time",
        "--map=-KneeL=left_knee_flexion",
        "--map",
        f"0={others}",
        "--units",
        "deg",
    ]
    code, _, err = run(capsys, "convert", table, tmp_path / "walk.csv", *words)
    assert code == 0
    assert "warning" not in err
    np.testing.assert_allclose(load_gait(tmp_path / "walk.csv").q[:, 3], walk.q[:, 3], atol=EXACT)
    code, _, err = run(capsys, "convert", table, tmp_path / "x.csv", *words[:3], "--map", "KneeL")
    assert code == 2
    assert "not of the form COLUMN=JOINT" in err


def test_a_wrong_sign_is_warned_of(capsys, tmp_path):
    walk = normative_gait("free")
    q = walk.q.copy()
    q[:, JOINTS.index("left_knee_flexion")] *= -1
    save_gait(Gait(walk.time, q), tmp_path / "wrong.csv")
    code, out, err = run(capsys, "info", tmp_path / "wrong.csv")
    assert code == 0
    assert "warning: left knee bends backwards" in err
    assert "doubtful:\n  left knee bends backwards" in out


def test_cycles_prints_numbers_and_writes_mean_and_spread(capsys, tmp_path, recording):
    table, mean = tmp_path / "cycles.csv", tmp_path / "mean.csv"
    code, out, _ = run(capsys, "cycles", recording, "-o", table, "--mean", mean)
    assert code == 0
    assert "cadence" in out
    lines = [line for line in table.read_text().splitlines() if not line.startswith("#")]
    assert len(lines) == 1 + 101
    assert lines[0].startswith("percent,left_hip_flexion_mean_deg,left_hip_flexion_sd_deg")
    assert load_gait(mean).periodic
    code, out, _ = run(capsys, "cycles", recording, "--json", "-o", table)
    facts = json.loads(out)  # and nothing else is printed
    assert facts["cycles"]["left"] >= 1
    assert facts["spatiotemporal"]["speed"]["unit"] == "m/s"


def test_standing_has_no_cycles(capsys, tmp_path):
    save_gait(Gait(np.arange(100) / 50, np.full((100, 12), 0.1)), tmp_path / "stand.csv")
    code, _, err = run(capsys, "cycles", tmp_path / "stand.csv")
    assert code == 2
    assert "no gait cycles found" in err.splitlines()[-1]
    code, out, _ = run(capsys, "info", tmp_path / "stand.csv")
    assert code == 0
    assert "cycles: no gait cycles found" in out


def test_outliers_are_reported_with_joint_time_and_size(capsys, tmp_path, recording):
    for command in ("info", "cycles"):
        assert "outlier: " not in run(capsys, command, recording)[1]
    walk = load_gait(recording)
    q, base = walk.q.copy(), walk.base.copy()
    q[140, JOINTS.index("right_knee_flexion")] += np.radians(7)
    base[90, 2, 3] -= 0.05
    path = tmp_path / "odd.csv"
    save_gait(Gait(walk.time, q, base=base), path)
    for command in ("info", "cycles"):
        code, out, _ = run(capsys, command, path)
        assert code == 0
        assert f"outlier: right_knee_flexion at {walk.time[140]:.3f} s is +7.0 deg off its neighbours" in out
        assert f"outlier: pelvis_z at {walk.time[90]:.3f} s is -50.0 mm off its neighbours" in out
        code, out, _ = run(capsys, command, path, "--json")
        found = {x["curve"]: x for x in json.loads(out)["outliers"]}
        assert set(found) == {"right_knee_flexion", "pelvis_z"}
        assert found["right_knee_flexion"]["off"] == pytest.approx(7, abs=0.1)


def test_half_a_stride_has_estimated_numbers_and_nothing_to_cut(capsys, tmp_path):
    walk = normative_gait().repeated(3)
    keep = (walk.time >= 0.55 * walk.duration / 3) & (walk.time <= 1.65 * walk.duration / 3)
    path = tmp_path / "half.csv"
    events = [e for e in walk.events if walk.time[keep][0] <= e.time <= walk.time[keep][-1]]
    save_gait(Gait(walk.time[keep], walk.q[keep], base=walk.base[keep], events=events, source="half"), path)
    for command in ("cycles", "info"):
        code, out, _ = run(capsys, command, path)
        assert code == 0
        assert "estimate: no whole cycle of the left foot" in out
    facts = json.loads(run(capsys, "cycles", path, "--json")[1])
    assert facts["estimate"]["stride_s"] == pytest.approx(walk.duration / 3, abs=0.02)  # two samples
    assert facts["cycles"] == {"left": 0, "right": 0}
    for option in (("-o", tmp_path / "x.csv"), ("--mean", tmp_path / "y.mot"), ("--side", "right")):
        code, _, err = run(capsys, "cycles", path, *option)
        assert code == 2
        assert "needs a whole cycle" in err
    assert not list(tmp_path.glob("[xy].*"))


@pytest.mark.parametrize("side", ["left", "right"])
def test_cycles_of_one_foot_alone_are_cut_and_counted(capsys, tmp_path, side):
    """A recording of 1.2 strides around two strikes of one foot and one of the other."""
    walk = normative_gait().repeated(3)
    start = (0.9 if side == "left" else 0.4) * walk.duration / 3
    keep = (walk.time >= start) & (walk.time <= start + 1.2 * walk.duration / 3)
    events = [e for e in walk.events if walk.time[keep][0] <= e.time <= walk.time[keep][-1]]
    path = tmp_path / "one.csv"
    save_gait(Gait(walk.time[keep], walk.q[keep], base=walk.base[keep], events=events, source="one"), path)
    code, out, _ = run(capsys, "cycles", path)
    assert code == 0
    assert f"1 cycle of the {side} foot" in out
    facts = json.loads(run(capsys, "cycles", path, "--json")[1])
    assert facts["cycles"] == {"left": int(side == "left"), "right": int(side == "right")}
    assert facts["estimate"] is None
    gait = load_gait(path)
    assert phase_cycles(gait).side == side
    assert any(leg.side == side and "one cycle" in leg.note for leg in leg_cycles(gait))


def test_cycles_names_the_publication_of_every_range(capsys, recording):
    out = run(capsys, "cycles", recording, "--json")[1]
    facts = json.loads(out)
    for name, number in facts["spatiotemporal"].items():
        assert (number["usual"] is None) == (number["normal"] is None), name
        if number["usual"]:
            assert number["usual"]["source"] in facts["sources"]
    text = run(capsys, "cycles", recording)[1]
    assert "Bohannon, Andrews, Physiotherapy 97 (2011)" in text
    assert "no published range was checked" in text


def test_edit_adjusts_in_order_and_says_so(capsys, tmp_path):
    path = tmp_path / "new.csv"
    words = ["--slower", 2, "--stride", 0.9, "--amplitude", "ankle_inversion=0.5", "--mirror", "--cutoff", 12]
    code, out, _ = run(capsys, "edit", "free", path, *words)
    assert code == 0
    gait = load_gait(path)
    assert gait.duration == pytest.approx(2 * normative_gait("free").duration)
    said = [
        gait.source.index(x) for x in ("Butterworth", "mirrored", "amplitude", "stride x0.9", "retimed x2")
    ]
    assert said == sorted(said)
    assert "stride x0.9" in out


def test_edit_blends_symmetrises_and_ramps(capsys, tmp_path):
    path = tmp_path / "new.npz"
    code, _, _ = run(capsys, "edit", "free", path, "--symmetric", "--blend", "slow=0.5", "--ramp", 1, 1)
    assert code == 0
    assert np.abs(load_gait(path).dq[[0, -1]]).max() < 0.05


def test_edit_makes_a_recordings_mean_cycle_first(capsys, tmp_path, recording):
    path = tmp_path / "even.csv"
    code, out, _ = run(capsys, "edit", recording, path, "--cutoff", 12, "--cycle", "--symmetric")
    assert code == 0
    gait = load_gait(path)
    assert gait.periodic
    assert gait.base is not None
    assert len(gait.events) == 4
    assert "mean of 2 cycles of the right foot" in out  # it has one strike more
    code, _, err = run(capsys, "edit", recording, tmp_path / "no.csv", "--symmetric")
    assert code == 2
    assert "--cycle" in err.splitlines()[-1]
    save_gait(Gait(np.arange(100) / 50, np.full((100, 12), 0.1)), tmp_path / "stand.csv")
    code, _, err = run(capsys, "edit", tmp_path / "stand.csv", tmp_path / "no.csv", "--cycle")
    assert code == 2
    assert "no gait cycles found: the left foot moves 0.000 m" in err.splitlines()[-1]
    assert not (tmp_path / "no.csv").exists()


def test_the_filters_order_and_cut_off_stand_in_the_output(capsys, recording):
    out = run(capsys, "cycles", recording, "--cutoff", 9)[1]
    assert "zero-lag Butterworth, order 4 (forward and backward together), cut-off 9 Hz" in out


def test_edit_goes_over_from_one_walk_to_another(capsys, tmp_path):
    path = tmp_path / "faster.csv"
    code, out, _ = run(capsys, "edit", "slow", path, "--transition", "free=3", "--lead", 1, "--mirror")
    assert code == 0
    for done in ("as it is", "mirrored", "transition"):
        assert any(line.strip().startswith(done) for line in out.splitlines()), done
    slow, free = (normative_gait(speed).duration for speed in ("slow", "free"))
    assert load_gait(path).duration == pytest.approx(slow + 1.5 * (slow + free) + free)
    code, out, _ = run(capsys, "edit", "slow", path, "--transition", "free=4s", "--lead", 0, "--json")
    facts = json.loads(out)
    assert facts["duration_s"] == pytest.approx(4)
    assert [step["step"] for step in facts["steps_in_rad"]] == ["as it is", "transition"]
    assert all(step["ok"] for step in facts["steps_in_rad"])


def test_edit_writes_what_leaves_the_limits_but_exits_with_1(capsys, tmp_path):
    path = tmp_path / "wild.csv"
    code, out, _ = run(capsys, "edit", "free", path, "--amplitude", "knee_flexion=3")
    assert code == 1
    assert path.exists()
    assert "left_knee_flexion: angle" in out
    for words in (
        ["--stride", 9],
        ["--amplitude", "knee_flexion"],
        ["--blend", "slow"],
        ["--ramp", -1, 1],
        ["--transition", "slow=x"],
    ):
        code, _, err = run(capsys, "edit", "free", tmp_path / "no.csv", *words)
        assert (code, len(err.splitlines())) == (2, 1)
        assert not (tmp_path / "no.csv").exists()


@pytest.mark.parametrize("command", ["info", "convert"])
def test_a_marker_trial_is_solved_on_its_own_body(capsys, tmp_path, shared, command):
    trial = shared / "opensim_subject01_walk/subject01_walk1.trc"
    words = [tmp_path / "walk.csv"] if command == "convert" else ["--json"]
    code, out, err = run(capsys, command, trial, *words)
    assert code == 0
    assert "RMS" in err
    assert re.search(r"furthest marker [RL]\.\S+ \d+\.\d mm at", err)
    if command == "info":
        facts = json.loads(out)
        assert len(facts["events"]) == 8
        assert len(facts["markers"]["frame_rms_mm"]) == len(facts["markers"]["frame_worst_mm"]) == 151
        assert 5 < facts["markers"]["rms_mm"] < 1e3 * OPENSIM_RMS


def test_a_model_tells_how_a_motion_is_meant(capsys, tmp_path, shared):
    folder = shared / "opensim_subject01_walk"
    words = ["convert", folder / "subject01_walk1_ik.mot", tmp_path / "walk.csv"]
    code, _, err = run(capsys, *words, "--model", folder / "subject01_simbody.osim")
    assert code == 0
    assert "as subject01_simbody.osim has them" in err
    code, _, err = run(capsys, *words, "--pelvis-order", "rotation,list,tilt")
    assert "the order rotation, list, tilt" in err
    code, _, err = run(capsys, "convert", "free", tmp_path / "x.csv", "--model", "a.osim")
    assert (code, len(err.splitlines())) == (2, 1)


def test_a_second_walk_may_be_a_marker_trial(shared):
    trial = shared / "opensim_subject01_walk/subject01_walk1.trc"
    assert "markers (opensim-gait2392)" in options.load(str(trial), Body.from_stature()).source


def test_what_is_no_gait_is_refused_in_one_line(capsys, tmp_path, shared):
    folder = shared / "opensim_subject01_walk"
    for name in (
        "subject01_walk1_grf.mot",
        "subject01_walk1_id.sto",
        "subject01_simbody.osim",
        "no.trc",
        "no.c3d",
    ):
        code, _, err = run(capsys, "convert", folder / name, tmp_path / "x.csv")
        assert (code, len(err.splitlines())) == (2, 1), name
    assert not list(tmp_path.iterdir())


def test_force_plates_tell_when_the_feet_struck(capsys, tmp_path, shared):
    """Named plates correct the events they saw; each event says its source; forces of nobody are refused."""
    subject = shared / "opensim_subject01_walk"
    walk = subject / "subject01_walk1_ik_full_opensim46.mot"
    code, out, _ = run(capsys, "info", walk, "--forces", subject / "subject01_walk1_grf.mot", "--json")
    sources = [event["source"] for event in json.loads(out)["events"]]
    assert code == 0
    assert sum(source == "force plate" for source in sources) == 8
    code, _, err = run(capsys, "info", "free", "--forces", subject / "subject01_walk1_grf.mot")
    assert (code, len(err.splitlines())) == (2, 1)
    code, out, err = run(capsys, "cycles", walk, "--forces", walk)
    assert (code, out) == (2, "")
    assert "no ground reaction forces" in err.splitlines()[-1]


def test_interchanged_markers_are_doubted(capsys, tmp_path, shared):
    """The heels' names change places: the fit says so, with the markers; the true trial has no doubts."""
    path = shared / "opensim_subject01_walk/subject01_walk1.trc"
    _, out, _ = run(capsys, "info", path, "--json")
    assert json.loads(out)["plausibility"] == {"word": "plausible", "reasons": []}
    wrong = tmp_path / "wrong.trc"
    text = path.read_text().replace("L.Heel", "?").replace("R.Heel", "L.Heel").replace("?", "R.Heel")
    wrong.write_text(text)
    code, out, err = run(capsys, "info", wrong, "--json")
    (doubt,) = (text for text in json.loads(out)["plausibility"]["reasons"] if "markers lie" in text)
    assert code == 0
    assert "Heel" in doubt
    assert doubt in err


def test_cycles_says_whose_lengths_they_are(capsys, recording):
    """A recording of angles has nobody's size; a measure or a normal walk needs no such remark."""
    remark = "lengths and width are the default body's"
    assert remark in run(capsys, "cycles", recording)[1]
    assert remark not in run(capsys, "cycles", recording, "--stature", 1.6)[1]
    assert remark not in run(capsys, "cycles", "free")[1]

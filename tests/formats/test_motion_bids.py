"""Motion-BIDS: the specification's files and fields, round trips, foreign channels, markers, damage."""

from __future__ import annotations

import json

import numpy as np
import pytest

from exo_pin.cli import main
from exo_pin.errors import FormatError
from exo_pin.formats import is_markers, load_gait, load_markers, save_gait
from exo_pin.gait import Gait, normative_gait

NAME = "sub-01_task-walk_tracksys-imu_motion.tsv"
EXACT = 1e-12  # [rad, m]


@pytest.fixture
def walk():
    gait = normative_gait("free", samples=20)
    return Gait(gait.time, gait.q, base=gait.base, events=gait.events, periodic=True, source='a "walk", é')


@pytest.fixture
def path(tmp_path):
    return tmp_path / NAME


def beside(path, ending):
    return path.with_name(path.name.replace("_motion.tsv", ending))


def test_the_walk_comes_back_with_all_it_has(path, walk):
    late = Gait(walk.time + 3.25, walk.q, base=walk.base, source="late", events=())
    for gait in (walk, late):
        save_gait(gait, path)
        back = load_gait(path)
        np.testing.assert_allclose(back.q, gait.q, atol=EXACT)
        np.testing.assert_allclose(back.base, gait.base, atol=EXACT)
        np.testing.assert_allclose(back.time, gait.time, atol=EXACT)
        assert (back.periodic, back.source) == (gait.periodic, gait.source)
        assert [(e.kind, e.side, e.source) for e in back.events] == [
            (e.kind, e.side, e.source) for e in gait.events
        ]
        np.testing.assert_allclose([e.time for e in back.events], [e.time for e in gait.events], atol=EXACT)


def test_the_files_are_as_the_specification_has_them(path, walk):
    """BIDS 1.10, Motion: no header row; as many columns as channels; required columns, fields, words."""
    save_gait(walk, path)
    header, *rows = [line.split("\t") for line in beside(path, "_channels.tsv").read_text().splitlines()]
    assert header[:5] == ["name", "component", "type", "tracked_point", "units"]
    assert {row[1] for row in rows} <= {"x", "y", "z", "quat_x", "quat_y", "quat_z", "quat_w", "n/a"}
    assert {row[2] for row in rows} <= {"LATENCY", "JNTANG", "POS", "ORNT"}
    motion = [line.split("\t") for line in path.read_text().splitlines()]
    assert len(motion) == 20
    assert {len(row) for row in motion} == {len(rows)}
    assert float(motion[0][0]) == 0.0
    fields = json.loads(beside(path, "_motion.json").read_text())
    assert fields["TaskName"] == "walk"
    assert fields["SamplingFrequency"] == pytest.approx(1 / walk.time[1])
    assert fields["MotionChannelCount"] == len(rows) == 20
    assert fields["JNTANGChannelCount"] + fields["POSChannelCount"] + fields["ORNTChannelCount"] == 19
    levels = json.loads(beside(path, "_channels.json").read_text())["reference_frame"]["Levels"]
    assert levels["global"]["SpatialAxes"] == "ALS"
    assert beside(path, "_events.tsv").read_text().splitlines()[0].split("\t")[:2] == ["onset", "duration"]


@pytest.mark.parametrize(
    "name", ["walk_motion.tsv", "sub-0_1_task-walk_tracksys-imu_motion.tsv", "_motion.tsv"]
)
def test_a_name_that_bids_does_not_allow_is_refused(tmp_path, walk, name, capsys):
    assert main(["convert", "free", str(tmp_path / name)]) == 2
    assert "sub-01_task-walk_tracksys-imu_motion.tsv" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def foreign(path, units="deg", rate=50.0):
    """Another laboratory's recording: knees in its own names, two markers in mm, no latency."""
    rows = ["KL\tn/a\tJNTANG\tleft_knee\t{0}", "KR\tn/a\tJNTANG\tright_knee\t{0}"]
    rows += [f"{m}_{a}\t{a}\tPOS\t{m}\tmm" for m in ("LASI", "RASI") for a in "xyz"]
    text = "\n".join(["name\tcomponent\ttype\ttracked_point\tunits", *rows, ""])
    beside(path, "_channels.tsv").write_text(text.format(units))
    beside(path, "_motion.json").write_text(json.dumps({"TaskName": "walk", "SamplingFrequency": rate}))
    beside(path, "_events.tsv").write_text("onset\tduration\ttrial_type\n0.02\t0\tLHS\n0.04\tn/a\tclap\n")
    path.write_text("".join(f"{k}\t{2 * k}\t100\t200\t900\tn/a\tn/a\tn/a\n" for k in range(6)))
    return path


def test_channels_of_others_are_mapped_and_their_markers_are_a_trial(path):
    hips = (
        "left_hip_flexion,left_hip_adduction,left_hip_rotation,left_ankle_dorsiflexion,left_ankle_inversion"
    )
    mapping = {
        "KL": "left_knee_flexion",
        "-KR": "right_knee_flexion",
        "0": f"{hips},{hips.replace('left', 'right')}",
    }
    gait = load_gait(foreign(path), mapping=mapping)
    np.testing.assert_allclose(gait.q[:, 3], np.radians(np.arange(6)), atol=EXACT)
    np.testing.assert_allclose(gait.q[:, 9], -np.radians(2 * np.arange(6)), atol=EXACT)
    np.testing.assert_allclose(gait.time, np.arange(6) / 50, atol=EXACT)
    assert [(e.time, e.side, e.kind) for e in gait.events] == [(0.02, "left", "heel_strike")]
    assert "1 events of its _events.tsv" in gait.remarks[0]
    markers = load_markers(path)
    np.testing.assert_allclose(markers.of("LASI")[0], [0.1, 0.2, 0.9])
    assert np.isnan(markers.of("RASI")).all()
    assert not is_markers(path)


@pytest.mark.parametrize(
    ("ending", "old", "new", "match"),
    [
        ("_channels.tsv", "units", "unit", "missing columns: units"),
        ("_channels.tsv", "latency\tn/a\tLATENCY", "latency\tn/a", "rows of 6 cells"),
        ("_motion.json", "{", "[", "no JSON"),
        ("_motion.tsv", "\t", "\tx", "expected a number"),
        ("_events.tsv", "\t0\t", "\t", "an onset in seconds"),
        ("_events.tsv", "\n", "\n1e999\t0\tleft heel_strike\n", "an onset in seconds"),
        ("_motion.json", '"start": 0.0', '"start": 1e999', "no time in seconds"),
        ("_motion.json", '"start": 0.0', '"start": NaN', "no time in seconds"),
        ("_motion.json", '"start": 0.0', f'"start": {"9" * 400}', "no time in seconds"),
        ("_channels.tsv", "\tdeg\t", "\tgrad\t", "deg or rad are read"),
        ("_channels.tsv", "left_knee_flexion\t", "left_knie\t", "no column 'left_knee_flexion'"),
    ],
)
def test_damaged_recordings_are_refused_with_the_file_at_fault(path, walk, ending, old, new, match):
    save_gait(walk, path)
    file = beside(path, ending)
    file.write_text(file.read_text().replace(old, new, 1))
    with pytest.raises(FormatError, match=match):
        load_gait(path)


@pytest.mark.parametrize("ending", ["_channels.tsv", "_motion.json"])
def test_a_file_that_bids_demands_is_named_where_it_misses(path, walk, ending):
    save_gait(walk, path)
    beside(path, ending).unlink()
    with pytest.raises(FormatError, match="no such file") as caught:
        load_gait(path)
    assert caught.value.path.name.endswith(ending)

"""A trial file is read once, whatever a command makes of it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

from exo_pin import files
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import SIGN_PRESETS
from exo_pin.cli import main, trials
from exo_pin.errors import FormatError
from exo_pin.formats import (
    FORMATS,
    MARKER_FORMATS,
    PRESETS,
    is_markers,
    load_forces,
    load_gait,
    load_markers,
    load_torques,
    open_trial,
)
from exo_pin.gait import normative_gait
from exo_pin.markers import Reconstruction, load_walk
from exo_pin.study import Case, solve

WALK = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"
TRIALS = (".c3d", ".trc", ".mot", ".sto")
RECORDING = "opensim_subject01_walk/subject01_walk1"


@pytest.fixture
def count(monkeypatch):
    """How often each file is read, and how many child processes start."""
    reads = {}
    read_bytes, run = files.read_bytes, subprocess.run

    def counted(path):
        name = Path(path).name
        if Path(path).suffix in TRIALS:
            reads[name] = reads.get(name, 0) + 1
        return read_bytes(path)

    def started(*words, **options):
        reads["child process"] = reads.get("child process", 0) + 1
        return run(*words, **options)

    monkeypatch.setattr(files, "read_bytes", counted)
    monkeypatch.setattr("exo_pin.formats.c3d.reader.read_bytes", counted)
    monkeypatch.setattr(subprocess, "run", started)
    return reads


@pytest.fixture
def unsolved(monkeypatch):
    """Marker trials are read but not solved, which takes seconds."""
    body, gait = Body.from_stature(), normative_gait("free")
    made = Reconstruction(gait, body, "plug-in-gait", ("LASI",), np.zeros((len(gait), 1)), 0)
    monkeypatch.setattr("exo_pin.markers.reconstruction.reconstruct", lambda trial, **options: made)


@pytest.mark.parametrize(
    "words",
    [
        ["info", "{walk}"],
        ["cycles", "{walk}", "--json"],
        ["cycles", "{walk}", "--forces", "{walk}"],
        ["convert", "{walk}", "{folder}/walk.csv"],
        ["replay", "{walk}", "--html", "{folder}/walk.html", "--compare", "{walk}", "--torques", "{walk}"],
    ],
    ids=lambda words: " ".join(words).replace("{walk}", "WALK"),
)
def test_a_command_starts_one_child_process_for_a_c3d_file(shared, tmp_path, capsys, count, words):
    assert main([word.format(walk=shared / WALK, folder=tmp_path) for word in words]) == 0
    assert count == {"HC036A10_walk.c3d": 1, "child process": 1}


def test_markers_of_a_c3d_file_and_of_a_trc_file_are_read_once(shared, tmp_path, capsys, count, unsolved):
    assert main(["convert", str(shared / WALK), str(tmp_path / "walk.npz"), "--markers", "auto"]) == 0
    assert count == {"HC036A10_walk.c3d": 1, "child process": 1}
    count.clear()
    assert main(["convert", str(shared / f"{RECORDING}.trc"), str(tmp_path / "walk.npz")]) == 0
    assert count == {"subject01_walk1.trc": 1}


def test_a_walk_its_torques_and_the_sign_of_its_knee_need_one_reading_each(shared, tmp_path, capsys, count):
    words = ["replay", f"{RECORDING}_ik.mot", "--torques", f"{RECORDING}_id.sto", "--html", "walk.html"]
    folders = [None, shared, None, shared, None, tmp_path]
    assert main([str(f / w) if f else w for f, w in zip(folders, words, strict=True)]) == 0
    assert (count["subject01_walk1_ik.mot"], count["subject01_walk1_id.sto"]) == (1, 1)


@pytest.mark.parametrize("name", [WALK, f"{RECORDING}.trc", f"{RECORDING}_ik.mot"])
def test_a_study_reads_a_recording_once_for_its_walk(shared, count, unsolved, name):
    assert solve(Case(gait="a", body=None, parts=(), path=str(shared / name))).failure == ""
    assert all(n == 1 for n in count.values())


def test_an_opened_file_serves_every_function_without_being_read_again(shared, count, unsolved):
    file = open_trial(shared / WALK)
    assert not is_markers(file)
    assert len(load_gait(file).time) <= len(load_markers(file).time)
    assert load_torques(file).tau.shape[1] == 12
    assert load_forces(file)[0].name == load_markers(file).plates[0].name
    assert load_walk(file).marker_set == "plug-in-gait"
    assert count == {"HC036A10_walk.c3d": 1, "child process": 1}


def test_what_a_file_does_not_hold_is_refused_by_name(shared, tmp_path):
    table = tmp_path / "walk.csv"
    table.write_text("time_s\n0\n1\n")
    file = open_trial(table)
    for load, match in (
        (load_markers, "walk.csv: holds no markers"),
        (load_forces, "walk.csv: holds no ground reaction forces"),
        (load_torques, "no torques"),
    ):
        with pytest.raises(FormatError, match=match):
            load(file)
    trial = open_trial(shared / f"{RECORDING}.trc")
    with pytest.raises(FormatError, match="holds no joint torques"):
        load_torques(trial)
    with pytest.raises(FormatError, match="markers, not angles"):
        load_gait(trial)
    with pytest.raises(FormatError, match=r"'.docx'; a gait file ends in .*\.csv.*\.trc"):
        open_trial(tmp_path / "walk.docx")


def test_lists_that_are_kept_apart_for_quick_imports_are_the_same():
    assert set(PRESETS) == set(SIGN_PRESETS)
    assert {name for name in {*FORMATS, *MARKER_FORMATS} if trials.may_hold_markers(Path(f"a{name}"))} == set(
        MARKER_FORMATS
    )

"""Our CSV brings back what was saved, and a wrong file is refused with file, line and reason."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from exo_pin import files
from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError
from exo_pin.formats import FORMATS, load_gait, save_gait
from exo_pin.gait import Event, Gait, normative_gait

ROUND_TRIP = 1e-12  # [rad, m, s] the promise; degrees and back cost about 1e-16


@pytest.fixture
def walk():
    return normative_gait("free", samples=20)


@pytest.fixture
def saved(walk, tmp_path):
    """A good file and its lines; tests damage the lines."""
    path = tmp_path / "walk.csv"
    save_gait(walk, path)
    lines = path.read_text().splitlines()
    header = next(i for i, line in enumerate(lines) if line.startswith("time_s"))
    return path, lines, header


def refused(path, lines, match, line=None):
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(FormatError, match=match) as caught:
        load_gait(path)
    assert caught.value.line == line
    assert str(path) in str(caught.value)


def same(a, b):
    np.testing.assert_allclose(a.time, b.time, atol=ROUND_TRIP)
    np.testing.assert_allclose(a.q, b.q, atol=ROUND_TRIP)
    assert (a.base is None) == (b.base is None)
    if a.base is not None:
        np.testing.assert_allclose(a.base, b.base, atol=ROUND_TRIP)
    assert (a.events, a.periodic, a.source) == (b.events, b.periodic, b.source)


def test_a_saved_walk_comes_back(walk, saved):
    same(load_gait(saved[0]), walk)


@given(
    q=arrays(float, (3, 12), elements=st.floats(-np.pi, np.pi)),
    steps=arrays(float, 3, elements=st.floats(1e-3, 1e3)),
    source=st.text(),
    note=st.text(),
)
def test_any_walk_comes_back_with_its_words(tmp_path_factory, q, steps, source, note):
    path = tmp_path_factory.getbasetemp() / "any.csv"
    time = np.cumsum(steps)
    gait = Gait(time, q, events=[Event(time[1], "toe_off", "right", note)], source=source)
    save_gait(gait, path)
    same(load_gait(path), gait)


def test_columns_may_stand_in_any_order_and_lines_may_end_as_on_windows(walk, tmp_path):
    path = tmp_path / "other.CSV"
    save_gait(Gait(walk.time, walk.q), path)
    rows = [line.split(",")[::-1] for line in path.read_text().splitlines() if not line.startswith("#")]
    path.write_bytes(b"\xef\xbb\xbf" + "\r\n".join(map(",".join, rows)).encode())
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q, atol=ROUND_TRIP)
    assert back.source == "other.CSV"
    assert not back.periodic


def test_missing_joints_are_named_and_never_taken_as_zero(saved):
    path, lines, header = saved
    names = lines[header].split(",")
    for gone in ("right_knee_flexion_deg", "pelvis_qz"):
        k = names.index(gone)
        cut = [",".join(c for i, c in enumerate(line.split(",")) if i != k) for line in lines[header:]]
        refused(path, cut, f"missing column: {gone}", 1)
    refused(path, ["time_s", "0", "1"], "missing columns: left_hip_flexion_deg, left_hip_adduction_deg", 1)


def test_unknown_and_repeated_columns_are_refused_with_a_hint(saved):
    path, lines, header = saved
    other = lines.copy()
    other[header] = other[header].replace("left_knee_flexion_deg", "left_knee_flexion")
    refused(path, other, "'left_knee_flexion'; did you mean 'left_knee_flexion_deg'", header + 1)
    other[header] = lines[header].replace("right_knee_flexion_deg", "left_knee_flexion_deg")
    refused(path, other, "missing column: right_knee_flexion_deg", header + 1)
    doubled = [lines[header] + ",time_s", *(line + ",0" for line in lines[header + 1 :])]
    refused(path, doubled, "'time_s' occurs more than once", 1)


def test_wrong_cells_are_refused_with_their_line(saved):
    path, lines, header = saved
    for value, match in (
        ("abc", "left_hip_flexion_deg is 'abc', expected a number"),
        ("", "is '', expected a number"),
        ("1_0", "expected a number"),
        ("nan", "is nan: expected a finite number"),
        ("inf", "is inf: expected a finite number"),
        ("1e999", "expected a finite number"),
        ("200", "more than half a turn; expected degrees"),
    ):
        cells = lines[header + 3].split(",")
        cells[1] = value
        refused(path, [*lines[: header + 3], ",".join(cells), *lines[header + 4 :]], match, header + 4)


def test_ragged_short_and_empty_files_are_refused(saved):
    path, lines, header = saved
    refused(path, [*lines[:-1], lines[-1] + ",7"], "21 values, but the header has 20 columns", len(lines))
    refused(path, [*lines[:-2], "", lines[-1][:9]], "1 values, but the header", len(lines))
    refused(path, lines[: header + 1], "no rows")
    refused(path, lines[: header + 2], "only one row", header + 2)
    refused(path, lines[:header], "empty")
    refused(path, [], "empty")


def test_time_that_does_not_increase_is_refused_with_its_line(saved):
    path, lines, _ = saved
    refused(path, [*lines, lines[-1]], "time_s does not increase", len(lines) + 1)


def test_semicolons_are_recognised(saved):
    path, lines, header = saved
    refused(path, [line.replace(",", ";") for line in lines[header:]], "separated by semicolons", 1)


def test_a_quaternion_that_is_no_rotation_is_refused(saved):
    path, lines, _ = saved
    cells = lines[-1].split(",")
    cells[-4] = "1.1"
    refused(
        path,
        [*lines[:-1], ",".join(cells)],
        "pelvis_qw is 1.1: its quaternion is not of length 1",
        len(lines),
    )


def test_malformed_notes_are_refused_with_their_line(saved):
    path, lines, _ = saved
    for note, match in (
        ("# periodic: maybe", "periodic is 'maybe', expected true or false"),
        ("# event: soon toe_off left", "expected 'time kind side'"),
        ("# event: 0.1 toe_off", "side is ''"),
        ("# event: 0.1 landing left", "kind is 'landing'"),
        ('# source: "open', "quoted text is malformed"),
    ):
        refused(path, [note, *lines], match, 1)
    refused(path, ["# event: 99 toe_off left", *lines], "outside the walk")


def test_comments_and_sources_without_quotes_are_for_people(saved):
    path, lines, header = saved
    path.write_text("\n".join(["# Note: made by hand", "# source: our laboratory", *lines[header:]]))
    assert load_gait(path).source == "our laboratory"


def test_what_is_no_text_file_is_refused(tmp_path):
    binary, latin = tmp_path / "binary.csv", tmp_path / "latin.csv"
    binary.write_bytes(bytes(range(256)))
    latin.write_bytes("time_s\n# Größe\n".encode("latin-1"))
    for path, match in (
        (binary, "zero bytes"),
        (latin, "latin.csv:2: not UTF-8"),
        (tmp_path, "a folder; a gait file ends in .csv"),
        (tmp_path / "none.csv", "no such file"),
        (tmp_path / "walk.xlsx", "unknown kind of file '.xlsx'"),
        (tmp_path / ("x" * 300 + ".csv"), "no such file|cannot be read"),
        ("zero\0byte.csv", "no such file|cannot be read"),
    ):
        with pytest.raises(FormatError, match=match):
            load_gait(path)
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    with pytest.raises(FormatError, match="a folder"):
        load_gait(folder)


def test_a_preset_of_opensim_signs_is_refused_for_our_own_format(saved):
    with pytest.raises(FormatError, match="no header line with the mapped columns"):
        load_gait(saved[0], preset="opensim-gait2392")


def test_files_beyond_the_cap_are_neither_read_nor_written(walk, saved, monkeypatch):
    before = saved[0].read_bytes()
    monkeypatch.setattr(files, "LARGEST_FILE", 1000)
    with pytest.raises(FormatError, match="larger than"):
        load_gait(saved[0])
    with pytest.raises(FormatError, match="larger than"):
        save_gait(walk, saved[0])
    assert saved[0].read_bytes() == before


def test_absurd_numbers_of_columns_and_events_are_refused_at_once(saved):
    path, lines, header = saved
    many = 200_000  # what costs the square of this would take an hour
    refused(
        path, [lines[header] + ",time_s" * many, lines[-1] + ",0" * many], "'time_s' occurs more than once", 1
    )
    refused(path, ["# event: 0 toe_off left"] * many + lines, "events; at most 100000", 100_001)


def test_a_failed_write_leaves_the_old_file_and_no_other(walk, saved, monkeypatch):
    path = saved[0]
    before = path.read_bytes()

    def broken(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", broken)
    with pytest.raises(FormatError, match="cannot be written: No space left"):
        save_gait(walk, path)
    assert path.read_bytes() == before
    assert os.listdir(path.parent) == [path.name]


def test_writing_follows_links_keeps_permissions_and_spares_pipes(walk, tmp_path):
    real, link = tmp_path / "real.csv", tmp_path / "link.csv"
    real.touch()
    real.chmod(0o640)
    link.symlink_to(real)
    save_gait(walk, link)
    assert link.is_symlink()
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    same(load_gait(link), walk)
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)  # a writer would wait for it
    save_gait(walk, pipe)
    assert os.read(reader, 2**20) == real.read_bytes()
    os.close(reader)
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_what_cannot_be_written_is_refused(walk, tmp_path):
    for path, match in (
        (tmp_path / "no" / "folder.csv", "cannot be written"),
        (tmp_path / "walk.txt", "unknown kind of file '.txt'"),
    ):
        with pytest.raises(FormatError, match=match):
            save_gait(walk, path)
    (tmp_path / "dir.csv").mkdir()
    with pytest.raises(FormatError, match="cannot be written"):
        save_gait(walk, tmp_path / "dir.csv")


@pytest.mark.parametrize(
    "suffix", [suffix for suffix, entry in FORMATS.items() if entry.write and suffix != ".c3d"]
)
def test_every_format_brings_back_the_walk(walk, tmp_path, suffix):
    for gait in (walk, Gait(walk.time + 0.4, walk.q, source="still pelvis")):
        save_gait(gait, tmp_path / f"walk{suffix}")
        same(load_gait(tmp_path / f"walk{suffix}"), gait)
    assert len(JOINTS) == gait.q.shape[1]


def test_somebody_elses_table_and_files_without_motion_say_what_to_do(tmp_path):
    (tmp_path / "poses.csv").write_text("time,pelvis_px,pelvis_py\n0,1,2\n1,1,2\n")
    with pytest.raises(FormatError, match=r"columns \(time, pelvis_px.* are not ours .*needs a mapping"):
        load_gait(tmp_path / "poses.csv")
    for name, match in (("a.osim", "holds no motion; name it as the model"), ("a.xml", "a setup holds no")):
        with pytest.raises(FormatError, match=match):
            load_gait(tmp_path / name)

"""Marker files: metres, gaps, honest headers; what is wrong is named with its line."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.errors import FormatError, GaitError, UnknownNameError
from exo_pin.formats import Markers, load_gait, load_markers, open_trial
from exo_pin.gait.trial import UP_AXES, to_z_up

NAMES = ["Anna:LASI", "RASI"]
EXACT = 1e-15


def trc(names=NAMES, frames=3, unit="mm", n=None, k=None, cell=lambda i, j: f"{i * 10 + j}"):
    head = ["PathFileType\t4\t(X/Y/Z)\twalk.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits"]
    head += [f"60\t60\t{frames if n is None else n}\t{len(names) if k is None else k}\t{unit}"]
    head += ["Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t", "\t\tX1\tY1\tZ1\tX2\tY2\tZ2", ""]
    rows = [
        "\t".join([str(i + 1), str(i / 60), *(cell(i, j) for j in range(3 * len(names)))])
        for i in range(frames)
    ]
    return "\n".join([*head, *rows, ""])


@pytest.fixture
def path(tmp_path):
    return tmp_path / "walk.trc"


def refused(path, text, match, line=None):
    path.write_text(text)
    with pytest.raises(FormatError, match=match) as caught:
        load_markers(path)
    assert caught.value.line == line


@pytest.mark.parametrize(("unit", "scale"), [("mm", 1e-3), ("cm", 1e-2), ("m", 1.0)])
def test_positions_are_metres_and_prefixes_are_dropped(path, unit, scale):
    path.write_text(trc(unit=unit))
    trial = load_markers(path)
    assert trial.names == ("LASI", "RASI")
    np.testing.assert_allclose(trial.of("RASI")[1], scale * np.array([13, 14, 15]), atol=EXACT)
    np.testing.assert_allclose(trial.time, np.arange(3) / 60)
    assert trial.up == ""


def test_the_users_unit_goes_before_the_headers_and_that_is_said(path):
    path.write_text(trc(unit="mm"))
    stated = open_trial(path).with_length_unit("m").markers()
    np.testing.assert_allclose(stated.position, 1000 * load_markers(path).position, atol=EXACT)
    assert "the header says mm" in stated.remarks[0]
    assert open_trial(path).with_length_unit("mm").markers().remarks == ()


def test_rows_that_repeat_the_row_above_are_left_out(path):
    path.write_text(trc())
    expected = load_markers(path)
    lines = trc(n=4).splitlines()
    path.write_text("\n".join([*lines[:7], lines[6], *lines[7:]]))
    trial = load_markers(path)
    np.testing.assert_array_equal(trial.position, expected.position)
    assert "rows that repeat time and values of the row above: 1, left out" in trial.remarks
    refused(path, "\n".join([*lines[:7], lines[6] + "9", *lines[7:]]), "does not increase")


def test_empty_cells_are_markers_that_were_not_seen(path):
    path.write_text(trc(cell=lambda i, j: "" if (i, j // 3) in ((1, 0), (2, 1)) else "7"))
    trial = load_markers(path)
    gaps = np.isnan(trial.position).all(axis=2)
    np.testing.assert_array_equal(gaps, [[False, False], [True, False], [False, True]])


def test_zeros_and_nan_are_markers_that_were_not_seen_too(path):
    path.write_text(trc(cell=lambda i, j: ("0.000" if i else "NaN") if j < 3 else "7"))
    np.testing.assert_array_equal(np.isnan(load_markers(path).of("LASI")), True)
    path.write_text(trc(cell=lambda i, j: "0" if j == 1 else "7"))
    assert not np.isnan(load_markers(path).position).any()  # one zero is a place like any other


def test_decimal_commas_and_words_for_units_are_understood(path):
    path.write_text(trc(unit="Meters", cell=lambda i, j: "1,5"))
    np.testing.assert_array_equal(load_markers(path).position, 1.5)


@pytest.mark.parametrize("stated", [900, 2, "9" * 14, "", "many"])
def test_a_number_of_frames_of_another_trial_is_a_remark(path, stated):
    path.write_text(trc(n=stated))
    trial = load_markers(path)
    assert len(trial) == 3
    (remark,) = trial.remarks
    assert remark.startswith("the header's NumFrames is ")
    assert remark.endswith("the file holds 3 frames: all of these are read")


def test_a_number_of_markers_that_names_and_axes_contradict_is_a_remark(path):
    path.write_text(trc(k=3))
    trial = load_markers(path)
    assert trial.names == ("LASI", "RASI")
    assert trial.remarks == ("the header's NumMarkers is 3, the file holds 2 markers: all of these are read",)
    refused(path, trc(k=3).replace("X2\tY2\tZ2", ""), "header says 3 markers, the line of names has 2", 4)


PADDED = [
    lambda text: text.replace("60\t60\t3\t2\tmm", "  60.0\t\t  60.0\t\t  3\t\t  2\t\t mm\t  60.0\t  1\t  3"),
    lambda text: text.replace("60\t60\t3\t2\tmm", "60 60 3 2 mm"),
    lambda text: text.replace("Time\tAnna:LASI\t\t\tRASI\t\t", "Times\t\tAnna:LASI\t\tRASI"),
    lambda text: text.replace("Time\tAnna:LASI\t\t\tRASI", "Time (s)\tAnna:LASI\tRASI"),
    lambda text: text.replace("\t\tX1", "\t\t\tX1"),
    lambda text: text.replace("CameraRate\t", "CameraRate\t\t").replace("\tmm", "\tmm\t\t"),
    lambda text: text.replace("PathFileType\t4", "PathFileType  4"),
]  # fmt: skip


@pytest.mark.parametrize("change", PADDED)
def test_headers_are_read_however_tabs_pad_them(path, change):
    text = trc()
    path.write_text(text)
    usual = load_markers(path)
    assert change(text) != text
    path.write_text(change(text))
    trial = load_markers(path)
    assert (trial.names, trial.remarks, trial.unit) == (usual.names, (), "mm")
    np.testing.assert_array_equal(trial.position, usual.position)


@pytest.mark.parametrize("names", [["A", "", "C"], ["", "B", "C"], ["A", "B", ""]])
def test_a_marker_without_a_name_keeps_its_columns(path, names):
    path.write_text(trc(names).replace("Z2", "Z2\tX3\tY3\tZ3"))
    trial = load_markers(path)
    assert trial.names == tuple(name for name in names if name)
    for name in trial.names:
        np.testing.assert_allclose(trial.of(name)[0], 1e-3 * (3 * names.index(name) + np.arange(3)))


def test_what_a_header_says_wrong_is_refused(path):
    text = trc(k="").replace("X1\tY1\tZ1\tX2\tY2\tZ2", "")
    refused(path, text, "header says no number of markers, the line of names has 2", 4)
    refused(path, trc().replace("Time", "Mark"), "expected Frame#, Time and the markers' names", 4)
    refused(path, trc(unit="inch"), "Units is 'inch'; mm, cm and m are accepted", 3)
    refused(path, "Coordinates\nendheader\n", "first line is not 'PathFileType", 1)
    refused(path, trc(frames=0), "no frames|shape")
    refused(path, trc(cell=lambda i, j: "x" if i else "1"), "'x' is no number", 8)
    refused(path, trc(cell=lambda i, j: "inf" if i else "1"), "inf is no coordinate", 8)
    refused(path, trc(cell=lambda i, j: "1\t1"), "values, but 2 markers need 8", 7)


def test_a_marker_file_is_no_gait_and_says_what_to_do(path):
    path.write_text(trc())
    with pytest.raises(FormatError, match=r"holds markers, not angles; exo_pin\.markers\.load_walk"):
        load_gait(path)
    with pytest.raises(FormatError, match="a marker trial ends in"):
        load_markers(path.with_suffix(".npz"))


@pytest.mark.parametrize("up", UP_AXES)
def test_any_vertical_becomes_z_by_a_rotation(up):
    R = to_z_up(up)
    axis = np.eye(3)["xyz".index(up[1])] * (1 if up[0] == "+" else -1)
    np.testing.assert_array_equal(R @ axis, [0, 0, 1])
    np.testing.assert_array_equal(R @ R.T, np.eye(3))
    assert np.linalg.det(R) == pytest.approx(1)


def test_markers_are_checked_at_the_door():
    time, position = [0, 1], np.zeros((2, 1, 3))
    with pytest.raises(GaitError, match="more than once"):
        Markers(time, ("a", "a"), np.zeros((2, 2, 3)))
    with pytest.raises(GaitError, match="position has shape"):
        Markers(time, ("a", "b"), position)
    with pytest.raises(UnknownNameError, match="axis"):
        Markers(time, ("a",), position, up="z")
    with pytest.raises(UnknownNameError, match="marker"):
        Markers(time, ("a",), position).of("b")


def test_markers_take_other_names_and_push_out_who_had_them():
    trial = Markers([0, 1], ("a", "b", "c"), np.arange(18.0).reshape(2, 3, 3))
    named = trial.renamed({"a": "LASI", "b": "c"})
    assert named.names == ("LASI", "c")
    np.testing.assert_array_equal(named.of("c"), trial.of("b"))
    with pytest.raises(UnknownNameError, match="marker 'd'"):
        trial.renamed({"d": "LASI"})


def test_the_recording_is_read(shared):
    trial = load_markers(shared / "opensim_subject01_walk/subject01_walk1.trc")
    assert (len(trial), len(trial.names)) == (151, 41)
    assert trial.time[-1] == pytest.approx(2.5)
    assert 0.9 < trial.of("R.ASIS")[:, 1].mean() < 1.2  # y is up [m]

"""What laboratories write into C3D files: units, events, mean cycles, single frames. Files are made here."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.cli import main
from exo_pin.cli.opened_files import OpenedFiles
from exo_pin.errors import FormatError
from exo_pin.formats import is_markers, load_forces, load_gait, load_markers, open_trial, save_gait
from exo_pin.formats.c3d import header
from exo_pin.formats.c3d.content import C3dPlate
from exo_pin.formats.c3d.plates import force_plates
from exo_pin.gait import Event, Gait, normative_gait
from exo_pin.markers import load_walk


@pytest.fixture(scope="module")
def walk():
    gait = normative_gait("free", samples=101).resampled(100).repeated(2)
    return Gait(np.arange(len(gait)) / 100, gait.q, base=gait.base, events=gait.events[:4])


@pytest.fixture
def edited(walk, tmp_path):
    """A function that writes the walk and changes parameters: `POINT__UNITS=value`."""
    import ezc3d

    def write(gait=walk, **parameters):
        path = tmp_path / "walk.c3d"
        save_gait(gait, path)
        file = ezc3d.c3d(str(path))
        for name, value in parameters.items():
            group, _, parameter = name.partition("__")
            file.add_parameter(group, parameter, value)
        file.write(str(path))
        return path

    return write


@pytest.mark.parametrize("unit", ["MM", "millimeters", "Millimetres", "mm ", "[mm]"])
def test_words_for_millimetres_are_millimetres(walk, edited, unit):
    back = load_gait(edited(POINT__UNITS=[unit]))
    np.testing.assert_allclose(back.base[:, :3, 3], walk.base[:, :3, 3], atol=1e-6)
    assert back.remarks == ()


@pytest.mark.parametrize("unit", [[""], ["mete"], ["furlong"], []])
def test_without_a_unit_of_length_angles_are_read_and_the_rest_once_the_unit_is_stated(walk, edited, unit):
    path = edited(POINT__UNITS=unit)
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q, atol=1e-6)
    assert back.base is None
    assert "left out" in back.remarks[0]
    with pytest.raises(FormatError, match="--units mm, cm or m"):
        load_markers(path)
    stated = load_gait(open_trial(path).with_length_unit("mm"))
    np.testing.assert_allclose(stated.base[:, :3, 3], walk.base[:, :3, 3], atol=1e-6)
    assert stated.remarks == ()


def test_a_stated_unit_goes_before_the_files_and_that_is_said(walk, edited):
    path = edited(POINT__UNITS=["cm"])
    stated = load_gait(open_trial(path).with_length_unit("mm"))
    np.testing.assert_allclose(stated.base[:, :3, 3], walk.base[:, :3, 3], atol=1e-6)
    assert "POINT:UNITS is another unit" in stated.remarks[0]


def test_the_command_line_takes_a_unit_of_length_for_marker_trials_only(edited, tmp_path, capsys):
    path = edited(POINT__UNITS=[""])
    assert main(["info", str(path), "--units", "mm"]) == 0
    assert "pelvis moves" in capsys.readouterr().out
    assert main(["info", str(path)]) == 0
    assert "note: POINT:UNITS is ''" in capsys.readouterr().err
    table = tmp_path / "walk.csv"
    save_gait(load_gait(path), table)
    assert main(["info", str(table), "--units", "mm"]) == 2
    assert "is for marker trials" in capsys.readouterr().err
    assert main(["info", "free", "--units", "mm"]) == 2


def test_forces_beside_a_trial_keep_their_own_unit_of_length(shared):
    """`--units mm` is the trial's; a .mot is in metres by definition."""
    forces = shared / "opensim_subject01_walk/subject01_walk1_grf.mot"
    files = OpenedFiles()
    files.length_unit = "mm"
    assert load_forces(files.open(forces, "forces"))[0].point.max() == load_forces(forces)[0].point.max()
    with pytest.raises(FormatError, match="in metres"):
        files.open(shared / "opensim_subject01_walk/subject01_walk1_ik.mot")


def test_angles_without_a_unit_are_judged_by_their_size(walk, edited):
    back = load_gait(edited(POINT__ANGLE_UNITS=["?"]))
    np.testing.assert_allclose(back.q, walk.q, atol=1e-6)
    assert "degrees" in back.remarks[0]
    small = Gait(walk.time, walk.q * 0.01, base=walk.base)
    path = edited(small, POINT__ANGLE_UNITS=["?"])
    with pytest.raises(FormatError, match="--units deg or rad"):
        load_gait(path)


def test_events_that_a_file_has_are_kept_or_counted(walk, edited):
    labels = ["LHS", "RTO", "RHS", "jump", "LTO"]
    times = np.array([[0, 0, 0, 0, 9], [0.1, 0.2, 0.6, 0.7, 0]], dtype=float)
    for contexts in ([], [""], ["Left"]):
        path = edited(EVENT__LABELS=labels, EVENT__CONTEXTS=contexts, EVENT__TIMES=times)
        back = load_gait(path)
        assert [(e.time, e.side) for e in back.events] == [(0.1, "left"), (0.2, "right"), (0.6, "right")]
        assert any("1 event is not understood" in remark and "jump" in remark for remark in back.remarks)
        assert any("1 event lies outside the trial" in remark for remark in back.remarks)


def test_a_mean_cycle_is_refused_with_what_the_file_says_of_its_speed(walk, edited):
    cycle = walk.resampled(100)
    ends = [Event(t, "heel_strike", side) for side in ("left", "right") for t in cycle.time[[0, -1]]]
    mean = Gait(cycle.time, cycle.q, events=ends)
    path = edited(
        mean,
        ANALYSIS__NAMES=["Walking Speed", "Stride Time"],
        ANALYSIS__UNITS=["m/s", "s"],
        ANALYSIS__VALUES=[0.7, 1.54],
    )
    with pytest.raises(FormatError, match=r"a mean cycle .* Walking Speed 0\.7 m/s, Stride Time 1\.54 s"):
        load_gait(path)
    assert len(load_gait(edited(Gait(cycle.time, cycle.q, events=ends[:3]))).events) == 3


def test_events_of_the_header_are_read(walk, tmp_path):
    path = tmp_path / "old.c3d"
    save_gait(Gait(walk.time, walk.q, base=walk.base), path)
    data = bytearray(path.read_bytes())
    data[298:302] = np.array([12345, 2], "<u2").tobytes()
    data[304:312] = np.array([0.25, 0.5], "<f4").tobytes()
    data[396:404] = b"RHS LTO "
    path.write_bytes(data)
    assert header.check(path, bytes(data)).header_events == 2
    back = load_gait(path)
    assert [(e.time, e.side, e.kind) for e in back.events] == [
        (0.25, "right", "heel_strike"),
        (0.5, "left", "toe_off"),
    ]
    assert "header" in back.remarks[0]


def test_one_frame_is_no_walk_and_says_what_it_is_good_for(walk, tmp_path):
    import ezc3d

    path = tmp_path / "standing.c3d"
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["LASI", "RASI"]
    file.add_parameter("POINT", "UNITS", ["m"])
    file["data"]["points"] = np.ones((4, 2, 1))
    file.write(str(path))
    assert is_markers(path)
    assert load_markers(path).position.shape == (1, 2, 3)
    with pytest.raises(FormatError, match="standing trial"):
        load_walk(path)


def test_a_loaded_plate_with_a_centre_of_pressure_beyond_10_km_is_left_out():
    force = np.tile([0.0, 0, 700], (5, 1))
    units = ("N", "Nmm", "mm")
    far = C3dPlate(force, np.full((5, 3), 1.1e7), force, units)
    unloaded = C3dPlate(0.01 * force, np.full((5, 3), np.inf), force, units)
    found = force_plates([far, unloaded], 1000, 0.0)
    assert [plate.name for plate in found.plates] == ["force plate 2"]
    assert np.isnan(found.plates[0].point).all()  # moment over no force is no place
    assert "force plate 1 has a centre of pressure more than 10000 m away" in found.remarks[0]


def test_plates_in_unknown_units_are_left_out_and_counted(edited):
    force = np.tile([0.0, 0, 700], (5, 1))
    known = C3dPlate(force, 1e3 * force, 1e3 * force, ("N", "N.mm", "MM"))
    pounds = C3dPlate(force, force, force, ("lbf", "lbf.in", "in"))
    found = force_plates([known, pounds], 1000, 2.0)
    assert [plate.name for plate in found.plates] == ["force plate 1"]
    np.testing.assert_allclose(found.plates[0].point, force)
    np.testing.assert_allclose(found.plates[0].moment, force)
    assert found.plates[0].time[[0, -1]] == pytest.approx([2, 2.004])
    assert "force plate 2 is in 'lbf'" in found.remarks[0]
    assert load_forces(edited()) == ()

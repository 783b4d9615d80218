"""Vicon Nexus exports: sections in any order, subjects, gaps, events, force plates; the same walk as C3D."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.cli import main
from exo_pin.errors import FormatError
from exo_pin.formats import is_markers, load_forces, load_gait, load_markers, save_gait
from exo_pin.gait import Event, Gait, normative_gait

EXACT = 1e-12  # [rad, m]
EVENTS = [
    "Events",
    "100",
    "Subject,Context,Name,Time (s),Description",
    'Anna,Left,Foot Strike,0.25,"The instant the heel strikes"',
    "Anna,Right,Foot Off,0.31,",
    "Anna,General,Clap,0.4,",
    "",
]


@pytest.fixture
def walk():
    gait = normative_gait("free", samples=41).resampled(60)
    return Gait(np.arange(60) / 100, gait.q)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "Trial 01.csv"


@pytest.mark.parametrize("sep", [",", ";", "\t"])
@pytest.mark.parametrize("first", [1, 79])
def test_model_outputs_are_read_with_the_frames_own_times(lab, path, walk, sep, first):
    path.write_text(lab.nexus(walk, first=first, sep=sep))
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q, atol=EXACT)
    np.testing.assert_allclose(back.time, (first - 1) / 100 + walk.time, atol=EXACT)


@pytest.mark.parametrize(
    ("sep", "rate"), [(",", "100 Hz"), (",", "100.0hz"), (";", "100,0"), (";", "100;;;;")]
)
def test_a_rate_may_have_its_unit_a_decimal_comma_and_empty_cells(lab, path, walk, sep, rate):
    path.write_text(lab.nexus(walk, sep=sep).replace("\n100\n", f"\n{rate}\n"))
    np.testing.assert_allclose(load_gait(path).time, walk.time, atol=EXACT)


def test_a_txt_with_tabs_and_blank_lines_and_marks_is_read_too(lab, tmp_path, walk):
    path = tmp_path / "walk.txt"
    path.write_bytes(b"\xef\xbb\xbf\r\n\t\t\r\n" + lab.nexus(walk, sep="\t").replace("\n", "\r\n").encode())
    np.testing.assert_allclose(load_gait(path).q, walk.q, atol=EXACT)


def test_the_same_walk_as_c3d_and_as_export_is_the_same(lab, path, tmp_path, walk):
    events = (Event(0.25, "heel_strike", "left"), Event(0.31, "toe_off", "right"))
    save_gait(Gait(walk.time, walk.q, events=events), tmp_path / "walk.c3d")
    path.write_text(lab.nexus(walk, more=EVENTS))
    one, other = load_gait(tmp_path / "walk.c3d"), load_gait(path)
    np.testing.assert_allclose(one.q, other.q, atol=1e-6)  # 32 bits in C3D
    assert [(e.time, e.kind, e.side) for e in one.events] == [(e.time, e.kind, e.side) for e in other.events]
    assert "1 event is not understood" in " ".join(other.remarks)


def test_gaps_and_sections_of_other_frames_leave_the_longest_run(lab, path, walk):
    outputs = {name: values.copy() for name, values in lab.pig(walk).items()}
    outputs["LKneeAngles"][:7] = np.nan
    markers = {"LASI": np.full((70, 3), 500.0), "RASI": np.full((70, 3), 400.0)}
    lines = lab.nexus_section("Trajectories", 100, np.arange(1, 71), markers, "mm")
    lines += lab.nexus_section("Model Outputs", 100, np.arange(1, 61), outputs, "deg")
    path.write_text("\n".join(lines))
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q[7:], atol=EXACT)
    assert "frames 7 to 59 of 70" in back.source
    np.testing.assert_allclose(load_markers(path).of("RASI"), 0.4)
    assert not is_markers(path)


def test_trajectories_alone_are_a_marker_trial(lab, path, walk, capsys):
    path.write_text(
        "\n".join(lab.nexus_section("Trajectories", 100, range(1, 31), {"LASI": np.ones((30, 3))}, "mm"))
    )
    assert is_markers(path)
    with pytest.raises(FormatError, match="no model angles LAnkleAngles"):
        load_gait(path)
    assert main(["info", str(path)]) == 2
    assert "marker" in capsys.readouterr().err


DEVICES = ["Devices", "1000", ",,Plate 1 - Force,,,Plate 1 - Moment,,,Plate 1 - CoP,,",
           "Frame,Sub Frame,Fx,Fy,Fz,Mx,My,Mz,Cx,Cy,Cz", ",,N,N,N,N.mm,N.mm,N.mm,mm,mm,mm"]  # fmt: skip


def test_force_plates_have_ten_samples_a_frame_and_point_upwards(lab, path, walk):
    rows = [f"{f},{s},1,2,-700,0,0,0,250,-100,0" for f in range(1, 61) for s in range(10)]
    path.write_text("\n".join([*DEVICES, *rows, "", lab.nexus(walk)]))
    (plate,) = load_forces(path)
    np.testing.assert_allclose(plate.time, np.arange(600) / 1000, atol=EXACT)
    np.testing.assert_allclose(plate.force[0], [-1, -2, 700])
    np.testing.assert_allclose(plate.point[0], [0.25, -0.1, 0])
    assert "the sign is turned" in load_gait(path).remarks[0]
    path.write_text(
        "\n".join([*DEVICES, *[row.replace("-700", "1e308") for row in rows], "", lab.nexus(walk)])
    )
    with pytest.raises(FormatError, match="no number"):
        load_forces(path)


def test_a_plate_with_a_centre_of_pressure_beyond_10_km_is_left_out(lab, path, walk):
    rows = [f"{f},{s},1,2,-700,0,0,0,{{}},-100,0" for f in range(1, 61) for s in range(10)]
    path.write_text("\n".join([*DEVICES, *[row.format("2e7") for row in rows], "", lab.nexus(walk)]))
    with pytest.raises(FormatError):
        load_forces(path)
    assert "a centre of pressure more than 10000 m away and is left out" in " ".join(load_gait(path).remarks)
    unloaded = [row.format("2e7").replace("-700", "1") for row in rows[:300]]
    loaded = [row.format("250") for row in rows[300:]]
    path.write_text("\n".join([*DEVICES, *unloaded, *loaded, "", lab.nexus(walk)]))
    (plate,) = load_forces(path)  # where nothing stands on the plate it means nothing
    assert np.isnan(plate.point[:300, 0]).all()
    np.testing.assert_allclose(plate.point[300:, 0], 0.25)


def _loads(reference, free):
    """Force [N], moment about a point [N mm], and centre of pressure [mm] of a step `(50, 3)` each."""
    s = np.linspace(0.1, 0.9, 50)
    force = np.stack([80 * np.cos(np.pi * s), 20 * np.sin(7 * s), 700 * np.sin(np.pi * s)], axis=1)
    point = np.stack([200 + 250 * s, -100 + 10 * s, 0 * s], axis=1)
    moment = np.cross(point - reference, force) + np.stack([0 * s, 0 * s, 1e3 * free(s)], axis=1)
    return force, moment, point


@pytest.mark.parametrize("reference", [(0, 0, 0), (232, -254, 0), (232, -254, -41)])
@pytest.mark.parametrize("sign", [1, -1])
def test_free_moments_follow_from_moments_about_any_point(lab, path, walk, reference, sign):
    force, moment, point = _loads(np.array(reference), lambda s: 5 * np.sin(6 * s))
    rows = np.hstack([sign * force, sign * moment, point])
    lines = [f"{k // 10 + 1},{k % 10},{','.join(map(repr, row.tolist()))}" for k, row in enumerate(rows)]
    path.write_text("\n".join([*DEVICES, *lines, "", lab.nexus(walk)]))
    (plate,) = load_forces(path)
    np.testing.assert_allclose(plate.force, force)
    np.testing.assert_allclose(plate.moment[:, 2], 5 * np.sin(6 * np.linspace(0.1, 0.9, 50)), atol=1e-9)
    np.testing.assert_array_equal(plate.moment[:, :2], 0)
    assert "free moments" not in " ".join(load_gait(path).remarks)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("Mx,My,Mz", "Nx,Ny,Nz", "no moments Mx, My, Mz"),
        ("N.mm", "lbf.ft", "moments in 'lbf.ft'"),
        ("Mx,My,Mz,Cx,Cy,Cz", "Mx,My,Mz,Cx,Cy,Cz", "do not agree"),
    ],
)
def test_free_moments_that_are_not_known_are_said(lab, path, walk, old, new, why):
    force, moment, point = _loads(np.zeros(3), np.cos)
    moment = moment[:, [1, 0, 2]] if old == new else moment  # in other axes
    rows = np.hstack([force, moment, point])
    lines = [f"{k // 10 + 1},{k % 10},{','.join(map(repr, row.tolist()))}" for k, row in enumerate(rows)]
    head = [line.replace(old, new) for line in DEVICES]
    path.write_text("\n".join([*head, *lines, "", lab.nexus(walk)]))
    (plate,) = load_forces(path)
    np.testing.assert_array_equal(plate.moment, 0)
    (said,) = [text for text in load_gait(path).remarks if "free moments" in text]
    assert why in said


def test_two_subjects_are_said(lab, path, walk):
    outputs = lab.pig(walk)
    twice = {f"Anna:{k}": v for k, v in outputs.items()} | {f"Ben:{k}": v + 1 for k, v in outputs.items()}
    path.write_text("\n".join(lab.nexus_section("Model Outputs", 100, range(1, 61), twice, "deg", prefix="")))
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q, atol=EXACT)
    assert "LHipAngles of Ben is left out" in " ".join(back.remarks)


@pytest.mark.parametrize(
    ("old", "new", "match"),
    [
        ("\n100\n", "\nfast\n", "no rate in Hz"),
        ("Frame,Sub", "Image,Sub", "expected Frame"),
        ("\n3,0,", "\n3,0,x", "is no number"),
        ("\n3,0,", "\n,0,", "without a frame number"),
        ("\n3,0,", "\n3,0,1,2,3,", "the line of axes has"),
        ("\n3,0,", "\n3e9,0,", "no number"),
        ("\n3,0,", "\n3e8,0,", "count up"),
        ("deg", "furlong", "no model angles"),
        ("LKnee", "LKnie", "no model angles LKneeAngles"),
    ],
)
def test_damaged_exports_are_refused_with_line_and_reason(lab, path, walk, old, new, match):
    path.write_text(lab.nexus(walk).replace(old, new))
    with pytest.raises(FormatError, match=match):
        load_gait(path)

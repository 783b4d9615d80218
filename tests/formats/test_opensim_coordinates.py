"""OpenSim files: signs, degrees, names and the pelvis are understood, and what is unclear is refused."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats import PRESETS, load_gait, save_gait
from exo_pin.formats.opensim.pelvis_axes import from_opensim, pelvis_joint, to_opensim
from exo_pin.formats.opensim.storage import read_storage
from exo_pin.gait import Gait, normative_gait
from exo_pin.gait.quaternions import rotations

OPENSIM_PRESETS = [name for name in PRESETS if name.startswith("opensim")]
ROUND_TRIP = 1e-12  # [rad, m]
FILE = 2e-7  # [rad, m] the recording and its poses carry 8 digits
GENERIC_OFFSET = np.array([-0.0707, -0.0661, 0])  # gait2392's mid-hip point in its pelvis
SIDES = ("r", "l")
COORDINATES = ["hip_flexion", "hip_adduction", "hip_rotation", "knee_angle", "ankle_angle", "subtalar_angle"]
NAMES = [f"{name}_{side}" for side in SIDES for name in COORDINATES]


def degrees(knee=1.0):
    """Five rows of time and twelve angles [deg] in the order of NAMES: a knee that bends to 60 degrees."""
    rows = np.arange(5 * 12).reshape(5, 12) / 10
    rows[:, [3, 9]] = knee * np.array([[5, 60], [20, 40], [60, 20], [40, 5], [5, 10]])
    return np.hstack([np.arange(5)[:, None] / 10, rows])


def storage(values, names=NAMES, header=("Coordinates", "version=1", "inDegrees=yes"), tail=""):
    rows = ["\t".join(f"{x:.10g}" for x in row) + tail for row in values]
    return "\n".join(
        [*(h + tail for h in header), "endheader" + tail, "\t".join(["time", *names]) + tail, *rows, ""]
    )


def refused(path, text, match, line=None, **more):
    path.write_text(text)
    with pytest.raises(FormatError, match=match) as caught:
        load_gait(path, **more)
    assert caught.value.line == line


@pytest.fixture
def path(tmp_path):
    return tmp_path / "walk.mot"


def test_units_by_the_user_win_where_the_numbers_agree(path):
    path.write_text(storage(degrees(), header=("name walk.mot", "datacolumns 13", "datarows 5")))
    given = load_gait(path, units="deg")
    path.write_text(storage(degrees()))
    np.testing.assert_array_equal(given.q, load_gait(path, units="deg").q)
    refused(path, storage(degrees()), "given as rad, but knee_angle_l reaches 60: degrees", units="rad")
    path.write_text(storage(degrees(), header=("x",)))
    with pytest.raises(UnknownNameError, match="unit of angles 'grad'"):
        load_gait(path, units="grad")


def test_each_coordinate_becomes_its_joint(path):
    path.write_text(storage(degrees()))
    gait = load_gait(path)
    np.testing.assert_allclose(np.degrees(gait.q), degrees()[:, [*range(7, 13), *range(1, 7)]], atol=1e-9)
    assert gait.base is None


def test_the_knee_is_positive_whatever_the_file_has_and_the_source_says_how(path):
    path.write_text(storage(degrees(knee=-1)))
    negative = load_gait(path)
    path.write_text(storage(degrees(knee=+1)))
    positive = load_gait(path)
    np.testing.assert_array_equal(negative.q, positive.q)
    assert "knee negative in flexion (inferred: 100 %" in negative.source
    assert "knee positive in flexion (inferred: 100 %" in positive.source
    assert "opensim-gait2392" in negative.source


def test_an_unclear_knee_needs_a_preset(path):
    both = degrees()
    both[:, 4] *= -1  # one knee each way
    refused(path, storage(both), "sign of the knee is not clear.*opensim-gait2392, opensim-rajagopal")
    straight = degrees(knee=0.2)
    refused(path, storage(straight), "bend less than 15 degrees")
    knees = [JOINTS.index("right_knee_flexion"), JOINTS.index("left_knee_flexion")]
    for name in OPENSIM_PRESETS:
        preset = PRESETS[name]
        gait = load_gait(path, preset=name)
        np.testing.assert_allclose(
            np.degrees(gait.q[:, knees]), preset.knee * straight[:, [4, 10]], atol=1e-9
        )
        assert "as told" in gait.source
    with pytest.raises(UnknownNameError, match="did you mean 'opensim-gait2392'"):
        load_gait(path, preset="opensim-gait2354")


def test_slight_hyperextension_does_not_hide_the_sign(path):
    values = degrees(knee=-1)
    values[0, 4] = 6.0  # 60 degrees one way, 6 the other: 91 %
    path.write_text(storage(values))
    assert load_gait(path).q[0, JOINTS.index("right_knee_flexion")] == pytest.approx(np.radians(-6))
    values[0, 4] = 7.0
    refused(path, storage(values), "not clear")


def test_radians_and_degrees_are_those_of_the_header(path):
    path.write_text(storage(degrees()))
    expected = load_gait(path).q
    values = degrees()
    values[:, 1:] = np.radians(values[:, 1:])
    path.write_text(storage(values, header=("Coordinates", "inDegrees = no")))
    np.testing.assert_allclose(load_gait(path).q, expected, atol=1e-9)
    assert load_gait(path).remarks == ()
    for header in ((), ("inDegrees=maybe",)):
        refused(path, storage(values, header=("Coordinates", *header)), "or that you give the units")


def test_long_names_speeds_and_old_headers_are_understood(path):
    path.write_text(storage(degrees()))
    expected = load_gait(path).q
    long = [f"/jointset/joint/{name}/value" for name in NAMES]
    more = [
        *long,
        "/jointset/knee_r/knee_angle_r/speed",
        "/jointset/p/knee_angle_r_beta/value",
        "/forceset/m/activation",
    ]
    values = np.hstack([degrees(), np.full((5, 3), 1e6)])
    header = ("name walk.mot", "datacolumns 16", "datarows 5", "inDegrees=yes")
    path.write_text(storage(values, more, header, tail="\t\t").replace("\n", "\r\n"))
    np.testing.assert_array_equal(load_gait(path).q, expected)


def test_a_damaged_table_is_refused(path):
    refused(path, storage(degrees())[:-9], "11 values, but the header has 13", 10)
    refused(path, "Coordinates\nversion=1\n", "no line 'endheader'")
    refused(path, "Coordinates\nendheader\n\n", "no column names", 2)


def test_a_hundred_thousand_columns_are_no_hindrance(path):
    many = 100_000  # what costs the square of this would take an hour
    header = "\t".join(["time", *NAMES, *(f"x{i}" for i in range(many))])
    rows = ("\t".join([*map(str, row), "0\t" * many]) for row in degrees())
    path.write_text("\n".join(["Coordinates", "inDegrees=yes", "endheader", header, *rows]))
    assert load_gait(path).q.shape == (5, 12)


def test_gaps_matter_only_in_the_columns_that_are_read(path):
    rows = storage(np.hstack([degrees(), np.full((5, 1), np.nan)]), [*NAMES, "arm_flex_r"])
    path.write_text(rows)
    assert load_gait(path).q.shape == (5, 12)
    values = degrees()
    values[2, 4] = np.nan
    refused(path, storage(values), "knee_angle_r is nan: expected a finite number", 8)


def test_forces_and_velocities_are_refused_in_one_line(path):
    forces = [f"ground_force_{i}" for i in range(12)]
    refused(path, storage(degrees(), forces), "holds forces or moments", 5)
    refused(path, storage(degrees(), [f"{name}_moment" for name in NAMES]), "holds forces or moments", 5)
    for title in ("Speeds", "Accelerations"):
        refused(path, storage(degrees(), header=(title, "inDegrees=yes")), "not their derivatives", 1)


def test_written_files_have_the_knee_positive_and_say_so(path):
    save_gait(normative_gait(), path)
    text = path.read_text()
    assert "knee_angle is positive in flexion" in text.split("endheader")[0]
    column = text.split("endheader\n")[1].splitlines()
    k = column[0].split("\t").index("knee_angle_r")
    assert max(float(row.split("\t")[k]) for row in column[1:]) > 50


def test_a_straight_legged_gait_comes_back_because_the_header_tells_its_signs(path):
    gait = Gait([0, 1], np.full((2, 12), -0.01))
    save_gait(gait, path)
    np.testing.assert_allclose(load_gait(path).q, gait.q, atol=ROUND_TRIP)
    negative = load_gait(path, preset="opensim-gait2392")  # who names a preset is believed
    assert negative.q[0, 3] > 0


def test_any_base_comes_back_from_opensims_angles(rng):
    q = rng.normal(size=(200, 4))
    base = np.tile(np.eye(4), (200, 1, 1))
    base[:, :3, :3] = rotations(q / np.linalg.norm(q, axis=1, keepdims=True))
    base[:, :3, 3] = rng.normal(size=(200, 3))
    angles, translation = to_opensim(base, GENERIC_OFFSET)
    back = from_opensim([pelvis_joint()], by_name(angles, translation), GENERIC_OFFSET)
    np.testing.assert_allclose(back, base, atol=ROUND_TRIP)


def by_name(angles, translation):
    """The pelvis's coordinates."""
    return dict(zip(pelvis_joint().coordinates, np.hstack([angles, translation]).T, strict=True))


@pytest.mark.parametrize(
    ("name", "axis", "sign"), [("tilt", (0, 2), 1), ("list", (1, 2), 1), ("rotation", (0, 1), 1)]
)
def test_opensims_pelvis_angles_turn_where_their_names_say(name, axis, sign):
    angles = np.zeros((1, 3))
    angles[0, ["tilt", "list", "rotation"].index(name)] = 0.1
    R = from_opensim([pelvis_joint()], by_name(angles, np.zeros((1, 3))), np.zeros(3))[0, :3, :3]
    # tilt +: the front goes up; list +: the left side goes up; rotation +: the front turns left
    body, world = axis
    assert sign * R[world, body] == pytest.approx(np.sin(0.1))


RECORDING = "opensim_subject01_walk/subject01_walk1"


@pytest.mark.parametrize(("angles", "poses"), [("_ik.mot", ""), ("_ik_full_opensim46.mot", "_full")])
def test_the_recorded_pelvis_agrees_with_opensims_own_kinematics(shared, angles, poses):
    gait = load_gait(shared / f"{RECORDING}{angles}")
    with (shared / f"{RECORDING}_body_poses{poses}.csv").open() as file:
        rows = list(csv.DictReader(file))
    pelvis = np.array(
        [[float(row[f"pelvis_{c}"]) for c in ("px", "py", "pz", "qw", "qx", "qy", "qz")] for row in rows]
    )
    ours = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    R = rotations(pelvis[:, 3:] / np.linalg.norm(pelvis[:, 3:], axis=1, keepdims=True))
    np.testing.assert_allclose(gait.base[:, :3, :3], ours @ R @ ours.T, atol=FILE)
    position = (pelvis[:, :3] + R @ GENERIC_OFFSET) @ ours.T
    np.testing.assert_allclose(gait.base[:, :3, 3], position, atol=FILE)
    np.testing.assert_allclose(gait.time, [float(row["time"]) for row in rows], atol=5.1e-4)  # milliseconds


def test_the_recording_is_a_walk_of_an_adult(shared):
    gait = load_gait(shared / f"{RECORDING}_ik.mot")
    assert (len(gait), gait.time[0]) == (73, 0.4)
    knees = np.degrees(gait.q[:, [3, 9]])
    assert knees.min() == pytest.approx(-3.2, abs=0.1)  # the subject hyperextends, README of the data
    assert 60 < knees.max() < 75
    assert "inferred" in gait.source
    assert 0.9 < gait.base[:, 2, 3].mean() < 1.0  # mid-hip height [m]


def test_forces_of_the_recording_are_refused(shared):
    for name in ("_grf.mot", "_id.sto"):
        with pytest.raises(FormatError, match="holds forces or moments"):
            load_gait(shared / f"{RECORDING}{name}")


def test_the_recording_survives_every_format(shared, tmp_path):
    gait = load_gait(shared / f"{RECORDING}_ik.mot")
    for suffix in (".csv", ".mot", ".sto"):
        save_gait(gait, tmp_path / f"walk{suffix}")
        back = load_gait(tmp_path / f"walk{suffix}")
        np.testing.assert_allclose(back.q, gait.q, atol=ROUND_TRIP)
        np.testing.assert_allclose(back.base, gait.base, atol=ROUND_TRIP)
        assert back.source == gait.source


@pytest.mark.parametrize("name", OPENSIM_PRESETS)
def test_a_file_is_written_for_the_family_of_its_model(path, name):
    """Knee's sign and mid-hip are the preset's, and reading finds them in the header."""
    walk = normative_gait("slow")
    save_gait(walk, path, preset=name)
    table = read_storage(path).table
    knee = table.values[:, table.names.index("knee_angle_l")]
    bent = np.degrees(walk.q[:, JOINTS.index("left_knee_flexion")])
    np.testing.assert_allclose(knee, PRESETS[name].knee * bent, atol=1e-9)
    back = load_gait(path)
    np.testing.assert_allclose(back.q, walk.q, atol=ROUND_TRIP)
    np.testing.assert_allclose(back.base, walk.base, atol=ROUND_TRIP)


def test_only_opensims_files_and_presets_can_be_chosen_to_write(path):
    with pytest.raises(FormatError, match=r"only \.mot and \.sto"):
        save_gait(normative_gait("slow"), path.with_suffix(".csv"), preset="opensim-gait2392")
    with pytest.raises(UnknownNameError, match="unknown preset 'vicon-pig'"):
        save_gait(normative_gait("slow"), path, preset="vicon-pig")
    assert not list(path.parent.iterdir())


def test_radians_in_a_file_of_degrees_are_suspected(path):
    values = degrees()
    values[:, 1:] = np.radians(values[:, 1:])
    refused(path, storage(values), r"\(degrees\), but .* radians\?")

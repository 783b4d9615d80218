"""OpenSim tables as OpenSim writes them: stale headers, doubled rows, units, missing coordinates."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats import load_forces, load_gait, load_torques
from exo_pin.gait import normative_gait

EXACT = 1e-12  # [rad, m]
COORDINATES = ["hip_flexion", "hip_adduction", "hip_rotation", "knee_angle", "ankle_angle", "subtalar_angle"]
NAMES = [f"{name}_{side}" for side in "lr" for name in COORDINATES]
PELVIS = ["pelvis_tilt", "pelvis_list", "pelvis_rotation", "pelvis_tx", "pelvis_ty", "pelvis_tz"]
MAY_MISS = ["hip_adduction_l", "hip_rotation_l", "subtalar_angle_l"]


@pytest.fixture
def walk():
    """Columns by name: a normal walk of 40 samples [deg, m], the pelvis in motion."""
    gait = normative_gait("free", samples=40)
    columns = {"time": gait.time} | dict(zip(NAMES, np.degrees(gait.q).T, strict=True))
    rows = np.arange(40)
    return columns | {name: 0.1 * np.sin(0.1 * rows + k) for k, name in enumerate(PELVIS)}


@pytest.fixture
def path(tmp_path):
    return tmp_path / "walk.sto"


def write(path, columns, header=("inDegrees=yes",), rename=str):
    """A storage file; `columns` is a mapping or pairs of name and values, so that names may be repeated."""
    pairs = list(columns.items()) if isinstance(columns, dict) else list(columns)
    values = np.column_stack([values for _, values in pairs])
    rows = ["\t".join(f"{x:.17g}" for x in row) for row in values]
    names = "\t".join(name if name == "time" else rename(name) for name, _ in pairs)
    path.write_text("\n".join(["Coordinates", *header, "endheader", names, *rows, ""]))
    return path


def same(gait, other):
    np.testing.assert_allclose(gait.q, other.q, atol=EXACT)
    np.testing.assert_allclose(gait.base, other.base, atol=EXACT)


@pytest.mark.parametrize("rename", [str.upper, str.title, lambda name: f"/JointSet/x/{name.upper()}/Value"])
def test_coordinates_may_be_written_in_capitals(path, walk, rename):
    same(load_gait(write(path, walk, rename=rename)), load_gait(write(path, walk)))


@pytest.mark.parametrize("name", ["Time", "TIME", "time (s)", "Time [sec]", "time_"])
def test_the_time_may_have_a_capital_and_a_unit(path, walk, name):
    expected = load_gait(write(path, walk))
    path.write_text(path.read_text().replace("time\t", f"{name}\t"))
    if name == "time_":
        with pytest.raises(FormatError, match="missing coordinates: time"):
            load_gait(path)
    else:
        same(load_gait(path), expected)


def test_decimal_commas_are_read(path, walk):
    expected = load_gait(write(path, walk))
    head, rows = path.read_text().split("endheader\n")
    path.write_text(head + "endheader\n" + rows.replace(".", ","))
    same(load_gait(path), expected)


@pytest.mark.parametrize("stated", ["39", "41", "1", "000", "999999999999999", "9" * 5000, "-1", "many", ""])
@pytest.mark.parametrize(("key", "what"), [("nRows={}", "rows"), ("datarows {}", "rows")])
def test_another_number_of_rows_in_the_header_is_remarked(path, walk, key, what, stated):
    expected = load_gait(write(path, walk))
    gait = load_gait(write(path, walk, ("inDegrees=yes", key.format(stated))))
    same(gait, expected)
    if stated or "=" in key:
        (remark,) = gait.remarks
        assert f"{what}, the table has 40" in remark
        assert len(remark) < 200
    assert expected.remarks == ()


@pytest.mark.parametrize("stated", [3, 18, 20])
@pytest.mark.parametrize("key", ["nColumns={}", "datacolumns {}"])
def test_another_number_of_columns_in_the_header_is_remarked(path, walk, key, stated):
    expected = load_gait(write(path, walk))
    gait = load_gait(write(path, walk, ("inDegrees=yes", key.format(stated))))
    same(gait, expected)
    assert f"the header says {stated} columns, the table has 19" in gait.remarks[0]


def test_only_columns_that_are_read_must_be_unique(path, walk):
    expected = load_gait(write(path, walk))
    more = [
        (name, np.full(40, 7.0))
        for name in ("ground_force_vx", "ground_force_vx", "arm_flex_r", "arm_flex_r")
    ]
    same(load_gait(write(path, [*walk.items(), *more])), expected)
    for name in ("knee_angle_r", "time", "pelvis_tx", "/jointset/knee_r/knee_angle_r/value"):
        write(path, [*walk.items(), (name, walk["time"])])
        with pytest.raises(FormatError, match=f"{name.split('/')[-2:][0]}' occurs more than once"):
            load_gait(path)


def test_repeated_columns_of_forces_belong_to_nobody(path, walk):
    columns = [
        (f"ground_{kind}{axis}", walk["time"])
        for kind, axis in product(("force_v", "force_p", "torque_"), "xyz")
    ]
    forces = [("time", walk["time"]), *columns]
    assert len(load_forces(write(path, forces))) == 1
    with pytest.raises(FormatError, match="'ground_force_vy' occurs more than once"):
        load_forces(write(path, [*forces, ("ground_force_vy", walk["time"])]))


@pytest.mark.parametrize("doubled", [[1], [20], [39], [5, 20, 30], [20, 20]])
def test_rows_that_repeat_the_row_above_are_left_out(path, walk, doubled):
    expected = load_gait(write(path, walk))
    rows = np.sort([*range(40), *doubled])
    columns = {name: values[rows] for name, values in walk.items()}
    gait = load_gait(write(path, columns | {"soleus_r.activation": np.arange(len(rows))}))
    same(gait, expected)
    assert gait.remarks == (f"rows that repeat time and values of the row above: {len(doubled)}, left out",)


def test_a_time_that_comes_twice_with_other_values_is_refused(path, walk):
    rows = np.sort([*range(40), 20])
    columns = {name: values[rows] for name, values in walk.items()}
    columns["knee_angle_r"][21] += 0.01
    with pytest.raises(FormatError, match="comes twice, with knee_angle_r") as caught:
        load_gait(write(path, columns))
    assert caught.value.line == 5 + 21
    columns["time"][21] -= 0.01
    with pytest.raises(FormatError, match="time does not increase"):
        load_gait(write(path, columns))


def test_torques_and_forces_may_have_doubled_rows_too(path, walk):
    rows = np.sort([*range(40), 20])
    moments = {"time": walk["time"][rows], "hip_flexion_r_moment": rows * 1.0}
    assert len(load_torques(write(path, moments)).time) == 40


def in_radians(walk):
    turns = [*NAMES, *PELVIS[:3]]
    return {name: np.radians(values) if name in turns else values for name, values in walk.items()}


@pytest.mark.parametrize("header", [(), ("inDegrees=no",), ("inDegrees=perhaps",)])
def test_degrees_are_known_by_a_knee_beyond_a_turn_whatever_the_header_says(path, walk, header):
    expected = load_gait(write(path, walk))
    gait = load_gait(write(path, walk, header))
    same(gait, expected)
    assert "which no leg does in radians: read as degrees" in gait.remarks[0]
    given = load_gait(path, units="deg")
    same(given, expected)
    assert ("inDegrees=no; angles are read as deg" in "".join(given.remarks)) == (header == ("inDegrees=no",))


def test_radians_are_read_by_the_header_or_the_user(path, walk):
    expected = load_gait(write(path, walk))
    same(load_gait(write(path, in_radians(walk), ("inDegrees=no",))), expected)
    same(load_gait(write(path, in_radians(walk), ()), units="rad"), expected)
    gait = load_gait(write(path, in_radians(walk)), units="rad")
    same(gait, expected)
    assert gait.remarks == ("the header says inDegrees=yes; angles are read as rad, as the units are given",)
    with pytest.raises(FormatError, match=r"no inDegrees; expected .* reaches 1"):
        load_gait(write(path, in_radians(walk), ()))


def test_numbers_between_half_a_turn_and_a_turn_are_named(path, walk):
    columns = in_radians(walk)
    columns["hip_flexion_r"][3] = 4.0
    with pytest.raises(FormatError, match=r"inDegrees=no \(radians\), but hip_flexion_r reaches 4: degrees"):
        load_gait(write(path, columns, ("inDegrees=no",)))


@pytest.mark.parametrize(
    "absent",
    [
        ["subtalar_angle_l", "subtalar_angle_r"],
        MAY_MISS,
        ["pelvis_list"],
        ["pelvis_list", "pelvis_rotation", "pelvis_tz"],
        [*MAY_MISS, "pelvis_list", "pelvis_rotation", "pelvis_tz"],
        ["pelvis_tx", "pelvis_ty", "pelvis_tz"],
    ],
)
def test_coordinates_that_models_lock_or_lack_are_held_at_zero_and_named(path, walk, absent):
    zero = walk | {name: np.zeros(40) for name in absent}
    expected = load_gait(write(path, zero))
    gait = load_gait(write(path, {name: walk[name] for name in walk if name not in absent}))
    same(gait, expected)
    (remark,) = gait.remarks
    assert all(
        f"{name} at 0 {'m' if name[7] == 't' and name[-1] in 'xyz' else 'deg'}" in remark for name in absent
    )
    assert all(name in gait.source for name in absent)


@pytest.mark.parametrize("name", ["hip_flexion_l", "knee_angle_r", "ankle_angle_l"])
def test_a_missing_flexion_is_refused_unless_the_user_holds_it(path, walk, name):
    write(path, {other: values for other, values in walk.items() if other != name})
    with pytest.raises(FormatError, match=f"missing coordinates: {name}; a mapping holds") as caught:
        load_gait(path)
    assert caught.value.line == 4
    ours = JOINTS[NAMES.index(name)]
    gait = load_gait(path, mapping={"5": ours}, preset="opensim-rajagopal")
    np.testing.assert_allclose(np.degrees(gait.q[:, JOINTS.index(ours)]), 5, atol=1e-9)
    assert f"{name} at 5 deg (as mapped)" in gait.remarks[0]


def test_every_coordinate_that_may_miss_can_be_held_at_a_number(path, walk):
    absent = [*MAY_MISS, "pelvis_list", "pelvis_tz"]
    held = walk | dict.fromkeys(absent, np.full(40, 0.5))
    expected = load_gait(write(path, held))
    write(path, {name: walk[name] for name in walk if name not in absent})
    names = "left_hip_adduction,left_hip_rotation,left_ankle_inversion, pelvis_list,pelvis_tz"
    gait = load_gait(path, mapping={"0.5": names})
    same(gait, expected)
    assert "pelvis_list at 0.5 deg, pelvis_tz at 0.5 m (as mapped)" in gait.remarks[0]
    with pytest.raises(FormatError, match="only a number, which holds"):
        load_gait(path, mapping={"x": "pelvis_tz"})
    with pytest.raises(UnknownNameError, match="joint 'ankle'"):
        load_gait(path, mapping={"0": "ankle"})


def test_a_moco_solution_is_read_beside_speeds_forces_and_controls(path, walk):
    """Planar, in radians, the knee negative in flexion, as OpenSim's Moco writes it."""
    planar = [name for name in in_radians(walk) if name not in (*MAY_MISS, "pelvis_list", "pelvis_rotation")]
    columns = {name: in_radians(walk)[name] for name in planar}
    for side in "lr":
        columns[f"knee_angle_{side}"] = -columns[f"knee_angle_{side}"]
    expected = load_gait(write(path, columns, ("inDegrees=no",)))
    pairs = [("time", columns["time"])]
    pairs += [(f"/jointset/j/{name}/value", columns[name]) for name in planar[1:]]
    pairs += [(f"/jointset/j/{name}/speed", np.full(40, 9.0)) for name in planar[1:]]
    pairs += [
        (f"/forceset/{name}", np.full(40, 0.1))
        for name in ("soleus_r", "soleus_r/activation", "hip_flexion_r")
    ]
    gait = load_gait(write(path, pairs, ("inDegrees=no", "num_controls=3", "DataType=double")))
    same(gait, expected)
    assert "knee negative in flexion" in gait.source
    muscles = [pair for pair in pairs if "value" not in pair[0]]
    with pytest.raises(FormatError, match=r"missing coordinates: none of .*columns: time, /jointset"):
        load_gait(write(path, muscles, ("inDegrees=no",)))
    one_knee = [pair for pair in pairs if "knee_angle_r/value" not in pair[0]]
    with pytest.raises(FormatError, match="missing coordinates: knee_angle_r;"):
        load_gait(write(path, one_knee, ("inDegrees=no",)))


def test_a_header_that_says_degrees_above_radians_is_named(path, walk):
    radians = walk | {name: np.radians(walk[name]) for name in NAMES}
    write(path, radians)
    with pytest.raises(
        FormatError, match=r"inDegrees=yes \(degrees\), but knee_angle_. reaches 1\..*: radians\?"
    ):
        load_gait(path)
    np.testing.assert_allclose(load_gait(path, units="rad").q, load_gait(write(path, walk)).q, atol=EXACT)
    told = load_gait(write(path, radians), units="deg", preset="opensim-rajagopal")
    assert "radians?" in " ".join(told.remarks)


def test_someone_who_stands_still_has_degrees_as_the_header_says(path, walk):
    still = walk | {name: np.full(40, 0.1) for name in NAMES}
    gait = load_gait(write(path, still), preset="opensim-rajagopal")
    np.testing.assert_allclose(gait.q, np.radians(0.1), atol=EXACT)


def test_states_of_opensim_3_are_read_beside_speeds_and_muscles(path, walk):
    """`hip_flexion_r`, its speed `hip_flexion_r_u` and a muscle's state; radians."""
    expected = load_gait(write(path, walk))
    radians = walk | {name: np.radians(walk[name]) for name in NAMES}
    radians |= {name: np.radians(walk[name]) for name in PELVIS[:3]}
    states = radians | {f"{name}_u": np.full(40, 7.0) for name in NAMES}
    states |= {"soleus_r.activation": np.full(40, 0.5), "soleus_r.fiber_length": np.full(40, 0.05)}
    same(load_gait(write(path, states, header=("inDegrees=no",))), expected)


@pytest.mark.parametrize("header", [("DataType=Quaternion",), ()])
def test_orientations_of_sensors_need_inverse_kinematics_first(path, header):
    rows = [f"{k / 100}\t1.0,0.0,0.0,0.0\t0.9,0.1,0.2,0.3" for k in range(5)]
    path.write_text("\n".join([*header, "endheader", "time\tpelvis_imu\tfemur_r_imu", *rows]))
    with pytest.raises(FormatError, match=r"orientations of sensors .*IMU inverse kinematics"):
        load_gait(path)


def test_vectors_are_no_coordinates(path):
    path.write_text("DataType=Vec3\nendheader\ntime\tRASI\n0.0\t1.0,2.0,3.0\n0.1\t1,2,3\n")
    with pytest.raises(FormatError, match="hold 3 numbers each"):
        load_gait(path)


def test_a_pelvis_100_km_away_is_refused(path, walk):
    columns = walk | {"pelvis_tx": np.full(40, 1e5)}
    with pytest.raises(FormatError, match="pelvis_tx is 100000: more than 10000 m away"):
        load_gait(write(path, columns))


FILES = "trials/files"


@pytest.mark.parametrize(
    ("name", "remark"),
    [
        ("ik_with_repeated_force_columns.mot", ""),
        ("rra_repeated_time.sto", "repeat time and values"),
        ("degrees_but_header_says_no.sto", "read as degrees"),
        ("moco_solution_planar.sto", "hip_adduction_l at 0 deg"),
    ],
)
def test_each_trial_file_is_read_as_opensim_reads_it(shared, name, remark):
    """The same numbers as OpenSim's own reader has, which knows nothing of missing ones or units."""
    opensim = pytest.importorskip("opensim", reason="OpenSim is not installed (extra `oracle`)")
    file = shared.parent / FILES / name
    if not file.exists():
        pytest.skip("no shared trials")
    opensim.Logger.setLevelString("Off")
    theirs = opensim.Storage(str(file))
    gait = load_gait(file)
    labels, column = theirs.getColumnLabels(), opensim.ArrayDouble()
    radians = name.startswith("moco")
    for k in range(1, labels.getSize()):
        plain = labels.get(k).removesuffix("/value").rpartition("/")[2]
        if plain in NAMES and not labels.get(k).endswith("speed"):
            theirs.getDataColumn(k - 1, column)
            values = np.array([column.get(i) for i in range(column.getSize())])
            if "repeated_time" in name:
                values = np.delete(values, np.flatnonzero(np.diff(_times(opensim, theirs)) == 0))
            ours = gait.q[:, NAMES.index(plain)] * (-1 if "knee" in plain else 1)
            np.testing.assert_allclose(ours, values if radians else np.radians(values), atol=EXACT)
    assert remark in " ".join(gait.remarks)


def _times(opensim, table):
    column = opensim.ArrayDouble()
    table.getTimeColumn(column)
    return np.array([column.get(i) for i in range(column.getSize())])

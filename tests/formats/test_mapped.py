"""Anybody's table: mapped columns, told units, turned signs, held joints; what nobody says is refused."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError
from exo_pin.formats import PRESETS, load_gait, save_gait
from exo_pin.gait import normative_gait

SAGITTAL = {
    "HipR": "right_hip_flexion",
    "HipL": "left_hip_flexion",
    "KneeR": "right_knee_flexion",
    "KneeL": "left_knee_flexion",
    "0": ",".join(j for j in JOINTS if not j.endswith(("hip_flexion", "knee_flexion"))),
}
HEADER = ["t", "HipR", "note", "KneeR", "HipL", "KneeL"]
ROWS = [["0", "10.5", "a", "5", "-3", "60"], ["0.5", "11", "", "6", "-4", "61"]]
EXACT = 1e-12  # [rad]


def table(separator=",", header=HEADER, rows=ROWS, above=()):
    return "\n".join([*above, separator.join(header), *(separator.join(row) for row in rows), ""])


@pytest.fixture
def path(tmp_path):
    return tmp_path / "lab.csv"


def column(gait, joint):
    return np.degrees(gait.q[:, JOINTS.index(joint)])


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_mapped_columns_become_joints_whatever_separates_them(path, separator):
    path.write_text(table(separator, above=["Laboratory X", "measured; by, somebody"]))
    gait = load_gait(path, mapping=SAGITTAL, units="deg")
    np.testing.assert_allclose(column(gait, "right_hip_flexion"), [10.5, 11], atol=EXACT)
    np.testing.assert_allclose(column(gait, "left_knee_flexion"), [60, 61], atol=EXACT)
    assert not gait.q[:, JOINTS.index("left_hip_rotation")].any()
    np.testing.assert_array_equal(gait.time, [0, 0.5])
    assert gait.source == "lab.csv, as mapped"


def test_decimal_commas_and_a_line_of_units_are_understood(path):
    rows = [
        ["s", "deg", "", "deg", "deg", "deg"],
        ["0,0", "10,5", "a", "5", "-3", "60"],
        ["0,5", *ROWS[1][1:]],
    ]
    path.write_text(table(";", rows=rows))
    gait = load_gait(path, mapping=SAGITTAL, units="deg")
    np.testing.assert_allclose(column(gait, "right_hip_flexion"), [10.5, 11], atol=EXACT)


def test_a_minus_turns_the_sign_and_radians_stay(path):
    path.write_text(table(rows=[["0", "1", "", "-0.5", "0.1", "0.2"], ["1", "1", "", "-0.6", "0.1", "0.2"]]))
    mapping = {("-KneeR" if c == "KneeR" else c): joint for c, joint in SAGITTAL.items()}
    gait = load_gait(path, mapping=mapping, units="rad")
    np.testing.assert_allclose(gait.q[:, JOINTS.index("right_knee_flexion")], [0.5, 0.6], atol=EXACT)


def test_units_in_the_names_are_believed_and_their_absence_is_refused(path):
    named = [f"{name} [deg]" if name[0] in "HK" else name for name in HEADER]
    path.write_text(table(header=named))
    gait = load_gait(path, mapping=SAGITTAL)
    np.testing.assert_allclose(column(gait, "left_knee_flexion"), [60, 61], atol=EXACT)
    path.write_text(table())
    with pytest.raises(FormatError, match="nothing says whether angles are deg or rad"):
        load_gait(path, mapping=SAGITTAL)
    with pytest.raises(UnknownNameError, match="unit of angles 'grad'"):
        load_gait(path, mapping=SAGITTAL, units="grad")


@pytest.mark.parametrize(
    ("change", "match"),
    [
        ({"KneeX": "left_knee_flexion"}, "no column 'KneeX'; the file has"),
        ({"KneeL": "right_knee_flexion"}, "no column is mapped to left_knee_flexion"),
        ({"note": "left_knee_flexion"}, "note is 'a', expected a number"),
        ({"200": "left_knee_flexion"}, "more than half a turn"),
    ],
)
def test_what_does_not_fit_is_named(path, change, match):
    path.write_text(table())
    mapping = {c: joint for c, joint in SAGITTAL.items() if joint not in change.values() and c not in change}
    with pytest.raises(FormatError, match=match):
        load_gait(path, mapping=mapping | change, units="deg")


def test_unknown_joints_and_rows_without_a_time_are_refused_with_their_place(path):
    path.write_text(table(rows=[*ROWS, ["", "1", "", "6", "-4", "61"]]))
    with pytest.raises(UnknownNameError, match="did you mean 'left_knee_flexion'"):
        load_gait(path, mapping=SAGITTAL | {"KneeL": "left_knee_flexoin"}, units="deg")
    for cell in ("", "nan"):
        path.write_text(table(rows=[*ROWS, [cell, "1", "", "6", "-4", "61"]]))
        with pytest.raises(FormatError, match=r"t is empty|does not increase") as caught:
            load_gait(path, mapping=SAGITTAL, units="deg")
        assert caught.value.line == 4


@pytest.fixture
def rows():
    """Two seconds at 50 Hz; every angle a straight line, which filling must continue."""
    return [[repr(k / 50), repr(10 + k / 10), "x", "5", "-3", "60"] for k in range(101)]


@pytest.mark.parametrize("gap", ["", "nan", "NaN"])
def test_short_gaps_are_filled_and_the_source_says_so(path, rows, gap):
    for k in (20, 21, 22):
        rows[k][1] = gap
    path.write_text(table(rows=rows))
    gait = load_gait(path, mapping=SAGITTAL, units="deg")
    np.testing.assert_allclose(column(gait, "right_hip_flexion"), 10 + np.arange(101) / 10, atol=1e-9)
    assert "3 angles in gaps up to 0.2 s filled" in gait.source


def test_long_gaps_cut_the_walk_and_the_source_says_so(path, rows):
    for k in (*range(20, 35), 100):
        rows[k][1] = ""
    path.write_text(table(rows=rows))
    gait = load_gait(path, mapping=SAGITTAL, units="deg")
    assert (len(gait), gait.time[0]) == (65, 0.7)
    assert "rows 36 to 100 of 101, the rest has gaps" in gait.source
    path.write_text(table(rows=[[*row[:1], "", *row[2:]] for row in rows]))
    with pytest.raises(FormatError, match=r"no two rows in a row without gaps longer than 0\.2 s"):
        load_gait(path, mapping=SAGITTAL, units="deg")


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_reads_a_table_with_its_names_and_signs(path, name):
    walk = normative_gait("free", samples=17)
    preset = PRESETS[name]
    columns = {joint: column for column, joint in preset.mapping.items()}
    names = ["time", *(columns[joint].lstrip("-") for joint in JOINTS)]
    signs = np.array([-1 if columns[joint].startswith("-") else 1 for joint in JOINTS])
    values = np.column_stack([walk.time, signs * walk.q])
    path = path.with_suffix(".tsv")
    path.write_text(table("\t", names, [[repr(x) for x in row] for row in values.tolist()]))
    gait = load_gait(path, preset=name, units="rad")
    np.testing.assert_allclose(gait.q, walk.q, atol=EXACT)


def test_a_written_tsv_is_ours_and_one_column_more_makes_it_somebody_elses(path):
    walk = normative_gait("free", samples=17)
    path = path.with_suffix(".tsv")
    save_gait(walk, path)
    assert len(load_gait(path).events) == len(walk.events) > 0
    lines = path.read_text().splitlines()
    more = [line if line.startswith("#") else f"{line}\t{line.split(chr(9))[0]}x" for line in lines]
    path.write_text("\n".join(more))
    np.testing.assert_allclose(load_gait(path).q, walk.q, atol=EXACT)
    assert "exo_pin" not in load_gait(path).source


def test_our_own_columns_need_no_mapping_in_a_tsv(path):
    walk = normative_gait("free", samples=17)
    path = path.with_suffix(".tsv")
    names = ["time_s", *(f"{joint}_deg" for joint in JOINTS)]
    values = np.column_stack([walk.time, np.degrees(walk.q)])
    path.write_text(table("\t", names, [[repr(x) for x in row] for row in values.tolist()]))
    np.testing.assert_allclose(load_gait(path).q, walk.q, atol=EXACT)


EIGHT = [
    f"{sign}{side}_{movement}"
    for side in ("left", "right")
    for sign, movement in (
        ("", "ankle_dorsiflexion"),
        ("-", "hip_adduction"),
        ("", "hip_flexion"),
        ("", "knee_flexion"),
    )
]
NOT_THERE = {"0": ",".join(j for j in JOINTS if j.endswith(("hip_rotation", "inversion")))}


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "   "])
@pytest.mark.parametrize("above", [(), ("# by a robot",), ("", "Laboratory X")])
def test_columns_without_names_are_read_by_position(path, rng, separator, above):
    path = path.with_suffix(".txt")
    values = rng.uniform(-0.5, 0.5, (5, 8))
    path.write_text("\n".join([*above, *(separator.join(map(repr, row)) for row in values.tolist())]))
    gait = load_gait(path, columns=EIGHT, row_rate=50, units="rad", mapping=NOT_THERE)
    for k, name in enumerate(EIGHT):
        sign = -1 if name.startswith("-") else 1
        np.testing.assert_allclose(gait.q[:, JOINTS.index(name.lstrip("-"))], sign * values[:, k], atol=EXACT)
    np.testing.assert_allclose(gait.time, np.arange(5) / 50)
    assert gait.source == "lab.txt, columns by position, 50 rows per second"


def test_a_column_may_hold_the_time_or_nothing(path):
    path.write_text("\n".join(f"{0.02 * k!r},99,{','.join(['0.1'] * 8)}" for k in range(4)))
    gait = load_gait(path, columns=["time", "_", *EIGHT], units="rad", mapping=NOT_THERE)
    np.testing.assert_allclose(gait.time, 0.02 * np.arange(4))
    with pytest.raises(FormatError, match="column 1 holds the seconds; a rate of rows is for"):
        load_gait(path, columns=["time", "_", *EIGHT], units="rad", mapping=NOT_THERE, row_rate=50)


def test_a_table_without_names_says_how_it_is_read(path):
    text = "\n".join(",".join(["0.1"] * 8) for _ in range(4))
    path.write_text(text)
    by_position = {"columns": EIGHT, "row_rate": 50, "units": "rad", "mapping": NOT_THERE}
    for options, match in (
        ({}, "the first row holds numbers; name the columns by position, --columns time,left"),
        ({"mapping": {"a": "time"}}, "the first row holds numbers; name the columns by position"),
        (by_position | {"columns": EIGHT[:-1]}, "7 columns are named, but its rows hold 8 numbers"),
        (by_position | {"columns": [*EIGHT, "time"]}, "9 columns are named, but its rows hold 8 numbers"),
        (by_position | {"row_rate": None}, "no column of seconds; .* rows per second"),
        (by_position | {"units": None}, "nothing says whether angles are deg or rad"),
        (by_position | {"mapping": {}}, "no column is mapped to left_hip_rotation"),
        (by_position | {"preset": "vicon-pig"}, "preset is not for this kind of file"),
        (by_position | {"columns": [EIGHT[0], *EIGHT[:7]]}, "left_ankle_dorsiflexion is named twice"),
    ):
        with pytest.raises(FormatError, match=match) as caught:
            load_gait(path, **options)
        assert caught.value.line in (None, 1)
    for rate in (0, float("nan")):
        with pytest.raises(DescriptionError, match="row_rate is"):
            load_gait(path, **by_position | {"row_rate": rate})
    with pytest.raises(UnknownNameError, match="did you mean 'left_knee_flexion'"):
        load_gait(path, columns=["left_knee_flexoin"], units="rad", row_rate=50)
    path.write_text("nothing\n")
    with pytest.raises(FormatError, match="8 columns are named, but no row of numbers"):
        load_gait(path, **by_position)
    with pytest.raises(FormatError, match=r"are for tables \(\.csv, \.tsv, \.txt\)"):
        load_gait(path.with_suffix(".mot"), columns=EIGHT)


def test_a_table_of_ten_million_rows_is_refused_before_it_takes_memory(path, monkeypatch):
    monkeypatch.setattr("exo_pin.formats.tables.numeric_table.MOST_ROWS", 1000)
    path.write_text("t,K\n" + "0,1\n" * 2000)
    with pytest.raises(FormatError, match="2002 rows; at most 1000 are read"):
        load_gait(path, mapping={"K": "left_knee_flexion"}, units="deg")

"""Force files: gaps where nobody stands are no gaps in the forces."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.errors import FormatError
from exo_pin.formats import load_forces, load_torques

NAMES = [f"ground_force_{w}{a}" for w in "vp" for a in "xyz"] + [f"ground_torque_{a}" for a in "xyz"]


def written(path, rows):
    lines = ["grf", f"nRows={len(rows)}", "nColumns=10", "endheader", "\t".join(["time", *NAMES])]
    path.write_text("\n".join([*lines, *("\t".join(map(str, row)) for row in rows), ""]))
    return path


@pytest.mark.parametrize("change", [str.upper, str.title, lambda names: names.replace("time", "Time (s)")])
def test_columns_may_be_written_in_capitals(tmp_path, change):
    path = written(tmp_path / "grf.mot", [[k / 10, *range(9)] for k in range(3)])
    (expected,) = load_forces(path)
    head, table = path.read_text().split("endheader\n")
    path.write_text(head + "endheader\n" + change(table))
    (plate,) = load_forces(path)
    for part in ("time", "force", "point", "moment"):
        np.testing.assert_array_equal(getattr(plate, part), getattr(expected, part))


def test_a_plate_without_torques_has_no_free_moment_and_that_is_said(tmp_path):
    path = written(tmp_path / "grf.mot", [[k / 10, *range(9)] for k in range(3)])
    path.write_text(path.read_text().replace("torque", "turn"))
    (plate,) = load_forces(path)
    assert not plate.moment.any()
    assert "no torque columns" in " ".join(plate.remarks)
    path.write_text(path.read_text().replace("ground_turn_x", "ground_torque_x"))
    with pytest.raises(FormatError, match="no column for my, mz"):
        load_forces(path)


def test_a_point_of_nobody_is_zero(tmp_path):
    nan = float("nan")
    path = written(tmp_path / "grf.mot", [[0, *[0] * 3, *[nan] * 6], [0.1, 0, 700, 0, 1, 0, 2, 0, 3, 0]])
    (plate,) = load_forces(path)
    assert not plate.point[0].any()
    assert not plate.moment[0].any()
    np.testing.assert_array_equal(plate.force[1], [0, 0, 700])  # y up becomes z up


def test_a_point_that_is_not_known_under_a_load_stays_so(tmp_path):
    nan = float("nan")
    rows = [[0, 0, 700, 0, nan, 0, 2, 0, 3, 0], [0.1, 0, 700, 0, 1, 0, 2, 0, nan, 0]]
    path = written(tmp_path / "grf.mot", rows)
    (plate,) = load_forces(path)
    assert np.isnan(plate.point[0]).any()
    assert np.isfinite(plate.point[1]).all()
    assert np.isnan(plate.moment[1]).any()


def test_a_force_that_is_no_number_is_refused_with_its_line(tmp_path):
    path = written(tmp_path / "grf.mot", [[0, *[0] * 9], [0.1, "nan", *[0] * 8]])
    with pytest.raises(FormatError, match="ground_force_vx is nan") as caught:
        load_forces(path)
    assert caught.value.line == 7


@pytest.mark.parametrize(
    ("column", "value", "said"),
    [(2, 1e308, "more than 100000 N"), (4, 7.5e9, "more than 10000 m"), (9, -1e300, "more than 100000 N m")],
)
def test_impossible_forces_points_and_moments_under_a_foot_are_refused(tmp_path, column, value, said):
    row = [0.1, 0, 700, 0, 1, 0, 2, 0, 3, 0]
    row[column] = value
    path = written(tmp_path / "grf.mot", [[0, *[0] * 9], row])
    with pytest.raises(FormatError, match=said) as caught:
        load_forces(path)
    assert caught.value.line == 7


def test_an_impossible_point_of_nobody_is_zero(tmp_path):
    """A centre of pressure divided by no force can be anything."""
    path = written(
        tmp_path / "grf.mot", [[0, 0, 1, 0, 1e308, 0, 0, 0, 0, 0], [0.1, 0, 700, 0, 1, 0, 2, 0, 3, 0]]
    )
    (plate,) = load_forces(path)
    assert not plate.point[0].any()


def test_what_reading_forces_and_torques_corrected_is_said(tmp_path):
    still = [0] * 9
    path = written(tmp_path / "grf.mot", [[0, *still], [0.1, *still], [0.1, *still], [0.2, *still]])
    path.write_text(path.read_text().replace("nRows=4", "nRows=900"))
    (plate,) = load_forces(path)
    assert len(plate.time) == 3
    assert any("900" in remark for remark in plate.remarks)
    assert any("repeat" in remark and "1" in remark for remark in plate.remarks)


def test_a_repeated_row_of_inverse_dynamics_is_said(tmp_path):
    path = tmp_path / "id.sto"
    rows = "0\t1\n0.1\t2\n0.1\t2\n0.2\t3\n"
    path.write_text(f"id\nnRows=4\nnColumns=2\nendheader\ntime\thip_flexion_r_moment\n{rows}")
    torques = load_torques(path)
    assert len(torques.time) == 3
    assert any("repeat" in remark for remark in torques.remarks)

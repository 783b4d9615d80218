"""OpenSim coordinates with commas, as OpenCap's processing writes them."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.errors import FormatError
from exo_pin.formats import knee_preset, load_gait, save_gait
from exo_pin.gait import normative_gait

EXACT = 1e-12


@pytest.fixture
def written(tmp_path):
    """The walk as .mot and the same table with commas, row numbers and columns of arms."""
    walk = normative_gait("free", samples=40)
    save_gait(walk, tmp_path / "walk.mot")
    lines = (tmp_path / "walk.mot").read_text().split("endheader\n")[1].splitlines()
    rows = [f"{k}," + line.replace("\t", ",") + ",1.5" for k, line in enumerate(lines[1:])]
    path = tmp_path / "walk.csv"
    path.write_text("\n".join(["," + lines[0].replace("\t", ",") + ",arm_flex_r", *rows, ""]))
    return tmp_path / "walk.mot", path


def test_it_is_the_mot_of_the_same_walk(written):
    mot, csv = map(load_gait, written)
    np.testing.assert_allclose(csv.q, mot.q, atol=EXACT)
    np.testing.assert_allclose(csv.base, mot.base, atol=EXACT)
    assert "read as degrees" in " ".join(csv.remarks)
    assert knee_preset(written[1]) == "opensim-rajagopal"


@pytest.mark.parametrize("separator", [";", "\t"])
def test_a_spreadsheets_semicolons_decimal_commas_and_quotes_are_the_same_table(written, separator):
    expected = load_gait(written[1])
    lines = [line.split(",") for line in written[1].read_text().splitlines()]
    cells = [[f'"{cell.replace(".", ",")}"' for cell in line] for line in lines]
    written[1].write_text("\ufeff" + "\r\n".join(separator.join(row) for row in cells), encoding="utf-8")
    back = load_gait(written[1])
    np.testing.assert_array_equal(back.q, expected.q)
    np.testing.assert_array_equal(back.time, expected.time)


def test_its_columns_can_still_be_mapped(written):
    names = ("hip_flexion", "hip_adduction", "hip_rotation", "ankle_dorsiflexion", "ankle_inversion")
    rest = ",".join(f"{side}_{name}" for side in ("left", "right") for name in names)
    mapping = {"knee_angle_l": "left_knee_flexion", "knee_angle_r": "right_knee_flexion", "0": rest}
    gait = load_gait(written[1], mapping=mapping, units="deg")
    np.testing.assert_allclose(gait.q[:, 3], load_gait(written[0]).q[:, 3], atol=EXACT)


def test_radians_need_the_users_word(written):
    lines = written[1].read_text().splitlines()
    small = [
        ",".join([*line.split(",")[:2], *(str(float(x) / 100) for x in line.split(",")[2:])])
        for line in lines[1:]
    ]
    written[1].write_text("\n".join([lines[0], *small]))
    with pytest.raises(FormatError, match="give the units"):
        load_gait(written[1])
    assert load_gait(written[1], units="rad", preset="opensim-rajagopal").q.max() < 1

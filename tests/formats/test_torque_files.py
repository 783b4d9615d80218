"""Files of joint torques that are written: the same torques come back, also where they are not known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError, UnknownNameError
from exo_pin.formats import TORQUE_SUFFIXES, load_torques, save_torques
from exo_pin.gait import Torques


def torques(gaps=(), locked=(), source="a walk; ground reaction predicted, not measured"):
    """Ten samples of twelve sines; some samples, and some joints throughout, are not known."""
    time = np.arange(10) / 50 + 0.4
    tau = 40 * np.sin(5 * time[:, None] + np.arange(len(JOINTS)))
    tau[list(gaps)] = np.nan
    tau[:, [JOINTS.index(joint) for joint in locked]] = np.nan
    return Torques(time, tau, source=source)


@pytest.mark.parametrize("suffix", TORQUE_SUFFIXES)
@settings(max_examples=15)
@given(
    gaps=st.sets(st.integers(0, 9), max_size=8),
    locked=st.sets(st.sampled_from(JOINTS), max_size=10),
    source=st.text(st.characters(codec="utf-8", categories=("L", "N", "P", "Zs")), min_size=1, max_size=30),
)
def test_torques_come_back_from_their_file(tmp_path_factory, suffix, gaps, locked, source):
    path = tmp_path_factory.mktemp("torques") / f"t{suffix}"
    given_ = torques(gaps, locked, source)
    save_torques(given_, path)
    found = load_torques(path)
    np.testing.assert_array_equal(found.time, given_.time)
    np.testing.assert_array_equal(found.tau, given_.tau)
    assert found.joints == given_.joints
    assert found.source == source
    assert bool(found.remarks) == bool(gaps)


@pytest.mark.parametrize(("preset", "sign"), [("opensim-gait2392", -1), ("opensim-rajagopal", 1)])
def test_the_knee_of_a_file_has_the_sign_of_its_model(tmp_path, preset, sign):
    path = tmp_path / "t.sto"
    save_torques(torques(), path, preset=preset)
    lines = path.read_text().splitlines()
    names, first = (lines[lines.index("endheader") + k].split("\t") for k in (1, 2))
    cells = dict(zip(names, map(float, first), strict=True))
    for column, joint, turned in (
        ("knee_angle_r_moment", "right_knee_flexion", sign),
        ("hip_flexion_l_moment", "left_hip_flexion", 1),
        ("subtalar_angle_l_moment", "left_ankle_inversion", 1),
    ):
        assert cells[column] == turned * torques().tau[0, JOINTS.index(joint)]
    assert np.array_equal(load_torques(path).tau, torques().tau)  # its header names the preset


def test_cells_of_a_table_are_empty_where_torques_are_not_known_and_nan_is_refused(tmp_path):
    path = tmp_path / "t.csv"
    save_torques(torques(gaps=[3]), path)
    text = path.read_text()
    assert "nan" not in text
    assert "," * len(JOINTS) + "\n" in text
    path.write_text(text.replace("," * len(JOINTS) + "\n", ",nan" * len(JOINTS) + "\n"))
    with pytest.raises(FormatError, match="finite"):
        load_torques(path)


def test_only_models_files_have_a_preset_and_other_endings_are_refused(tmp_path):
    with pytest.raises(FormatError, match="preset"):
        save_torques(torques(), tmp_path / "t.csv", preset="opensim-gait2392")
    with pytest.raises(UnknownNameError):
        save_torques(torques(), tmp_path / "t.sto", preset="vicon-pig")
    with pytest.raises(FormatError, match=r"\.csv, \.sto, \.mot"):
        save_torques(torques(), tmp_path / "t.xlsx")
    assert not list(tmp_path.iterdir())


def test_opensim_reads_the_files(tmp_path):
    opensim = pytest.importorskip("opensim", reason="OpenSim is not installed (extra `oracle`)")
    path = tmp_path / "t.sto"
    save_torques(torques(gaps=[3]), path)
    table = opensim.TimeSeriesTable(str(path))
    column = table.getDependentColumn("hip_flexion_r_moment")
    read = np.array([column[k] for k in range(table.getNumRows())])
    np.testing.assert_allclose(read, torques(gaps=[3]).tau[:, JOINTS.index("right_hip_flexion")])

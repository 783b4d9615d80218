"""OpenSim itself reads what we write (needs the optional extra `oracle`)."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.formats import load_gait, save_gait
from exo_pin.formats.opensim.coordinate_names import LEG_COORDINATES
from exo_pin.formats.opensim.pelvis_axes import PELVIS_TRANSLATIONS
from exo_pin.gait import Gait, normative_gait

opensim = pytest.importorskip("opensim", reason="OpenSim's Python package is not installed (extra `oracle`)")

DIGITS = 1e-9  # [deg, m, s] OpenSim keeps doubles


@pytest.mark.parametrize("suffix", [".mot", ".sto"])
def test_opensim_loads_our_files_with_the_same_numbers(tmp_path, suffix):
    walk = normative_gait("free", samples=20)
    gait = Gait(walk.time + 0.5, walk.q, base=walk.base, events=[], source="normal walk")
    path = tmp_path / f"walk{suffix}"
    save_gait(gait, path)
    table = opensim.TimeSeriesTable(str(path))
    assert table.getTableMetaDataAsString("inDegrees") == "yes"
    np.testing.assert_allclose(table.getIndependentColumn(), gait.time, atol=DIGITS)
    for k, name in enumerate(LEG_COORDINATES):
        column = table.getDependentColumn(name).to_numpy()
        np.testing.assert_allclose(column, np.degrees(gait.q[:, k]), atol=DIGITS, err_msg=name)
    assert set(PELVIS_TRANSLATIONS) <= set(table.getColumnLabels())
    storage = opensim.Storage(str(path))
    assert (storage.getSize(), storage.isInDegrees()) == (20, True)


def test_what_opensim_writes_is_read(tmp_path):
    walk = normative_gait("free", samples=20)
    save_gait(walk, tmp_path / "ours.sto")
    opensim.STOFileAdapter.write(
        opensim.TimeSeriesTable(str(tmp_path / "ours.sto")), str(tmp_path / "theirs.sto")
    )
    back = load_gait(tmp_path / "theirs.sto", preset="opensim-rajagopal")
    np.testing.assert_allclose(back.q, walk.q, atol=1e-9)
    np.testing.assert_allclose(back.base, walk.base, atol=1e-9)

"""A walk as a pandas table and an xarray array."""

import dataclasses

import numpy as np
import pytest

from exo_pin import Gait, normative_gait
from exo_pin.anatomy import JOINTS
from exo_pin.errors import GaitError

WALK = normative_gait("slow")


def test_a_walk_comes_back_from_its_table():
    pytest.importorskip("pandas")
    for walk in (WALK, dataclasses.replace(WALK, base=None, events=(), periodic=False)):
        back = Gait.from_pandas(walk.to_pandas())
        np.testing.assert_array_equal(back.q, walk.q)
        np.testing.assert_array_equal(back.time, walk.time)
        assert (back.base is None) == (walk.base is None)
        if walk.base is not None:
            np.testing.assert_allclose(back.base, walk.base, atol=1e-14)
        assert [(e.side, e.kind, e.time) for e in back.events] == [
            (e.side, e.kind, e.time) for e in walk.events
        ]
        assert (back.periodic, back.source) == (walk.periodic, walk.source)


def test_a_table_without_a_joint_is_refused():
    pytest.importorskip("pandas")
    with pytest.raises(GaitError, match="left_knee_flexion"):
        Gait.from_pandas(WALK.to_pandas().drop(columns="left_knee_flexion"))


def test_an_xarray_has_the_dimensions_time_and_joint():
    pytest.importorskip("xarray")
    array = WALK.to_xarray()
    assert array.dims == ("time", "joint")
    assert array.sel(joint="right_knee_flexion").to_numpy().tolist() == WALK["right_knee_flexion"].tolist()
    assert list(array.joint.to_numpy()) == list(JOINTS)

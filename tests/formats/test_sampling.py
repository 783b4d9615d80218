"""Clocks of files: milliseconds are no seconds, and samples that miss are named with their place."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.errors import FormatError
from exo_pin.formats import load_gait, load_markers, save_gait
from exo_pin.gait import Gait, normative_gait
from exo_pin.gait.sampling import doubtful_unit, missing_samples
from tests.formats.test_trc import trc

TIME = np.arange(60) / 60


@pytest.fixture
def walk():
    gait = normative_gait("free", samples=60)
    return Gait(TIME, gait.q, base=gait.base)


@pytest.mark.parametrize("ending", ["csv", "mot", "npz", "yaml"])
def test_a_clock_in_milliseconds_is_refused_in_every_format(tmp_path, walk, ending):
    path = tmp_path / f"walk.{ending}"
    save_gait(Gait(1000 * TIME, walk.q), path)
    with pytest.raises(FormatError, match="milliseconds"):
        load_gait(path)


def test_frame_numbers_as_times_of_markers_are_refused(tmp_path):
    path = tmp_path / "walk.trc"
    lines = trc(frames=20).splitlines()
    rows = [line.split("\t") for line in lines[6:]]
    path.write_text("\n".join([*lines[:6], *("\t".join([k, k, *rest]) for k, _, *rest in rows), ""]))
    with pytest.raises(FormatError, match="samples lie 1 apart"):
        load_markers(path)


def test_missing_samples_are_counted_and_placed(tmp_path, walk):
    kept = np.setdiff1d(np.arange(60), [20, 21, 22, 40])
    path = tmp_path / "walk.csv"
    save_gait(Gait(TIME[kept], walk.q[kept]), path)
    (remark,) = load_gait(path).remarks
    assert remark == "samples are missing: 3 after 0.317 s, 1 after 0.650 s; curves run straight across"


@pytest.mark.parametrize(
    "clock", [TIME, np.round(TIME, 3), np.round(TIME, 2), np.cumsum(np.linspace(0.01, 0.1, 60))]
)
def test_even_rounded_and_changing_clocks_miss_nothing(clock):
    assert missing_samples(clock) == ""
    assert doubtful_unit(clock) == ""


def test_a_few_set_points_seconds_apart_are_a_clock_in_seconds():
    assert doubtful_unit(np.arange(5.0)) == ""

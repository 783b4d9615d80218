"""Time stamps that a file rounded are put back on the camera's grid; others stay as they are."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.formats import load_gait, load_torques
from exo_pin.gait import normative_gait
from exo_pin.gait.even_clock import even_clock

RATES = [24, 29.97, 30, 59.94, 60, 90, 119.88, 120, 150, 240]


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("start", [0.0, 0.4, 12.345])
def test_milliseconds_become_the_grid_that_was_rounded(rate, start):
    time = (np.arange(200) + round(start * rate)) / rate
    even = even_clock(np.round(time, 3))
    if even is None:
        even = np.round(time, 3)  # as near its grid as makes no difference
    step = np.diff(even)
    assert np.ptp(step) < 2e-4 / rate
    assert step.mean() == pytest.approx(1 / rate, rel=3e-5)
    assert np.abs(even - time).max() <= 1e-3


def test_a_whole_rate_is_met_exactly():
    time = np.arange(24, 175) / 60
    np.testing.assert_allclose(even_clock(np.round(time, 3)), time, atol=1e-12)


@given(st.integers(1, 4), st.floats(20, 300), st.floats(0, 100), st.integers(4, 400))
def test_no_stamp_moves_further_than_its_last_decimal(decimals, rate, start, n):
    time = np.unique(np.round(start + np.arange(n) / rate, decimals))
    even = even_clock(time) if len(time) > 1 else None
    if even is not None:
        assert np.abs(even - time).max() <= 0.6 * 10.0**-decimals + 1e-9
        assert np.ptp(np.diff(even)) < 1e-9


@pytest.mark.parametrize(
    "time",
    [
        np.arange(100) / 100,
        np.arange(100) / 60,
        np.array([0, 0.1, 0.3]),
        np.array([0, 0.1, 0.3, 0.4, 0.5, 0.7]),
        np.round(np.cumsum(np.random.default_rng(1).uniform(0.01, 0.03, 200)), 3),
        np.delete(np.round(np.arange(200) / 60, 3), [50]),
    ],
)
def test_even_and_truly_uneven_times_stay(time):
    assert even_clock(time) is None


def test_accelerations_of_rounded_stamps_are_those_of_the_walk(tmp_path):
    walk = normative_gait("free").repeated(2).sampled(60)
    time = 0.4 + np.arange(len(walk)) / 60
    names = [f"{name}_{side}" for side in "lr" for name in ("hip_flexion", "hip_adduction", "hip_rotation")]
    names += [f"{name}_{side}" for side in "lr" for name in ("knee_angle", "ankle_angle", "subtalar_angle")]
    q = np.degrees(walk.q[:, [0, 1, 2, 6, 7, 8, 3, 4, 5, 9, 10, 11]])

    def read(stamps, name):
        rows = ["\t".join(f"{x:.12g}" for x in (t, *row)) for t, row in zip(stamps, q, strict=True)]
        path = tmp_path / name
        path.write_text(
            "\n".join(["Coordinates", "inDegrees=yes", "endheader", "\t".join(["time", *names]), *rows])
        )
        return load_gait(path)

    exact, rounded = read(time, "exact.mot"), read(np.round(time, 3), "rounded.mot")
    assert exact.remarks == ()
    assert "evened to 60 Hz" in rounded.remarks[0]
    np.testing.assert_allclose(rounded.ddq, exact.ddq, atol=1e-4)


def test_torques_keep_the_clock_of_the_walk(tmp_path):
    path = tmp_path / "id.sto"
    rows = [f"{k / 60:.3f}\t{k}" for k in range(100)]
    path.write_text("\n".join(["Inverse Dynamics", "endheader", "time\thip_flexion_r_moment", *rows]))
    np.testing.assert_allclose(load_torques(path).time, np.arange(100) / 60, atol=1e-12)


def test_the_full_walk_has_the_published_accelerations(shared):
    """[rad/s^2] root mean square over the common frames; the angles themselves differ by up to 0.05 deg."""
    trial = shared / "opensim_subject01_walk/subject01_walk1_ik"
    published, full = load_gait(f"{trial}.mot"), load_gait(f"{trial}_full_opensim46.mot")
    rows = [int(np.abs(full.time - t).argmin()) for t in published.time]
    off = published.ddq[2:-2] - full.ddq[rows][2:-2]
    assert np.sqrt((off**2).mean(axis=0)).max() < 1.7

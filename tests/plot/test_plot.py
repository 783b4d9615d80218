"""Plots of walks: what is drawn are the walk's own numbers."""

import numpy as np
import pytest

from exo_pin import Torques, normative_gait
from exo_pin.errors import DescriptionError, UnknownNameError

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

WALK = normative_gait("slow")


@pytest.fixture(autouse=True)
def _closed():
    yield
    from matplotlib import pyplot

    pyplot.close("all")


def test_joints_are_drawn_in_degrees_left_and_right_within_their_band():
    from exo_pin import plot

    axes = plot.joints(WALK)
    for k, panel in enumerate(axes):
        left, right = panel.get_lines()
        np.testing.assert_array_equal(left.get_ydata(), np.degrees(WALK.q[:, k]))
        np.testing.assert_array_equal(right.get_ydata(), np.degrees(WALK.q[:, k + 6]))
        (band,) = panel.collections
        low, high = band.get_datalim(panel.transData).intervaly
        assert low < np.degrees(WALK.q[:, k]).min()
        assert high > np.degrees(WALK.q[:, k]).max()


def test_a_recording_has_no_band_and_a_time_axis():
    from dataclasses import replace

    from exo_pin import plot

    axes = plot.joints(replace(WALK, periodic=False))
    assert axes[0].get_xlabel() == "time [s]"
    assert not axes[0].collections


def test_torques_that_are_not_known_are_gaps():
    from exo_pin import plot

    tau = np.ones((len(WALK), 12))
    tau[3] = np.nan
    line = plot.torques(Torques(WALK.time, tau))[2].get_lines()[0]
    assert np.isnan(line.get_ydata()[3])


def test_a_cyclogram_closes_and_its_axes_are_named():
    from exo_pin import plot

    ax = plot.phase(WALK)
    left = ax.get_lines()[0]
    assert (left.get_xdata()[0], left.get_ydata()[0]) == (left.get_xdata()[-1], left.get_ydata()[-1])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("hip flexion [deg]", "knee flexion [deg]")


def test_wrong_axes_and_movements_are_refused():
    from exo_pin import plot

    with pytest.raises(DescriptionError):
        plot.joints(WALK, ax=[])
    with pytest.raises(UnknownNameError):
        plot.phase(WALK, x="elbow")

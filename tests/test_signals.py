"""Filters and gaps: what the frequency says, no lag, and never beyond the limit."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import signals
from exo_pin.anatomy import JOINTS
from exo_pin.errors import GaitError
from exo_pin.gait import SPEEDS, normative_gait

RATE = 100.0
TIME = np.arange(2000) / RATE
MIDDLE = slice(500, 1500)  # away from the ends' transients
HALF_POWER = 0.02  # of the amplitude: the correction for two passes is exact, the end effects are not


def gain(frequency, **settings):
    y = np.sin(2 * np.pi * frequency * TIME)
    return float(np.sqrt(2) * signals.lowpass(TIME, y, **settings)[MIDDLE].std())


@pytest.mark.parametrize("order", [2, 4, 6, 8])
@pytest.mark.parametrize("cutoff", [3.0, 6.0, 20.0])
def test_both_passes_together_halve_the_power_at_the_cut_off(order, cutoff):
    assert gain(cutoff, cutoff=cutoff, order=order) == pytest.approx(np.sqrt(0.5), abs=HALF_POWER)
    assert gain(cutoff / 6, cutoff=cutoff, order=order) > 0.97
    assert gain(2 * cutoff, cutoff=cutoff, order=order) < 0.5


def test_nothing_is_delayed_and_a_constant_stays(rng):
    y = np.stack([np.sin(2 * np.pi * TIME), np.full_like(TIME, 7.0)], axis=1)
    out = signals.lowpass(TIME, y)
    np.testing.assert_allclose(out[:, 1], 7.0, atol=1e-9)
    lags = [np.dot(out[MIDDLE, 0], np.roll(y[:, 0], k)[MIDDLE]) for k in range(-3, 4)]
    assert int(np.argmax(lags)) == 3


@pytest.mark.parametrize(
    ("time", "y", "settings", "match"),
    [
        (TIME, TIME, {"cutoff": 51}, "less than 50 Hz"),
        (TIME, TIME, {"cutoff": np.nan}, "cut-off is nan"),
        (TIME, TIME, {"order": 3}, "order is 3"),
        (TIME[:5], TIME[:5], {}, "too few"),
        (TIME**2, TIME, {}, "off an even grid"),
        (TIME, np.where(TIME > 10, np.nan, 1), {}, "gaps"),
    ],
)
def test_what_cannot_be_filtered_is_refused(time, y, settings, match):
    with pytest.raises(GaitError, match=match):
        signals.lowpass(time, y, **settings)


@pytest.mark.parametrize("rate", [60.0, 120.0])
def test_times_rounded_to_milliseconds_are_even_enough(rate):
    t = np.arange(300) / rate
    y = np.sin(2 * np.pi * t)
    np.testing.assert_allclose(signals.lowpass(np.round(t, 3), y), signals.lowpass(t, y), atol=1e-4)
    with pytest.raises(GaitError, match="off an even grid"):
        signals.lowpass(np.round(t, 2), y)


def test_gaps_are_filled_up_to_the_limit_only():
    y = np.sin(2 * np.pi * TIME)[:, None] * np.ones(2)
    holes = y.copy()
    holes[50:60, 0] = np.nan  # 0.11 s from sample to sample
    holes[300:340, 0] = np.nan  # 0.41 s
    holes[:5, 1] = np.nan  # open at the start
    done = signals.filled(TIME, holes, limit=0.2)
    assert (done.filled, done.left) == (10, 45)
    np.testing.assert_allclose(done.values[50:60, 0], y[50:60, 0], atol=0.02)
    assert np.isnan(done.values[300:340, 0]).all()
    assert np.isnan(done.values[:5, 1]).all()
    assert np.isnan(holes[50:60, 0]).all()  # the input stays as it was


def test_an_empty_curve_stays_empty():
    assert signals.filled([0, 1, 2], np.full((3, 1), np.nan)).left == 3


def test_a_spike_is_found_with_its_time_and_size(rng):
    y = np.sin(2 * np.pi * TIME) + 1e-4 * rng.normal(size=len(TIME))
    assert not signals.spikes(TIME, y).any()
    y[700] += 1.0
    y[1200] -= 0.5
    off = signals.spikes(TIME, y)
    assert np.flatnonzero(off).tolist() == [700, 1200]
    np.testing.assert_allclose(off[[700, 1200]], [1.0, -0.5], atol=1e-2)


def test_a_spike_is_found_in_uneven_time_too(rng):
    t = np.cumsum(rng.uniform(0.005, 0.015, 600))
    y = np.stack([np.sin(2 * np.pi * t), np.cos(3 * t)], axis=1)
    y[300, 1] += 0.2
    (found,) = signals.outliers(t, y, ("first", "second"), least=0.05)
    assert found.name == "second"
    assert found.time == pytest.approx(t[300])
    assert found.off == pytest.approx(0.2, abs=1e-2)


@pytest.mark.parametrize("samples", [25, 50, 100, 400])
@pytest.mark.parametrize("speed", SPEEDS)
def test_normal_walks_have_no_outliers_at_any_sampling(speed, samples):
    walk = normative_gait(speed, samples=samples).repeated(3)
    assert signals.outliers(walk.time, walk.q, JOINTS, least=np.radians(1)) == ()


def test_a_jump_is_an_outlier_and_too_few_samples_have_none():
    y = np.where(TIME > 10, 1.0, 0.0)[:, None]
    found = signals.outliers(TIME, y, ("step",), least=0.1)
    assert {round(outlier.time) for outlier in found} == {10}
    assert signals.outliers([0, 1, 2, 3], np.array([[0], [9], [0], [0]]), ("short",), least=0.1) == ()

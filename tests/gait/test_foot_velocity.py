"""Heel strikes move to where the foot falls fastest, and stay where no fall is seen."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.gait import Event
from exo_pin.gait.foot_velocity import FOOT_VELOCITY, at_largest_fall, slopes
from exo_pin.gait.zeni_method import ZENI

SAMPLE = 0.25  # of a sample: what the parabola through three slopes leaves


def falling(time, fastest, speed=0.3, lasts=0.15):
    """Both feet come down by a cosine, the left one fastest at that time [s]."""
    down = np.clip((time - fastest) / lasts, -0.5, 0.5)
    height = -speed * lasts / np.pi * np.sin(np.pi * down)
    return np.stack([height, np.zeros_like(time)], axis=1)


@given(fastest=st.floats(0.45, 0.55), early=st.floats(0.02, 0.06), rate=st.sampled_from([60, 100, 200]))
def test_a_strike_moves_to_the_largest_fall(fastest, early, rate):
    time = np.arange(rate) / rate
    found = at_largest_fall(
        time, falling(time, fastest), [Event(fastest - early, "heel_strike", "left", ZENI)]
    )
    assert found[0].time == pytest.approx(fastest, abs=SAMPLE / rate)
    assert found[0].source == FOOT_VELOCITY


def test_toe_offs_and_soft_landings_stay(rng):
    time = np.arange(100) / 100
    known = [Event(0.4, "toe_off", "left", ZENI), Event(0.47, "heel_strike", "right", ZENI)]
    assert at_largest_fall(time, falling(time, 0.5), known) == known
    slow = [Event(0.47, "heel_strike", "left", ZENI)]
    assert at_largest_fall(time, falling(time, 0.5, speed=0.02), slow) == slow


def test_noise_of_markers_moves_a_strike_by_a_frame_or_two(rng):
    time = np.arange(100) / 100
    found = []
    for _ in range(50):
        height = falling(time, 0.5) + rng.normal(0, 1e-3, (100, 2))
        found.append(at_largest_fall(time, height, [Event(0.47, "heel_strike", "left", ZENI)])[0].time)
    assert np.abs(np.array(found) - 0.5).max() < 0.033  # the accuracy that is promised against plates


def test_slopes_are_those_of_a_line_also_where_samples_are_uneven(rng):
    time = np.sort(np.r_[0, rng.uniform(0, 1, 80), 1])
    grid, slope = slopes(time, np.stack([3 * time, -time], axis=1), 0.025)
    np.testing.assert_allclose(slope, np.tile([3, -1], (len(grid), 1)), atol=1e-9)

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.anatomy import SIDES
from exo_pin.gait import Event, Gait, normative_gait
from exo_pin.ground import estimated_stance, lowest_corners, stance_from_events, standing

NEARLY_AS_LOW = 0.0101  # [m]: a foot this much higher than the other does not stand


def walk(*events, periodic=False, n=50):
    time = np.arange(n) * 0.02
    return Gait(time, np.zeros((n, 12)), events=events, periodic=periodic)


def alternating(side, strike, off):
    return Event(strike, "heel_strike", side), Event(off, "toe_off", side)


def test_intervals_agree_with_the_gaits_own_stance():
    gait = normative_gait()
    intervals = stance_from_events(gait)
    for side in SIDES:
        assert np.array_equal(standing(intervals, side, gait.time), gait.stance(side))


def test_a_stance_over_the_end_of_the_cycle_is_cut_in_two():
    gait = walk(*alternating("left", 0.8, 0.4), *alternating("right", 0.1, 0.7), periodic=True)
    assert stance_from_events(gait) == {
        "left": ((0.0, 0.4), (0.8, pytest.approx(1.0))),
        "right": ((0.1, 0.7),),
    }


def test_a_recording_that_starts_in_stance_stands_from_its_start():
    gait = walk(Event(0.4, "toe_off", "left"), *alternating("right", 0.2, 0.6))
    assert stance_from_events(gait)["left"] == ((0.0, 0.4),)


def test_without_events_of_both_feet_nothing_is_claimed():
    assert stance_from_events(walk()) is None
    assert stance_from_events(walk(*alternating("left", 0.2, 0.6))) is None


def test_the_estimate_always_has_a_foot_on_the_ground_and_the_lower_one():
    gait = walk()
    phase = 2 * np.pi * gait.time / gait.duration
    heights = {"left": 0.1 * np.sin(phase), "right": -0.1 * np.sin(phase)}
    found = {side: standing(estimated_stance(gait, heights), side, gait.time) for side in SIDES}
    assert (found["left"] | found["right"])[:-1].all()  # the last sample ends the last interval
    lower = heights["left"] < heights["right"] - NEARLY_AS_LOW
    assert (found["left"] & ~found["right"])[:-1][lower[:-1]].all()


def test_the_lowest_corner_is_taken_per_side():
    positions = np.zeros((3, 8, 3))
    positions[:, 2, 2], positions[:, 5, 2] = -0.5, -0.25
    low = lowest_corners(positions)
    assert low["left"].tolist() == [-0.5] * 3
    assert low["right"].tolist() == [-0.25] * 3

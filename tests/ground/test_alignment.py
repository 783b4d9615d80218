"""A second walk laid over a first: phases, ends and places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from exo_pin.gait import Gait
from exo_pin.ground import aligned

SAME = 1e-9  # resampling a band-limited cycle on its own samples changes rounding only


def test_a_slower_cycle_is_laid_over_the_first(gait):
    fitted = aligned(gait, gait.slowed(1.7))
    assert fitted.q == pytest.approx(gait.q, abs=SAME)
    assert np.array_equal(fitted.time, gait.time)


def test_cycles_meet_at_the_left_heel_strike(gait):
    shift = 30
    events = tuple(replace(e, time=(e.time + gait.time[shift]) % gait.duration) for e in gait.events)
    late = Gait(gait.time, np.roll(gait.q, shift, axis=0), events=events, periodic=True)
    assert aligned(gait, late).q == pytest.approx(gait.q, abs=SAME)


def test_a_shorter_recording_waits_at_its_end(gait):
    first = Gait(np.arange(50) * 0.01, gait.q[:50])
    short = Gait(np.arange(20) * 0.01, gait.q[:20])
    fitted = aligned(first, short)
    assert fitted.q[:20] == pytest.approx(short.q, abs=1e-6)
    assert (fitted.q[20:] == fitted.q[-1]).all()


def test_a_walk_recorded_elsewhere_is_brought_beside_the_first(gait):
    turned = np.array([[0.0, -1, 0, 3], [1, 0, 0, -2], [0, 0, 1, 0], [0, 0, 0, 1]])
    elsewhere = replace(gait, base=turned @ gait.base)
    assert aligned(gait, elsewhere).base == pytest.approx(gait.base, abs=SAME)

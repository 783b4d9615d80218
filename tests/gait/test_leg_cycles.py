"""The cycle of each leg and the times of its stance: mean, spread, estimate, open ends."""

from dataclasses import replace

import numpy as np
import pytest

from exo_pin.gait import Event, Gait, leg_cycles, normative_gait, stance_times

FOURIER = 1e-9  # [rad] interpolation of a band-limited curve at its own samples


def test_legs_of_a_normal_walk_are_its_curves(gait):
    left, right = leg_cycles(gait)
    np.testing.assert_allclose(left.q[:-1], gait.q[:, :6], atol=FOURIER)
    np.testing.assert_allclose(right.q[:-1], np.roll(gait.q[:, 6:], -50, axis=0), atol=FOURIER)
    assert left.stance == pytest.approx(59.0)


def test_legs_of_several_cycles_have_a_spread_and_one_step_gives_an_estimate(recording):
    left, _ = leg_cycles(recording)
    assert left.sd is not None
    assert left.sd.max() < 1e-3  # the cycles are copies; resampling differs a little
    keep = recording.time < 0.6 * recording.time[-1] / 2.5
    step = replace(
        recording,
        time=recording.time[keep],
        q=recording.q[keep],
        base=recording.base[keep],
        events=[e for e in recording.events if e.time <= recording.time[keep][-1]],
    )
    estimated = leg_cycles(step)
    assert all("no whole cycle" in leg.note for leg in estimated)
    T = 2 * (step.events[2].time - step.events[0].time)
    np.testing.assert_allclose(np.nanmax(estimated[0].percent), 100 * step.time[-1] / T)


def test_stance_is_closed_at_the_ends_of_a_recording_and_around_a_cycle(gait):
    assert stance_times(gait, "left") == ((0.0, pytest.approx(0.59 * gait.duration)),)
    (first, second) = stance_times(gait, "right")
    assert first[0] == 0.0
    assert second[1] == pytest.approx(gait.duration)
    events = [Event(0.3, "toe_off", "left"), Event(0.7, "heel_strike", "left")]
    walk = Gait(np.linspace(0, 1, 20), np.zeros((20, 12)), events=events)
    assert stance_times(walk, "left") == ((0.0, 0.3), (0.7, 1.0))
    assert stance_times(walk, "right") == ()


def test_the_times_of_a_stance_count_from_the_first_sample(recording):
    late = replace(
        recording,
        time=recording.time + 5.0,
        events=[replace(event, time=event.time + 5.0) for event in recording.events],
    )
    for side in ("left", "right"):
        np.testing.assert_allclose(stance_times(late, side), stance_times(recording, side), atol=1e-12)


def test_a_foot_without_a_cycle_is_placed_by_the_stride_of_the_other():
    """The left foot strikes twice, the right one once and late: twice the step time is not the stride."""
    walk = normative_gait("free").repeated(2)
    T = walk.duration / 2
    keep = walk.time <= 1.2 * T
    events = [Event(0.0, "heel_strike", "left"), Event(T, "heel_strike", "left")]
    events.append(Event(0.6 * T, "heel_strike", "right"))
    left, right = leg_cycles(Gait(walk.time[keep], walk.q[keep], events=tuple(events)))
    assert "one cycle" in left.note
    assert f"the left foot's stride, {T:.3f} s" in right.note
    assert np.nanmax(right.percent) < 100

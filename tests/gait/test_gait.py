"""A Gait refuses unusable data, never changes, and differentiates, resamples and mirrors truthfully."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.anatomy import JOINTS
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import Event, Gait, normative_gait
from exo_pin.gait.heading import heading, turned
from exo_pin.gait.rigid_poses import about, angle_of
from exo_pin.gait.time_series import runs

ROUNDING = 1e-12  # [rad, m] sums of a few dozen terms of size 1
SPECTRAL = 1e-9  # [rad/s^2] rounding times the square of the highest frequency
PERIOD = 1.2


def turn(axis, angle):
    """Rotations by Rodrigues' formula: (n, 3, 3)."""
    K = np.cross(np.eye(3), axis)
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * K + (1 - c) * K @ K


def poses(rotation, position):
    T = np.tile(np.eye(4), (len(rotation), 1, 1))
    T[:, :3, :3], T[:, :3, 3] = rotation, position
    return T


@pytest.fixture
def curve(rng):
    """Band-limited joint curves and their first two derivatives as functions of time."""
    a, b = rng.uniform(-0.1, 0.1, (2, 8, 12))
    w = 2 * np.pi * np.arange(1, 9) / PERIOD

    def at(t, order=0):
        phase = np.multiply.outer(t, w) + order * np.pi / 2
        return np.cos(phase) @ (w[:, None] ** order * a) + np.sin(phase) @ (w[:, None] ** order * b)

    return at


@pytest.fixture
def cycle(curve):
    time = PERIOD * np.arange(40) / 40
    phase = 2 * np.pi * time / PERIOD
    base = poses(
        turn([0, 0, 1], 0.2 * np.sin(phase)), np.stack([0 * time, 0.03 * np.sin(phase), 0.9 + 0 * time], 1)
    )
    events = [
        Event(0.0, "heel_strike", "left"),
        Event(0.7, "toe_off", "left"),
        Event(0.1, "toe_off", "right"),
    ]
    events += [Event(0.6, "heel_strike", "right", "treadmill")]
    return Gait(time, curve(time), base=base, events=events, periodic=True, source="test")


@pytest.fixture
def recording(rng):
    """A walk with uneven time steps that moves forward and turns."""
    time = 0.4 + np.cumsum(rng.uniform(0.008, 0.012, 120))
    q = 0.3 * np.sin(np.multiply.outer(time, np.linspace(1, 6, 12)))
    base = poses(
        turn([0, 0, 1], 0.5 * time), np.stack([1.3 * time, 0 * time, 0.9 + 0.02 * np.sin(9 * time)], 1)
    )
    return Gait(time, q, base=base, events=[Event(time[30], "toe_off", "left")])


def refused(match, time=(0.0, 0.1, 0.2), q=None, **more):
    with pytest.raises(GaitError, match=match):
        Gait(time, np.zeros((len(time), 12)) if q is None else q, **more)


def test_unusable_times_are_refused_with_the_frame():
    refused("at least 2", time=[0.0])
    refused("frame 1 is nan", time=[0, np.nan, 1])
    refused("from frame 1 .* to frame 2", time=[0, 1, 1])
    refused("frame 2 is 1e\\+300", time=[0, 1, 1e300])
    refused("not an array of real numbers", time=["a", "b"])
    refused("shape", time=np.zeros((3, 2)))


def test_unusable_angles_are_refused_with_frame_and_joint():
    q = np.zeros((3, 12))
    q[2, JOINTS.index("right_knee_flexion")] = np.nan
    refused("right_knee_flexion of frame 2 is nan", q=q)
    q[2] = 0
    q[1, 0] = 30.0
    refused("left_hip_flexion of frame 1 is 30 rad.*degrees", q=q)
    refused(r"shape \(3, 6\), expected \(3, 12\)", q=np.zeros((3, 6)))
    refused("not an array", q=[[0.0] * 12, [0.0] * 11, [0.0] * 12])


def test_a_base_that_is_not_rigid_is_refused_with_the_frame():
    base = np.tile(np.eye(4), (3, 1, 1))
    for entry, value in (
        ((1, 0, 0), 1.01),
        ((1, 0, 3), np.inf),
        ((1, 3, 0), 1.0),
        ((1, 1, 1), -1.0),
        ((1, 0, 0), 1e300),
    ):
        wrong = base.copy()
        wrong[entry] = value
        refused("base of frame 1", base=wrong)
    refused("expected \\(3, 4, 4\\)", base=base[:2])


def test_a_periodic_gait_starts_at_zero_and_is_even():
    refused("starts at 0", time=[1, 2, 3], periodic=True)
    refused("frame 1 lies", time=[0, 1, 3], periodic=True)


def test_events_outside_the_walk_or_of_unknown_kind_are_refused():
    refused("outside the walk", events=[Event(0.21, "toe_off", "left")])
    refused("outside the walk", events=[Event(0.31, "toe_off", "left")], periodic=True)
    assert Gait(
        [0, 0.1, 0.2], np.zeros((3, 12)), events=[Event(0.29, "toe_off", "left")], periodic=True
    ).events
    with pytest.raises(GaitError, match="kind is 'foot_off', expected 'heel_strike' or 'toe_off'"):
        Event(0.0, "foot_off", "left")
    with pytest.raises(GaitError, match="side is 'l'"):
        Event(0.0, "toe_off", "l")
    with pytest.raises(GaitError, match="finite"):
        Event(float("nan"), "toe_off", "left")


def test_a_gait_cannot_be_changed_from_outside():
    time, q = np.array([0.0, 1.0]), np.zeros((2, 12))
    gait = Gait(time, q)
    q += 1
    time += 5
    assert gait.q.max() == 0
    assert gait.time[0] == 0
    for array in (gait.q, gait.time, gait.dq, gait.ddq):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_a_gait_prints_as_one_line(cycle):
    assert repr(cycle) == "<Gait 40 samples, 1.200 s, periodic, a base, 4 events, source='test'>"


def test_duration_of_a_cycle_includes_the_step_back_to_its_start(cycle, recording):
    assert cycle.duration == pytest.approx(PERIOD, abs=ROUNDING)
    assert recording.duration == recording.time[-1] - recording.time[0]


@pytest.mark.parametrize("n", [17, 18, 40, 41])
def test_derivatives_of_a_band_limited_cycle_are_exact(curve, n):
    time = PERIOD * np.arange(n) / n
    gait = Gait(time, curve(time), periodic=True)
    np.testing.assert_allclose(gait.dq, curve(time, 1), atol=SPECTRAL)
    np.testing.assert_allclose(gait.ddq, curve(time, 2), atol=SPECTRAL)


def test_differences_on_uneven_time_are_exact_for_the_polynomials_of_their_order(rng):
    time = np.cumsum(rng.uniform(0.05, 0.2, 9))
    t = time[:, None] - time[0]
    c = rng.uniform(-0.1, 0.1, (4, 12))
    square = Gait(time, c[0] + c[1] * t + c[2] * t**2)
    np.testing.assert_allclose(square.dq, c[1] + 2 * c[2] * t, atol=SPECTRAL)
    cubic = Gait(time, c[0] + c[1] * t + c[2] * t**2 + c[3] * t**3)
    np.testing.assert_allclose(cubic.ddq, 2 * c[2] + 6 * c[3] * t, atol=SPECTRAL)


def test_differences_converge_with_the_square_of_the_step():
    def error(n, order):
        time = np.linspace(0, 1, n) + 0.3 / n * np.sin(np.linspace(0, 20, n))  # uneven
        gait = Gait(time, np.repeat(np.sin(3 * time)[:, None], 12, axis=1))
        exact = (3 * np.cos(3 * time), -9 * np.sin(3 * time))[order - 1]
        return np.abs((gait.dq, gait.ddq)[order - 1][:, 0] - exact).max()

    for order in (1, 2):
        assert error(400, order) < error(200, order) / 3  # second order: a quarter, less the grid's wiggle


def test_two_samples_have_a_slope_and_no_acceleration():
    gait = Gait([0, 2], [[0.0] * 12, [1.0] * 12])
    np.testing.assert_allclose(gait.dq, 0.5)
    assert not gait.ddq.any()


@pytest.mark.parametrize("n", [7, 40, 80, 97, 400])
def test_a_resampled_cycle_lies_on_the_band_limited_curve(cycle, curve, n):
    again = cycle.resampled(n)
    np.testing.assert_allclose(again.q, curve(again.time), atol=ROUNDING)
    assert again.duration == pytest.approx(cycle.duration, rel=ROUNDING)
    assert again.events == cycle.events


def test_a_cycle_at_the_highest_frequency_survives_resampling():
    time = np.arange(4) / 4
    gait = Gait(time, np.repeat([[0.1], [-0.1], [0.1], [-0.1]], 12, axis=1), periodic=True)
    np.testing.assert_allclose(gait.resampled(8).q[::2], gait.q, atol=ROUNDING)
    np.testing.assert_allclose(gait.resampled(8).q[1::2], 0, atol=ROUNDING)


def test_a_resampled_recording_keeps_its_samples_and_is_smooth(recording):
    even = recording.resampled(201)
    assert even.time[0] == recording.time[0]
    assert even.time[-1] == recording.time[-1]
    truth = 0.3 * np.sin(np.multiply.outer(even.time, np.linspace(1, 6, 12)))
    # one-sided slopes at the ends: h^3 f''' / 10 at 12 ms steps and 6 rad/s
    np.testing.assert_allclose(even.q, truth, atol=1e-5)


def test_a_sampled_recording_has_its_samples_where_a_camera_would(recording):
    part = replace(recording, time=recording.time + 0.0037, events=())
    even = part.sampled(50)
    np.testing.assert_allclose(even.time * 50, np.round(even.time * 50), atol=1e-9)
    assert part.time[0] <= even.time[0] < part.time[0] + 0.02
    assert part.time[-1] - 0.02 < even.time[-1] <= part.time[-1]
    truth = 0.3 * np.sin(np.multiply.outer(even.time - 0.0037, np.linspace(1, 6, 12)))
    np.testing.assert_allclose(even.q, truth, atol=1e-5)


def test_a_sampled_cycle_still_repeats_and_absurd_rates_are_refused(cycle):
    again = cycle.sampled(100)
    assert again.periodic
    assert len(again) == round(100 * cycle.duration)
    for rate in (0, -1, np.nan, 1e12, 0.1):
        with pytest.raises(GaitError, match=r"sampled at|rate is"):
            cycle.sampled(rate)


def test_a_resampled_base_follows_the_turning_pelvis(recording, cycle):
    even = recording.resampled(300)
    np.testing.assert_allclose(even.base[:, :3, :3], turn([0, 0, 1], 0.5 * even.time), atol=1e-6)
    np.testing.assert_allclose(even.base[:, 0, 3], 1.3 * even.time, atol=ROUNDING)
    fine = cycle.resampled(173)
    expected = turn([0, 0, 1], 0.2 * np.sin(2 * np.pi * fine.time / PERIOD))
    np.testing.assert_allclose(fine.base[:, :3, :3], expected, atol=ROUNDING)


def test_base_velocity_is_linear_first_in_world_axes(recording, cycle):
    v = recording.base_velocity
    np.testing.assert_allclose(v[:, 0], 1.3, atol=SPECTRAL)
    np.testing.assert_allclose(v[:, 3:], [[0, 0, 0.5]] * len(v), atol=1e-5)  # differences of a sine at 10 ms
    w = 2 * np.pi / PERIOD
    np.testing.assert_allclose(cycle.base_velocity[:, 5], 0.2 * w * np.cos(w * cycle.time), atol=SPECTRAL)
    np.testing.assert_allclose(
        cycle.base_acceleration[:, 1], -0.03 * w**2 * np.sin(w * cycle.time), atol=SPECTRAL
    )
    assert Gait([0, 1], np.zeros((2, 12))).base_velocity is None


def test_a_repeated_cycle_is_the_same_walk_for_longer(cycle):
    three = cycle.repeated(3)
    assert three.duration == pytest.approx(3 * PERIOD)
    np.testing.assert_array_equal(three.q[40:80], cycle.q)
    np.testing.assert_allclose(three.dq[80:], cycle.dq, atol=SPECTRAL)
    assert len(three.events) == 3 * len(cycle.events)
    np.testing.assert_array_equal(three.stance("right")[80:], cycle.stance("right"))
    with pytest.raises(GaitError, match="from 1 to"):
        cycle.repeated(0)


def test_a_recording_cannot_be_repeated(recording):
    with pytest.raises(GaitError, match="not periodic"):
        recording.repeated(2)


def test_mirroring_swaps_sides_and_twice_is_nothing(cycle):
    mirror = cycle.mirrored()
    np.testing.assert_array_equal(mirror.q[:, :6], cycle.q[:, 6:])
    np.testing.assert_array_equal(mirror.base[:, 1, 3], -cycle.base[:, 1, 3])
    np.testing.assert_array_equal(mirror.stance("left"), cycle.stance("right"))
    np.testing.assert_allclose(
        mirror.base_velocity[:, 5], -cycle.base_velocity[:, 5], atol=SPECTRAL
    )  # turns back
    again = mirror.mirrored()
    np.testing.assert_array_equal(again.q, cycle.q)
    np.testing.assert_array_equal(again.base, cycle.base)
    assert again.events == cycle.events


@given(st.floats(0.1, 10))
def test_slowing_stretches_time_and_divides_velocities(f):
    time = np.array([1.0, 1.1, 1.3])
    gait = Gait(time, np.outer(time - 1, np.ones(12)), events=[Event(1.3, "toe_off", "left")])
    slow = gait.slowed(f)
    assert slow.time[0] == 1
    assert slow.duration == pytest.approx(f * gait.duration)
    np.testing.assert_allclose(slow.dq, gait.dq / f)
    assert slow.events[0].time == slow.time[-1]


def test_impossible_factors_are_refused(cycle):
    for f in (0, -1, np.nan, np.inf):
        with pytest.raises(GaitError, match="above 0"):
            cycle.slowed(f)
    with pytest.raises(GaitError, match="from 2 to"):
        cycle.resampled(1)


def test_stance_lasts_from_heel_strike_to_toe_off_also_over_the_end_of_the_cycle(cycle):
    left, right = cycle.stance("left"), cycle.stance("right")
    np.testing.assert_array_equal(left, cycle.time < 0.7)
    np.testing.assert_array_equal(right, (cycle.time < 0.1 - 1e-9) | (cycle.time > 0.6 - 1e-9))


def test_stance_of_a_recording_before_its_first_event_is_what_that_event_ends(recording):
    np.testing.assert_array_equal(recording.stance("left"), np.arange(120) < 30)


def test_stance_without_usable_events_is_an_error(recording):
    with pytest.raises(GaitError, match="no events of the right foot"):
        recording.stance("right")
    with pytest.raises(UnknownNameError):
        recording.stance("lfet")
    twice = [Event(0.0, "toe_off", "left"), Event(0.1, "toe_off", "left")]
    with pytest.raises(GaitError, match="take turns"):
        Gait([0, 0.1], np.zeros((2, 12)), events=twice).stance("left")


@pytest.mark.parametrize("degrees", [-140.0, 0.0, 90.0])
def test_the_heading_turns_with_the_walk(degrees):
    walk = normative_gait()
    assert np.degrees(heading(turned(walk, np.radians(degrees)))) == pytest.approx(degrees, abs=1e-9)
    back = turned(turned(walk, np.radians(degrees)), -np.radians(degrees))
    np.testing.assert_allclose(back.base, walk.base, atol=1e-15)


def test_a_walk_that_turns_around_or_holds_the_pelvis_has_no_heading():
    walk = normative_gait()
    angle = np.linspace(0, 2 * np.pi, len(walk))
    base = np.tile(np.eye(4), (len(walk), 1, 1))
    base[:, :2, :2] = np.moveaxis([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]], 2, 0)
    assert heading(replace(walk, base=base)) is None
    assert heading(replace(walk, base=None)) is None


def test_a_turn_about_an_axis_has_its_angle_and_leaves_the_axis_where_it_is(rng):
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    angles = np.array([0.0, 1e-12, 1e-5, 0.3, 2.0, 3.1])
    R = about(axis, angles)
    assert np.abs(R - turn(axis, angles)).max() <= ROUNDING
    assert R @ axis == pytest.approx(np.tile(axis, (len(angles), 1)), abs=ROUNDING)
    assert angle_of(R) == pytest.approx(angles, abs=1e-15, rel=1e-4)  # an arc cosine loses 1e-8
    assert about(axis, 0.3) == pytest.approx(R[3], abs=ROUNDING)


def test_runs_begin_and_end_where_marks_do():
    mask = np.array([1, 0, 1, 1, 0, 0, 1], dtype=bool)
    assert runs(mask) == [(0, 1), (2, 4), (6, 7)]
    assert runs(~mask) == [(1, 2), (4, 6)]
    assert runs(mask[:0]) == []


def test_remarks_on_the_file_stay_with_every_walk_that_is_made_of_it():
    walk = replace(normative_gait("free"), remarks=("the knee was held",))
    for made in (walk.resampled(50), walk.mirrored(), walk.slowed(2.0), walk.repeated(2)):
        assert made.remarks == ("the knee was held",)

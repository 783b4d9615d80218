"""Cycles, spatiotemporal numbers, force-plate contacts and plausibility: known walks give known numbers."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import (
    SPEEDS,
    Event,
    Gait,
    against_normal,
    cycles,
    force_plates,
    implausibilities,
    normal,
    normative_gait,
    published_ranges,
    side_with_more_strides,
    spatiotemporal,
)
from exo_pin.kinematics import spatiotemporal as of_walk
from exo_pin.robot import load_robot

CURVE = np.radians(0.05)  # [rad] cubic pieces through 100 samples of a smooth cycle
EXACT = 1e-9
STRIDE, WIDTH, PERIOD = 1.4, 0.1, 1.1  # [m, m, s] of the made-up walk below


def recording(walk, k=4, noise=None):
    """`k` cycles of a periodic gait as a recording that is not periodic."""
    long = walk.repeated(k)
    q = long.q if noise is None else long.q + noise
    return Gait(long.time, q, base=long.base, events=long.events, source="made up")


def heels(belt=0.0, heading=0.0, shift=0.5):
    """Time, heels (n, 2, 3) and events of feet that rest for 60 % and glide for 40 % of the cycle."""
    time = np.linspace(0, 5 * PERIOD, 2001)
    out, events = np.zeros((len(time), 2, 3)), []
    for k, side in enumerate(SIDES):
        phase = time / PERIOD - shift * k
        swing = np.clip((phase % 1 - 0.6) / 0.4, 0, 1)
        out[:, k, 0] = STRIDE * (np.floor(phase) + swing + shift * k) - belt * time
        out[:, k, 1] = WIDTH * (0.5 - k)
        for n in range(-1, 6):
            strike, off = PERIOD * (n + shift * k), PERIOD * (n + shift * k + 0.6)
            events += [Event(strike, "heel_strike", side), Event(off, "toe_off", side)]
    c, s = np.cos(heading), np.sin(heading)
    out[:, :, :2] = out[:, :, :2] @ np.array([[c, s], [-s, c]])
    return time, out, [e for e in events if 0 <= e.time <= time[-1]]


@pytest.mark.parametrize("side", SIDES)
def test_every_cycle_of_a_periodic_walk_is_that_cycle(side):
    walk = normative_gait("free")
    found = cycles(recording(walk), side)
    assert len(found) == 3
    assert found.q.shape == (3, 101, 12)
    strike = next(e.time for e in walk.events if e.side == side and e.kind == "heel_strike")
    shifted = np.roll(walk.q, -round(strike / walk.duration * len(walk)), axis=0)
    np.testing.assert_allclose(found.mean[:-1], shifted, atol=CURVE)
    assert np.nanmax(found.sd) < CURVE
    np.testing.assert_allclose(found.duration, walk.duration, atol=EXACT)
    assert found.outliers == ()


def test_the_mean_cycle_is_a_gait_again():
    walk = normative_gait("free")
    mean = cycles(recording(walk), "left").average()
    assert mean.periodic
    np.testing.assert_allclose(mean.q, walk.q, atol=CURVE)
    np.testing.assert_allclose(mean.base, walk.base, atol=CURVE)
    assert sorted((e.kind, e.side, round(e.time, 6)) for e in mean.events) == sorted(
        (e.kind, e.side, round(e.time, 6)) for e in walk.events
    )
    one = cycles(walk, "left")
    assert len(one) == 1
    assert np.isnan(one.sd).all()


def test_the_mean_pelvis_walks_on_the_spot_wherever_the_walk_went():
    walk = normative_gait("free")
    gait = recording(walk)
    c, s = np.cos(2.0), np.sin(2.0)
    there = np.eye(4)
    there[:2, :2] = [[c, -s], [s, c]]
    base = gait.base.copy()
    base[:, :2, 3] += 1.2 * gait.time[:, None] * [1.0, 0.0] + [5.0, -3.0]
    moved = replace(gait, base=there @ base)
    np.testing.assert_allclose(cycles(moved, "left").average().base, walk.base, atol=CURVE)
    still = replace(gait, base=None)
    assert cycles(still, "left").average().base is None


def test_noise_shows_in_the_spread_and_an_odd_cycle_is_named(rng):
    walk = normative_gait("free")
    noise = np.radians(1.0) * rng.normal(size=(600, 12))
    found = cycles(recording(walk, 6, noise), "left")
    assert np.degrees(found.sd.mean()) == pytest.approx(1.0, abs=0.2)  # 5 cycles of 1 degree of noise
    noise[210:290, 3] += np.radians(40)
    assert cycles(recording(walk, 6, noise), "left").outliers == (2,)


def test_a_pause_is_no_cycle_and_a_walk_without_strikes_has_none():
    walk = recording(normative_gait("free"), 6)
    T = walk.duration / 6
    events = [e for e in walk.events if not T < e.time < 5.05 * T]  # four strides without a strike
    paused = Gait(walk.time, walk.q, events=[*events, Event(T * 1.0, "heel_strike", "left")])
    with pytest.raises(GaitError, match="no gait cycles found"):
        cycles(Gait(walk.time, walk.q), "left")
    with pytest.raises(UnknownNameError, match="side"):
        cycles(paused, "middle")


@pytest.mark.parametrize("belt", [0.0, 1.0])
@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_lengths_are_over_the_ground_whatever_the_heading_or_the_belt(belt, heading):
    numbers = spatiotemporal(*heels(belt, heading))
    expected = {
        "stride_length": STRIDE,
        "left_step_length": STRIDE / 2,
        "right_step_length": STRIDE / 2,
        "step_width": WIDTH,
        "speed": STRIDE / PERIOD,
        "cadence": 120 / PERIOD,
        "stride_time": PERIOD,
        "left_stance": 60,
        "right_swing": 40,
        "double_support": 20,
        "step_length_symmetry": 0,
    }
    for name, value in expected.items():
        assert numbers[name].mean == pytest.approx(value, abs=1e-6), name
    assert numbers["stride_length"].sd == pytest.approx(0, abs=1e-6)


def test_the_foot_with_more_strides_counts_only_strides_and_is_left_of_equals():
    walk = normative_gait("free").repeated(4)
    recording = Gait(walk.time, walk.q, events=walk.events)
    assert side_with_more_strides(recording) == "left"  # the first strike is the left foot's
    late = Gait(walk.time, walk.q, events=[e for e in walk.events if e.side == "right" or e.time > 2.0])
    assert side_with_more_strides(late) == "right"
    assert side_with_more_strides(walk) == "left"
    offs = [e for e in walk.events if (e.side, e.kind) == ("left", "toe_off")]
    without = Gait(walk.time, walk.q, events=[e for e in walk.events if e != offs[1]])
    assert side_with_more_strides(without) == "right"  # a left stride without its toe-off is none


def test_steps_of_a_periodic_walk_are_counted_once():
    numbers = of_walk(load_robot(), normative_gait("free"))
    assert {name: number.n for name, number in numbers.items() if name != "stride_length"} == {
        name: 2 if name in ("cadence", "speed", "stride_time", "step_width", "double_support") else 1
        for name in numbers
        if name != "stride_length"
    }
    assert numbers["left_step_length"].mean == pytest.approx(numbers["right_step_length"].mean, rel=0.01)


def test_symmetry_has_a_spread_over_the_cycles(rng):
    time, path, events = heels()
    late = [replace(e, time=e.time + 0.02 * rng.normal()) for e in events if 0.2 < e.time < time[-1] - 0.2]
    found = spatiotemporal(time, path, late)["step_time_symmetry"]
    assert found.n > 2
    assert 0 < found.sd < 20


@pytest.mark.parametrize("legs", [0.7, 1.0, 1.4])
def test_over_ground_the_speed_is_the_persons_whatever_legs_the_model_has(legs):
    """Feet of legs of another length seem to slide; over ground that is no treadmill."""
    time, path, events = heels()
    pelvis = np.stack([STRIDE / PERIOD * time, 0 * time], axis=1)
    seen = pelvis[:, None] + legs * (path[..., :2] - pelvis[:, None])
    numbers = spatiotemporal(time, seen, events, pelvis=pelvis)
    assert numbers["speed"].mean == pytest.approx(STRIDE / PERIOD, abs=1e-6)


def test_a_limp_shows_in_step_time_and_symmetry():
    numbers = spatiotemporal(*heels(shift=0.4))
    assert numbers["right_step_time"].mean == pytest.approx(0.4 * PERIOD)
    assert numbers["left_step_time"].mean == pytest.approx(0.6 * PERIOD)
    assert numbers["step_time_symmetry"].mean == pytest.approx(40)


LEG = 0.93  # [m]


def test_numbers_are_compared_with_published_ranges_that_name_their_source():
    time, path, events = heels()
    numbers = spatiotemporal(time, path, events)
    assert against_normal(numbers, leg_length=LEG)["speed"] == "within"
    usual = normal(numbers, leg_length=LEG)
    child = normal(numbers, leg_length=0.68, stature=1.34)
    sources = {norm.source for norm in [*usual.values(), *child.values()]}
    assert sources == set(published_ranges.CITATIONS)
    assert {name for name, norm in usual.items() if norm.source == "Schwartz 2008"} >= {
        "cadence",
        "stride_length",
        "left_step_length",
        "right_stance",
        "left_swing",
        "double_support",
    }
    assert "step_time_symmetry" not in usual  # nobody's numbers were checked
    slow = spatiotemporal(time, path * 0.5, events)
    assert against_normal(slow, leg_length=LEG)["speed"] == "below"
    assert against_normal(slow, leg_length=LEG)["left_step_length"] == "below"


def test_the_speed_of_a_child_is_compared_with_children():
    """Dusing & Thorpe 2007: 0.8205 +- 0.2528 to 1.3363 +- 0.1544 m/s; no stature: an adult."""
    numbers = spatiotemporal(*heels())
    quick = {"speed": numbers["speed"]._replace(mean=1.48)}
    assert against_normal(quick, leg_length=0.68, stature=1.34) == {"speed": "within"}
    for stature in (1.44, 1.75, float("nan")):
        assert against_normal(quick, leg_length=LEG, stature=stature) == {"speed": "above"}
    child = normal(quick, leg_length=0.68, stature=1.34)["speed"]
    assert (child.low, child.high) == pytest.approx((0.315, 1.645), abs=1e-3)


def test_ranges_follow_the_leg_and_the_speed():
    """Dimensionless numbers: twice the leg and root two the speed is the same walk, twice as large."""
    time, path, events = heels()
    numbers = spatiotemporal(time, path, events)
    large = spatiotemporal(
        time * np.sqrt(2), path * 2, [replace(e, time=e.time * np.sqrt(2)) for e in events]
    )
    small_range, large_range = normal(numbers, leg_length=LEG), normal(large, leg_length=2 * LEG)
    assert large_range["stride_length"].low == pytest.approx(2 * small_range["stride_length"].low)
    assert large_range["cadence"].high == pytest.approx(small_range["cadence"].high / np.sqrt(2))
    assert large_range["left_stance"].low == pytest.approx(small_range["left_stance"].low)
    crawl = spatiotemporal(time * 10, path, [replace(e, time=e.time * 10) for e in events])
    assert set(normal(crawl, leg_length=LEG)) == {"speed", "step_width"}  # slower than anybody in the source
    assert set(normal(numbers, leg_length=float("nan"))) == {"speed"}


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_source_walk_lies_within_its_own_ranges(speed):
    """Events and cadence of the normal walk are Schwartz's own means, its lengths this body's."""
    robot = load_robot()
    verdicts = against_normal(of_walk(robot, normative_gait(speed)), leg_length=robot.body.leg_length)
    for name in ("cadence", "left_stance", "right_swing", "double_support"):
        assert verdicts[name] == "within", name


def test_without_two_strikes_of_a_foot_there_are_no_numbers():
    time, path, events = heels()
    with pytest.raises(GaitError, match="no foot strikes the ground twice"):
        spatiotemporal(time, path, [e for e in events if e.kind == "toe_off"])
    with pytest.raises(GaitError, match="heels have shape"):
        spatiotemporal(time, path[:, 0], events)


def force(*spans, n=1001):
    time = np.linspace(0, 2, n)
    load = sum(700 * ((time > a) & (time < b)) for a, b in spans) + 3.0
    return time, load


def test_contacts_begin_and_end_at_the_threshold_between_the_samples():
    time = np.linspace(0, 1, 11)
    found = force_plates.contacts(time, [0, 0, 0, 40, 500, 500, 500, 30, 0, 0, 0])
    assert len(found) == 1
    assert found[0].strike == pytest.approx(0.25)
    assert found[0].off == pytest.approx(0.7 + 0.1 / 3)


@given(st.floats(5.0, 600.0), st.floats(1500.0, 9000.0), st.floats(0.001, 0.019))
def test_a_contact_begins_where_a_ramp_of_force_passes_the_threshold(threshold, slope, offset):
    """The force rises and falls evenly between samples that lie anywhere, also at an uneven rate."""
    time = np.sort(np.concatenate([np.arange(0.0, 2.0, 0.02), [0.5 + offset, 1.5 + offset]]))
    force = slope * np.clip(np.minimum(time - 0.2, 1.8 - time), -1.0, 1.0)
    (found,) = force_plates.contacts(time, force, threshold=threshold)
    assert found.strike == pytest.approx(0.2 + threshold / slope, abs=1e-9)
    assert found.off == pytest.approx(1.8 - threshold / slope, abs=1e-9)


def test_contacts_at_the_ends_are_open_and_short_ones_are_noise():
    first, second = force_plates.contacts(*force((-1, 0.3), (0.5, 0.52), (1.2, 3)))
    assert first.strike is None
    assert first.off == pytest.approx(0.3, abs=2e-3)
    assert second.strike == pytest.approx(1.2, abs=2e-3)
    assert second.off is None
    joined = force_plates.contacts(*force((0.2, 0.5), (0.52, 0.9)))
    assert len(joined) == 1
    with pytest.raises(GaitError, match="expected finite numbers"):
        force_plates.contacts([0, 1], [np.nan, 0])


def changed(joint, change):
    walk = normative_gait("free")
    q = walk.q.copy()
    for side in SIDES:
        k = JOINTS.index(f"{side}_{joint}")
        q[:, k] = change(q[:, k])
    return Gait(walk.time, q)


def test_usual_walks_are_plausible():
    for speed in ("very_slow", "slow", "free", "fast", "very_fast"):
        assert implausibilities(normative_gait(speed)) == ()


@pytest.mark.parametrize(
    ("joint", "change", "reason"),
    [
        ("knee_flexion", np.negative, "left knee bends backwards for .* % of the cycle: sign or preset?"),
        ("hip_flexion", np.negative, "both hips extend while the knee is bent most"),
        ("ankle_dorsiflexion", lambda x: x + 1.5, "left_ankle_dorsiflexion is beyond human range for 100 %"),
    ],
)
def test_a_wrong_sign_is_implausible_with_its_reason(joint, change, reason):
    found = implausibilities(changed(joint, change))
    assert any(re.search(reason, text) for text in found), found


SWING = "both hips extend while the knee is bent most"


def test_a_walk_in_reverse_order_looks_like_a_hip_of_wrong_sign():
    walk = normative_gait("free")
    assert any(SWING in text for text in implausibilities(Gait(walk.time, walk.q[::-1])))


@pytest.mark.parametrize("side", SIDES)
def test_one_hip_against_its_knee_is_not_both(side):
    walk = normative_gait("free")
    q = walk.q.copy()
    q[:, JOINTS.index(f"{side}_hip_flexion")] *= -1.0
    assert not any(SWING in text for text in implausibilities(Gait(walk.time, q)))


@pytest.mark.parametrize(("joint", "share"), [("knee_flexion", 0.4), ("hip_flexion", 0.25)])
def test_legs_that_hardly_swing_have_no_swing_to_judge(joint, share):
    """A knee that bends by less than 30 degrees, or a hip by less than 15, says nothing about the signs."""
    walk = normative_gait("free")
    q = walk.q[::-1].copy()
    for side in SIDES:
        q[:, JOINTS.index(f"{side}_{joint}")] *= share
    assert not any(SWING in text for text in implausibilities(Gait(walk.time, q)))


def test_angles_that_hardly_move_are_implausible():
    walk = normative_gait("free")
    assert any("units?" in text for text in implausibilities(Gait(walk.time, np.radians(walk.q))))


def test_milliseconds_taken_for_seconds_are_implausible():
    long = normative_gait("free").repeated(2)
    assert not any("seconds" in text for text in implausibilities(Gait(long.time, long.q)))
    assert any("is the time in seconds" in text for text in implausibilities(Gait(1000 * long.time, long.q)))

"""Cycles, spatiotemporal numbers, force-plate contacts and doubts: known walks give known numbers."""

from __future__ import annotations

import re

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import Event, Gait, against_normal, cycles, doubts, normative_gait, plates, spatiotemporal

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
    one = cycles(walk, "left")
    assert len(one) == 1
    assert np.isnan(one.sd).all()


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


def test_a_limp_shows_in_step_time_and_symmetry():
    numbers = spatiotemporal(*heels(shift=0.4))
    assert numbers["right_step_time"].mean == pytest.approx(0.4 * PERIOD)
    assert numbers["left_step_time"].mean == pytest.approx(0.6 * PERIOD)
    assert numbers["step_time_symmetry"].mean == pytest.approx(40)


def test_numbers_are_compared_with_the_usual_ranges():
    time, path, events = heels()
    assert against_normal(spatiotemporal(time, path, events))["speed"] == "within"
    small = against_normal(spatiotemporal(time, path * 0.5, events))
    assert small["speed"] == "below"
    assert small["left_stance"] == "within"


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


def test_contacts_are_told_by_the_threshold_between_the_samples():
    time = np.linspace(0, 1, 11)
    found = plates.contacts(time, [0, 0, 0, 40, 500, 500, 500, 30, 0, 0, 0])
    assert len(found) == 1
    assert found[0].strike == pytest.approx(0.25)
    assert found[0].off == pytest.approx(0.7 + 0.1 / 3)


def test_contacts_at_the_ends_are_open_and_short_ones_are_noise():
    first, second = plates.contacts(*force((-1, 0.3), (0.5, 0.52), (1.2, 3)))
    assert first.strike is None
    assert first.off == pytest.approx(0.3, abs=2e-3)
    assert second.strike == pytest.approx(1.2, abs=2e-3)
    assert second.off is None
    joined = plates.contacts(*force((0.2, 0.5), (0.52, 0.9)))
    assert len(joined) == 1
    with pytest.raises(GaitError, match="expected finite numbers"):
        plates.contacts([0, 1], [np.nan, 0])


def changed(joint, change):
    walk = normative_gait("free")
    q = walk.q.copy()
    for side in SIDES:
        k = JOINTS.index(f"{side}_{joint}")
        q[:, k] = change(q[:, k])
    return Gait(walk.time, q)


def test_usual_walks_raise_no_doubts():
    for speed in ("very_slow", "slow", "free", "fast", "very_fast"):
        assert doubts(normative_gait(speed)) == ()


@pytest.mark.parametrize(
    ("joint", "change", "reason"),
    [
        ("knee_flexion", np.negative, "left knee bends backwards for .* % of the cycle: sign or preset?"),
        ("hip_flexion", np.negative, "both hips extend while the knee is bent most"),
        ("ankle_dorsiflexion", lambda x: x + 1.5, "left_ankle_dorsiflexion is beyond human range for 100 %"),
    ],
)
def test_a_wrong_sign_is_doubted_with_its_reason(joint, change, reason):
    found = doubts(changed(joint, change))
    assert any(re.search(reason, text) for text in found), found


def test_angles_that_hardly_move_are_doubted():
    walk = normative_gait("free")
    assert any("units?" in text for text in doubts(Gait(walk.time, np.radians(walk.q))))

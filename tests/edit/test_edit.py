"""Adjustments do what they say, say what they did, and are checked against the joints."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from exo_pin import edit
from exo_pin.anatomy import CORNERS, FEET, JOINTS, SIDES
from exo_pin.demand import ACCELERATION_LIMIT
from exo_pin.errors import ConvergenceError, GaitError, UnknownNameError
from exo_pin.gait import SPEEDS, Gait, normative_gait, time_series
from exo_pin.kinematics import poses, spatiotemporal
from exo_pin.robot import load_robot

EXACT = 1e-9
FEET_MET = 1e-8  # [m] inverse kinematics' tolerance is 1e-9
GROUND = 1e-4  # [m] a standing sole goes nowhere
NEARLY = 1.1  # strides of 1.2 at the fastest walk come to 209 rad/s^2
LENGTH = 0.05  # of the factor: the stride is measured between heels, the path scaled at the ankle


@pytest.fixture(scope="module")
def walk():
    return normative_gait("free")


def recording(walk, k=3):
    long = walk.repeated(k)
    return Gait(long.time, long.q, base=long.base, events=long.events, source="made up")


def stride(robot, gait):
    return spatiotemporal(robot, gait)["stride_length"].mean


def test_retimed_changes_time_only(walk):
    slow = edit.retimed(walk, duration=3.0)
    assert slow.duration == pytest.approx(3)
    np.testing.assert_array_equal(slow.q, walk.q)
    assert edit.retimed(walk, factor=0.5).duration == pytest.approx(walk.duration / 2)
    assert "retimed" in slow.source
    for wrong in ({}, {"duration": 1.0, "factor": 1.0}, {"factor": -1.0}, {"duration": 0.0}):
        with pytest.raises(GaitError):
            edit.retimed(walk, **wrong)


def test_amplitudes_are_scaled_about_the_mean_on_one_or_both_sides(walk):
    changed = edit.scaled(walk, {"knee_flexion": 0.5, "left_hip_flexion": 1.2})
    for joint, factor in (
        ("left_knee_flexion", 0.5),
        ("right_knee_flexion", 0.5),
        ("left_hip_flexion", 1.2),
        ("right_hip_flexion", 1.0),
    ):
        k = JOINTS.index(joint)
        assert np.ptp(changed.q[:, k]) == pytest.approx(factor * np.ptp(walk.q[:, k]))
        assert changed.q[:, k].mean() == pytest.approx(walk.q[:, k].mean())
    with pytest.raises(UnknownNameError, match="did you mean 'knee_flexion'"):
        edit.scaled(walk, {"knee_flexoin": 1.0})
    with pytest.raises(GaitError, match="from 0 on"):
        edit.scaled(walk, {"knee_flexion": -1.0})


def test_mirrored_twice_is_the_walk(walk):
    twice = edit.mirrored(edit.mirrored(walk))
    np.testing.assert_array_equal(twice.q, walk.q)
    np.testing.assert_allclose(twice.base, walk.base, atol=EXACT)


def test_a_symmetrised_walk_is_its_own_mirror_image_half_a_cycle_later(walk):
    lame = edit.scaled(walk, {"left_knee_flexion": 0.6, "left_hip_flexion": 0.8})
    even = edit.symmetrised(lame)
    half = len(even) // 2
    np.testing.assert_allclose(even.q, np.roll(even.mirrored().q, half, axis=0), atol=EXACT)
    np.testing.assert_allclose(even.base, np.roll(even.mirrored().base, half, axis=0), atol=EXACT)
    assert np.ptp(even.q[:, 3]) == pytest.approx(np.ptp(even.q[:, 9]))
    assert {e.side for e in even.events} == {"left", "right"}
    odd = edit.symmetrised(walk.resampled(51))
    assert len(odd) == 52
    with pytest.raises(GaitError, match="only a periodic gait"):
        edit.symmetrised(recording(walk))


def test_a_blend_goes_from_one_walk_to_the_other(walk):
    slow = normative_gait("slow")
    np.testing.assert_allclose(edit.blended(walk, slow, share=0.0).q, walk.q, atol=EXACT)
    np.testing.assert_allclose(edit.blended(walk, slow, share=1.0).q, slow.q, atol=EXACT)
    middle = edit.blended(walk, slow, share=0.5)
    assert middle.duration == pytest.approx((walk.duration + slow.duration) / 2)
    np.testing.assert_allclose(middle.q, (walk.q + slow.q) / 2, atol=EXACT)
    with pytest.raises(GaitError, match="share"):
        edit.blended(walk, slow, share=1.5)
    with pytest.raises(GaitError, match="only periodic"):
        edit.blended(walk, recording(slow))


@pytest.mark.parametrize("periodic", [True, False])
def test_a_ramp_starts_and_stops_at_rest_and_keeps_the_path(robot, walk, periodic):
    gait = walk if periodic else recording(walk)
    soft = edit.ramped(gait, start=1.0, stop=1.5)
    peak = np.abs(gait.dq).max()
    assert np.abs(soft.dq[[0, -1]]).max() < 0.01 * peak
    assert np.abs(soft.dq).max() < 1.02 * peak
    np.testing.assert_allclose(soft.q[0], gait.q[0], atol=EXACT)
    if not periodic:
        assert soft.duration == pytest.approx(gait.time[-1] + 1.25)
        np.testing.assert_allclose(soft.q[-1], gait.q[-1], atol=EXACT)
    assert edit.recheck(robot, soft).ok
    assert [e.kind for e in soft.events][:3] == [e.kind for e in gait.events][:3]


def test_a_recording_shorter_than_its_ramps_is_refused(walk):
    short = Gait(walk.time[:20], walk.q[:20])
    with pytest.raises(GaitError, match="ramps of 2 s and 2 s need 2 s"):
        edit.ramped(short)
    with pytest.raises(GaitError, match="from 0 to 3600"):
        edit.ramped(short, start=-1)


@pytest.mark.parametrize("periodic", [True, False])
def test_filtering_takes_the_noise_and_leaves_the_walk(walk, rng, periodic):
    gait = walk if periodic else recording(walk)
    noisy = dataclasses.replace(gait, q=gait.q + np.radians(1) * rng.normal(size=gait.q.shape))
    smooth = edit.filtered(noisy)
    inner = slice(15, -15)
    before, after = (np.abs(x.q - gait.q)[inner].mean() for x in (noisy, smooth))
    assert after < 0.6 * before
    assert "zero-lag Butterworth, order 4" in smooth.source
    assert "cut-off 6 Hz" in smooth.source
    assert smooth.base.shape == gait.base.shape


@pytest.mark.parametrize("factor", [0.6, 0.8, 1.0, 1.1])
def test_a_stride_is_scaled_at_the_feet(robot, walk, factor):
    changed, track = edit.strided(robot, walk, stride=factor)
    assert stride(robot, changed) / stride(robot, walk) == pytest.approx(factor, abs=LENGTH)
    assert track.position_error.max() < 1e-3
    if factor <= 0.8:
        np.testing.assert_array_equal(changed.base, walk.base)
    feet, old = (poses(robot, robot.from_gait(g), FEET, base=g.base) for g in (changed, walk))
    np.testing.assert_allclose(
        feet[..., :3, :3], old[..., :3, :3], atol=1e-2
    )  # the sole stays as flat as it was
    np.testing.assert_allclose(feet[..., 2, 3], old[..., 2, 3], atol=1e-3)
    assert f"stride x{factor:g}" in changed.source


def test_a_walk_over_ground_gets_along_in_proportion(robot, walk):
    gait = recording(walk)
    base = gait.base.copy()
    base[:, 0, 3] += 1.2 * gait.time
    over = dataclasses.replace(gait, base=base)
    changed, _ = edit.strided(robot, over, stride=0.75)
    assert np.ptp(changed.base[:, 0, 3]) == pytest.approx(0.75 * np.ptp(over.base[:, 0, 3]), rel=0.02)
    assert stride(robot, changed) / stride(robot, over) == pytest.approx(0.75, abs=LENGTH)


def soles(robot, gait):
    """(n, 2) height of each sole's lowest corner over the ground, and the ground."""
    low = (
        poses(robot, robot.from_gait(gait), CORNERS, base=gait.base)[..., 2, 3].reshape(-1, 2, 4).min(axis=2)
    )
    return low, np.percentile(low, 5, axis=0)


def standing(gait):
    """(n, 2) which samples are in stance."""
    return np.column_stack([gait.stance(side) for side in SIDES])


@pytest.mark.parametrize("factor", [0.5, 1.3, 2.0])
def test_clearance_is_scaled_in_mid_swing_while_standing_feet_stay(robot, walk, factor):
    changed, track = edit.strided(robot, walk, clearance=factor)
    (low, ground), (high, _) = soles(robot, walk), soles(robot, changed)
    assert track.position_error.max() < FEET_MET
    ends = {(e.side, e.kind): e.time for e in walk.events}
    for k, side in enumerate(SIDES):
        off, strike = ends[side, "toe_off"], ends[side, "heel_strike"]
        middle = (off + (strike - off) % walk.duration / 2) % walk.duration
        before, after = (np.interp(middle, walk.time, x[:, k]) - ground[k] for x in (low, high))
        assert after == pytest.approx(factor * before, rel=0.02)
    assert np.abs(high - low)[standing(walk)].max() < GROUND


@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize(
    ("stride", "clearance"), [(0.7, 1.0), (1.1, 1.0), (1.2, 1.0), (1.0, 0.5), (1.0, 1.5)]
)
def test_everyday_adjustments_keep_accelerations_low_and_standing_feet_down(robot, speed, stride, clearance):
    walk = normative_gait(speed)
    changed, track = edit.strided(robot, walk, stride=stride, clearance=clearance)
    assert np.abs(changed.ddq).max() < NEARLY * ACCELERATION_LIMIT
    assert np.abs(changed.base_acceleration[:, 2]).max() < 6  # [m/s^2] less than free fall: it can be walked
    assert (walk.base - changed.base)[:, 2, 3].min() >= 0
    assert (walk.base - changed.base)[:, 2, 3].max() < 0.065  # [m] and mostly less: the source tells
    assert track.position_error.max() < FEET_MET
    assert np.abs(soles(robot, changed)[0] - soles(robot, walk)[0])[standing(walk)].max() < GROUND


def test_where_the_legs_reach_the_pelvis_stays(robot, walk):
    for setting in ({"stride": 0.8}, {"clearance": 1.5}, {"stride": 1.0, "clearance": 1.0}):
        changed, _ = edit.strided(robot, walk, **setting)
        np.testing.assert_array_equal(changed.base, walk.base)
        assert "lowered" not in changed.source
    same, _ = edit.strided(robot, walk)
    np.testing.assert_allclose(same.q, walk.q, atol=np.radians(0.01))


def test_a_recorded_stride_is_scaled_like_a_repeated_one(robot, walk):
    """Without events, and with ends: swings are found in the motion."""
    gait = recording(walk)
    bare = Gait(gait.time, gait.q, base=gait.base)
    changed, _ = edit.strided(robot, bare, stride=1.1, clearance=1.3)
    again, _ = edit.strided(robot, walk, stride=1.1, clearance=1.3)
    n = len(walk)
    assert np.abs(changed.q[n : 2 * n] - again.q).max() < np.radians(4)  # events differ by 5 % of the cycle
    assert (
        np.abs(changed.ddq).max() < 1.2 * ACCELERATION_LIMIT
    )  # its events come a few per cent earlier than the file's


def test_what_the_legs_cannot_do_is_refused_with_how_far_they_miss(robot, walk):
    with pytest.raises(
        ConvergenceError, match=r"cannot follow in .* frames; .* misses by .* mm .*ask for less"
    ):
        edit.strided(robot, walk, stride=2.5)
    with pytest.raises(GaitError, match="0 to 3 is accepted"):
        edit.strided(robot, walk, clearance=9)
    with pytest.raises(GaitError, match="fixed base"):
        edit.strided(load_robot(base="floating"), walk)


def test_the_recheck_names_joints_kinds_and_amounts(robot, walk):
    assert edit.recheck(robot, walk).ok
    wild = edit.recheck(robot, edit.scaled(edit.retimed(walk, factor=0.2), {"left_knee_flexion": 3}))
    assert not wild.ok
    assert set(wild.angle) == {"left_knee_flexion"}
    assert "left_knee_flexion" in wild.velocity
    assert "left_knee_flexion" in wild.acceleration
    assert any(line.startswith("left_knee_flexion: velocity") for line in wild.lines())


@pytest.mark.parametrize(("start", "end", "cycles"), [("free", "slow", 3), ("very_slow", "very_fast", 1.5)])
def test_a_transition_goes_over_without_a_jump_of_angle_speed_or_acceleration(robot, start, end, cycles):
    """Four times as many samples leave a quarter of the steps between them: the curve has none of its own."""
    coarse, fine = (
        edit.transitioned(
            *(normative_gait(s, samples=n) for s in (start, end)), cycles=cycles, before=1, after=1
        )
        for n in (100, 400)
    )
    inner = slice(4, -4)  # the differences at the ends are of a lower order
    for order in ("q", "dq", "ddq"):
        steps = [np.abs(np.diff(getattr(g, order)[inner], axis=0)).max() for g in (coarse, fine)]
        assert steps[1] == pytest.approx(steps[0] / 4, rel=0.1), order
    turns = [np.abs(np.diff(g.base, n=3, axis=0)).max() for g in (coarse, fine)]
    assert turns[1] < turns[0] / 30  # the third differences of a curve with three derivatives shrink by 64
    assert edit.recheck(robot, fine).ok


def test_a_transition_begins_with_one_walk_and_ends_with_the_other(walk):
    slow = normative_gait("slow")
    g = edit.transitioned(walk, slow, cycles=2, before=1, after=2)
    first, last = (g.time < walk.duration), (g.time > g.duration - slow.duration)
    for part, source, since in ((first, walk, 0.0), (last, slow, g.duration)):
        phase = (g.time[part] - since) / source.duration
        np.testing.assert_allclose(g.q[part], time_series.at_phase(source.q, phase), atol=EXACT)
    assert g.duration == pytest.approx(walk.duration + (walk.duration + slow.duration) + 2 * slow.duration)
    strikes = [e.time for e in g.events if (e.side, e.kind) == ("left", "heel_strike")]
    strides = np.diff(strikes)
    assert len(strides) == 5
    assert (np.diff(strides) > -EXACT).all()  # every stride takes as long as the one before, or longer
    assert strides[[0, -1]] == pytest.approx([walk.duration, slow.duration])
    assert all(g.stance(side).any() for side in SIDES)  # events take turns
    timed = edit.transitioned(walk, slow, seconds=3.0, before=0, after=0)
    assert timed.duration == pytest.approx(3.0)


def test_walks_are_mixed_where_their_heels_strike(walk):
    """A walk that begins elsewhere in its cycle, and limps, is brought to the same phases."""
    n = len(walk) // 4
    shifted = dataclasses.replace(
        walk,
        q=np.roll(walk.q, -n, axis=0),
        base=np.roll(walk.base, -n, axis=0),
        events=[dataclasses.replace(e, time=(e.time - walk.time[n]) % walk.duration) for e in walk.events],
    )
    np.testing.assert_allclose(edit.blended(walk, shifted).q, walk.q, atol=EXACT)
    np.testing.assert_allclose(edit.blended(shifted, walk, share=0.3).q, shifted.q, atol=EXACT)
    limp = dataclasses.replace(
        walk,
        events=[
            dataclasses.replace(e, time=e.time + 0.06 * walk.duration * (e.side == "right"))
            for e in walk.events
        ],
    )
    middle = edit.blended(walk, limp)
    right = {e.kind: e.time / middle.duration for e in middle.events if e.side == "right"}
    assert right["heel_strike"] == pytest.approx(0.53)
    sooner = dataclasses.replace(
        walk,
        events=[
            dataclasses.replace(e, time=(e.time - 0.3 * walk.duration * (e.side == "right")) % walk.duration)
            for e in walk.events
        ],
    )
    with pytest.raises(GaitError, match="right heel strikes at 50% and 20% of the cycle are too far apart"):
        edit.blended(walk, sooner)


def test_a_transition_needs_repeating_walks_and_a_length(walk):
    with pytest.raises(GaitError, match="only periodic"):
        edit.transitioned(walk, recording(walk))
    for wrong in ({"cycles": 0}, {"seconds": -1.0}, {"before": -1.0}, {"cycles": float("nan")}):
        with pytest.raises(GaitError, match="is accepted"):
            edit.transitioned(walk, walk, **wrong)


def test_the_recheck_tells_how_near_the_limits_a_walk_comes(robot, walk):
    found = edit.recheck(robot, walk)
    k = robot.joints.index(found.closest.joint)
    angles = robot.angles(robot.from_gait(walk))
    nearest = min((angles[:, k] - robot.lower[k]).min(), (robot.upper[k] - angles[:, k]).min())
    assert found.closest.position.margin == pytest.approx(nearest)
    assert found.fastest.speed.peak == pytest.approx(
        np.abs(walk.dq[:, JOINTS.index(found.fastest.joint)]).max()
    )
    assert found.hardest.acceleration.peak == pytest.approx(np.abs(walk.ddq).max())


@pytest.mark.parametrize("periodic", [True, False])
def test_a_ramp_takes_the_length_that_is_asked(walk, periodic):
    """A gait that repeats keeps its cadence in between; a recording is followed faster or slower."""
    gait = walk if periodic else edit.lasting(walk, 6.0)
    soft = edit.ramped(gait, start=3.0, stop=3.0, duration=20.0)
    assert soft.duration == pytest.approx(20.0, abs=1e-9)
    assert not soft.periodic
    strikes = [e.time for e in soft.events if (e.kind, e.side) == ("heel_strike", "left") and 4 < e.time < 16]
    rate = 1.0 if periodic else 6.0 / 17.0
    np.testing.assert_allclose(np.diff(strikes), walk.duration / rate, rtol=1e-3)
    with pytest.raises(GaitError, match="6 to 3600"):
        edit.ramped(gait, start=3.0, stop=3.0, duration=5.0)


def test_a_gait_is_walked_for_any_time_at_its_own_cadence(walk):
    long = edit.lasting(walk, 5.0)
    assert long.time[[0, -1]].tolist() == [0.0, 5.0]
    twice = edit.lasting(walk, 2 * walk.duration)
    np.testing.assert_allclose(twice.q[0], twice.q[-1], atol=1e-9)
    with pytest.raises(GaitError, match="recording"):
        edit.lasting(long, 3.0)

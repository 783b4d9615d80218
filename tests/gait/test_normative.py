"""The normative walk follows its source, keeps its symmetry, and puts the feet on the ground."""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from exo_pin.anatomy import CORNERS, JOINTS, MOVEMENTS, Body
from exo_pin.anatomy.names import Speed
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.gait import (
    SPEEDS,
    normative_gait,
    normative_sd,
    schwartz2008,
    schwartz2008_kinetics,
    schwartz2008_sd,
)
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

ROUNDING = 1e-12  # [rad, s]
SPECTRAL = 1e-9  # [rad/s^2]
FIT = 0.6  # [deg] what eight harmonics leave of the source's curves, DOMAIN.md section 5
SPREAD_FIT = 1.1  # [deg] what four harmonics leave of the source's standard deviations; most within 0.5
FLAT = np.radians(3)  # fore-and-aft slope of the sole in mid-stance, the number
FAST = np.radians(4)  # of the two fast speeds, whose children roll over the foot sooner: 3.9 measured
ROLL = np.radians(4)  # sideways slope: the ankle's inversion is a weak channel
MID_STANCE = (0.12, 0.31)  # Perry's mid-stance, as a part of the cycle
REPOSITORY = Path(__file__).resolve().parents[2]


def turns(axis, angle):
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.tile(np.eye(3), (len(angle), 1, 1))
    R[:, i, i] = R[:, j, j] = np.cos(angle)
    R[:, j, i], R[:, i, j] = np.sin(angle), -np.sin(angle)
    return R


def foot(gait, side, body):
    """Orientation of the foot and its sole's corners (heel, heel, ball, ball) in the world."""
    flexion, adduction, rotation, knee, ankle, inversion = gait.q[:, JOINTS.index(f"{side}_hip_flexion") :].T[
        :6
    ]
    out, leg, down = (1 if side == "left" else -1), body.leg(side), np.array([0, 0, -1.0])
    R, p = gait.base[:, :3, :3], gait.base[:, :3, 3]
    p = p + R @ [0, out * body.hip_width / 2, 0]
    R = R @ turns(1, -flexion) @ turns(0, -out * adduction) @ turns(2, -out * rotation)
    p = p + R @ (leg.thigh * down)
    R = R @ turns(1, knee)
    p = p + R @ (leg.shank * down)
    R = R @ turns(1, -ankle) @ turns(0, -out * inversion)
    half = leg.foot_width / 2
    corners = [[x, y, -leg.ankle_height] for x in (-leg.heel, leg.ball) for y in (-half, half)]
    return R, p[:, None] + np.einsum("nij,cj->nci", R, corners)


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_curves_follow_the_source(shared, speed):
    with (shared / "normative_gait.csv").open() as file:
        rows = [r for r in csv.DictReader(file) if (r["source"], r["condition"]) == ("schwartz2008", speed)]
    gait = normative_gait(speed)  # its samples are the percents of the cycle
    percent = [int(row["percent"]) % 100 for row in rows]
    for movement in MOVEMENTS[:-1]:
        curve = np.degrees(gait.q[percent, JOINTS.index(f"left_{movement}")])
        np.testing.assert_allclose(curve, [float(row[f"{movement}_mean"]) for row in rows], atol=FIT)
    R = gait.base[percent, :3, :3]  # = Ry(tilt) Rx(obliquity) Rz(-rotation)
    pelvis = {
        "pelvis_tilt": np.arctan2(R[:, 0, 2], R[:, 2, 2]),
        "pelvis_obliquity": -np.arcsin(R[:, 1, 2]),
        "pelvis_rotation": -np.arctan2(R[:, 1, 0], R[:, 1, 1]),
    }
    for name, curve in pelvis.items():
        np.testing.assert_allclose(np.degrees(curve), [float(row[f"{name}_mean"]) for row in rows], atol=FIT)


def test_the_script_writes_the_coefficients_again_byte_for_byte(shared, tmp_path):
    target = tmp_path / "schwartz2008.py"
    script = [sys.executable, str(REPOSITORY / "scripts" / "fit_normative")]
    subprocess.run(
        [*script, str(shared / "normative_gait.csv"), "-o", str(target)], check=True, capture_output=True
    )
    assert target.read_bytes() == Path(schwartz2008.__file__).read_bytes()
    spread = target.with_name("schwartz2008_sd.py")
    assert spread.read_bytes() == Path(schwartz2008_sd.__file__).read_bytes()
    kinetics = target.with_name("schwartz2008_kinetics.py")
    assert kinetics.read_bytes() == Path(schwartz2008_kinetics.__file__).read_bytes()


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_spreads_follow_the_source(shared, speed):
    sd = np.degrees(normative_sd(speed))
    for movement in MOVEMENTS:
        weak = movement == "ankle_inversion"
        source = ("ofm_oxford", "unspecified") if weak else ("schwartz2008", speed)
        with (shared / "normative_gait.csv").open() as file:
            rows = [r for r in csv.DictReader(file) if (r["source"], r["condition"]) == source]
        percent = [int(float(row["percent"])) % 100 for row in rows]
        mine = sd[percent, JOINTS.index(f"left_{movement}")]
        np.testing.assert_allclose(mine, [float(r[f"{movement}_sd"]) for r in rows], atol=SPREAD_FIT)


@pytest.mark.parametrize("speed", SPEEDS)
def test_spreads_are_positive_and_the_right_leg_has_them_half_a_cycle_later(speed):
    sd = normative_sd(speed, samples=200)
    assert sd.shape == (200, 12)
    assert sd.min() > 0
    np.testing.assert_allclose(np.roll(sd[:, :6], 100, axis=0), sd[:, 6:], atol=ROUNDING)


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_right_leg_walks_half_a_cycle_after_the_left_and_the_pelvis_mirrors_itself(speed):
    gait = normative_gait(speed)
    mirror = gait.mirrored()
    np.testing.assert_allclose(np.roll(mirror.q, 50, axis=0), gait.q, atol=ROUNDING)
    np.testing.assert_allclose(np.roll(mirror.base, 50, axis=0), gait.base, atol=ROUNDING)


def test_pelvis_curves_keep_only_the_harmonics_of_a_symmetric_walk():
    for angles in schwartz2008.MEAN_ANGLES.values():
        for name, gone in (
            ("tilt", slice(1, None, 2)),
            ("obliquity", slice(0, None, 2)),
            ("rotation", slice(0, None, 2)),
        ):
            mean, *waves = angles[f"pelvis_{name}"]
            harmonics = np.array([(mean, 0), *zip(waves[:8], waves[8:], strict=True)])
            assert not harmonics[gone].any()
            assert harmonics.any()


def test_pelvis_angles_turn_the_pelvis_where_their_names_say():
    base = normative_gait("free").base
    forward, left, up = base[0, :3, :3].T  # the left foot strikes
    assert up[0] > 0  # anterior tilt: the pelvis's top leans forward
    assert left[0] > 0  # the left side is forward
    assert forward[0] > 0.9
    assert base[10, 2, 1] > 0  # the left leg takes the weight: its side of the pelvis is up
    assert base[60, 2, 1] < 0


@pytest.mark.parametrize("speed", SPEEDS)
def test_derivatives_are_exact_whatever_the_number_of_samples(speed):
    coarse, fine = normative_gait(speed, samples=17), normative_gait(speed, samples=170)
    np.testing.assert_allclose(fine.ddq[::10], coarse.ddq, atol=SPECTRAL)
    np.testing.assert_allclose(coarse.resampled(170).q, fine.q, atol=ROUNDING)


def test_faster_walks_and_shorter_legs_have_shorter_strides():
    assert normative_gait(leg_length=0.65).duration == pytest.approx(0.911, abs=1e-3)  # DOMAIN.md section 5
    assert normative_gait(leg_length=0.93).duration == pytest.approx(1.090, abs=1e-3)
    durations = [normative_gait(speed).duration for speed in SPEEDS]
    assert durations == sorted(durations, reverse=True)


def test_the_pelvis_stands_as_high_as_the_leg_is_long():
    np.testing.assert_array_equal(normative_gait(leg_length=0.8).base[:, :3, 3], [[0, 0, 0.8]] * 100)
    assert normative_gait().base[0, 2, 3] == Body.from_stature().leg_length


@pytest.mark.parametrize("speed", SPEEDS)
def test_events_tell_a_stance_of_the_sources_length(speed):
    gait = normative_gait(speed, samples=200)
    assert gait.events[0].kind == "heel_strike"
    assert (gait.events[0].time, gait.events[0].side) == (0, "left")
    off = schwartz2008.TIMING[speed]["foot_off"] / 100
    assert gait.stance("left").mean() == pytest.approx(off)
    assert gait.stance("right").mean() == pytest.approx(
        off, abs=0.02
    )  # opposite events are rounded to a percent
    assert (gait.stance("left") | gait.stance("right")).all()  # walking: a foot is always on the ground


def test_the_feet_of_this_file_are_the_feet_of_the_package():
    gait, body = normative_gait("fast"), Body.from_stature(1.6)
    robot = load_robot(body)
    corners = [corner for corner in CORNERS if corner.startswith("left")]
    T = poses(robot, robot.from_gait(gait), corners, base=gait.base)
    order = np.lexsort(T[0, :, :3, 3].T)  # the same corners, whatever their order
    _, mine = foot(gait, "left", body)
    np.testing.assert_allclose(T[:, order][..., :3, 3], mine[:, np.lexsort(mine[0].T)], atol=ROUNDING)


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_stance_sole_is_flat_in_mid_stance(speed):
    gait = normative_gait(speed, samples=200)
    R, _ = foot(gait, "left", Body.from_stature())
    phase = gait.time / gait.duration
    mid = (MID_STANCE[0] <= phase) & (phase <= MID_STANCE[1])
    assert np.abs(np.arcsin(R[mid, 2, 0])).max() < (FAST if "fast" in speed else FLAT)
    assert np.abs(np.arcsin(R[mid, 2, 1])).max() < ROLL


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_swing_foot_clears_the_ground(speed):
    gait = normative_gait(speed, samples=200)
    body = Body.from_stature()
    lowest = [foot(gait, side, body)[1][:, :, 2].min(axis=1) for side in ("left", "right")]
    swing = ~gait.stance("right")
    assert (lowest[1] - lowest[0])[swing].min() > 0
    phase = gait.time / gait.duration
    middle = (phase > 0.15) & (phase < 0.45)
    assert (lowest[1] - lowest[0])[middle].min() > 0.010  # [m] measured 14 to 17 mm


def test_without_the_pelvis_turning_the_feet_would_not_meet_the_ground():
    gait = normative_gait("free")
    upright = np.tile(np.eye(4), (100, 1, 1))
    flat = type(gait)(gait.time, gait.q, base=upright, periodic=True)
    R, _ = foot(flat, "left", Body.from_stature())
    assert np.arcsin(R[20, 2, 0]) > np.radians(8)  # toes up: this is why the gait carries a base


def test_impossible_requests_are_refused():
    with pytest.raises(UnknownNameError, match="did you mean 'very_fast'"):
        normative_gait("veryfast")
    with pytest.raises(UnknownNameError, match="very_fast"):
        normative_sd("veryfast")
    with pytest.raises(GaitError, match="samples"):
        normative_sd(samples=0)
    with pytest.raises(GaitError, match="from 17 to"):
        normative_gait(samples=16)
    for length in (93.0, 0.0, float("nan")):
        with pytest.raises(GaitError, match="leg_length"):
            normative_gait(leg_length=length)


def test_speeds_are_those_of_the_data_and_of_their_type():
    assert get_args(Speed) == SPEEDS == tuple(schwartz2008.MEAN_ANGLES) == tuple(schwartz2008_sd.SD_ANGLES)

"""Pose tables come back exactly, with quaternions that everybody writes alike."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.anatomy import FEET
from exo_pin.errors import FormatError, GaitError, UnknownNameError
from exo_pin.formats import Poses, load_poses, save_poses
from exo_pin.gait import Event
from exo_pin.gait.quaternions import quaternions, rotations

ROUND_TRIP = 1e-12  # [m, -]
N = 50


@pytest.fixture
def turned(rng):
    """Random poses."""

    def make():
        q = rng.normal(size=(N, 4))
        T = np.tile(np.eye(4), (N, 1, 1))
        T[:, :3, :3] = rotations(q / np.linalg.norm(q, axis=1, keepdims=True))
        T[:, :3, 3] = rng.normal(size=(N, 3))
        return T

    return make


@pytest.fixture
def path(tmp_path):
    return tmp_path / "poses.csv"


@pytest.fixture
def poses(turned):
    events = [Event(0.2, "toe_off", "left", "by hand")]
    time = np.arange(N) / 100
    targets = {foot: turned() for foot in FEET}
    return Poses(time, turned(), targets, events=events, periodic=True, source="walk")


def test_saved_poses_come_back(poses, path):
    save_poses(poses, path)
    back = load_poses(path)
    np.testing.assert_allclose(back.time, poses.time, atol=ROUND_TRIP)
    np.testing.assert_allclose(back.base, poses.base, atol=ROUND_TRIP)
    assert tuple(back.targets) == FEET
    for foot in FEET:
        np.testing.assert_allclose(back.targets[foot], poses.targets[foot], atol=ROUND_TRIP)
    assert (back.events, back.periodic, back.source) == (poses.events, True, "walk")


def test_one_foot_on_a_fixed_pelvis_is_enough(poses, path):
    save_poses(Poses(poses.time, None, {"right_foot": poses.targets["right_foot"]}), path)
    back = load_poses(path)
    assert back.base is None
    assert list(back.targets) == ["right_foot"]


def test_written_quaternions_are_canonical(poses, path):
    save_poses(poses, path)
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    names = lines[0].split(",")
    values = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    for frame in ("pelvis", *FEET):
        q = values[:, [names.index(f"{frame}_q{part}") for part in "wxyz"]]
        np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1, atol=ROUND_TRIP)
        assert q[:, 0].min() >= 0


def test_quaternions_are_exact_at_half_turns_and_for_every_leading_part(rng):
    axes = np.vstack([np.eye(3), -np.eye(3), rng.normal(size=(20, 3))])
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    for angle in (0.0, 1e-9, 1.0, np.pi - 1e-9, np.pi):
        q = np.hstack([np.full((len(axes), 1), np.cos(angle / 2)), np.sin(angle / 2) * axes])
        np.testing.assert_allclose(rotations(quaternions(rotations(q))), rotations(q), atol=ROUND_TRIP)


def test_rotations_of_quaternions_are_rodrigues_rotations():
    q = np.array([[np.cos(0.15), 0, 0, np.sin(0.15)]])  # 0.3 rad about z
    expected = [[np.cos(0.3), -np.sin(0.3), 0], [np.sin(0.3), np.cos(0.3), 0], [0, 0, 1]]
    np.testing.assert_allclose(rotations(q)[0], expected, atol=ROUND_TRIP)


def test_wrong_tables_are_refused(poses, path):
    save_poses(poses, path)
    good = path.read_text()
    for old, new, match in (
        ("left_foot_qw", "left_foot_w", "unknown column 'left_foot_w'; did you mean"),
        ("left_foot_qw", "hand_qw", "unknown column 'hand_qw'"),
        ("periodic: true", "periodic: no", "expected true or false"),
        ("time_s", "t", "unknown column 't'"),
    ):
        path.write_text(good.replace(old, new, 1))
        with pytest.raises(FormatError, match=match):
            load_poses(path)
    for text, match in (
        ("time_s\n0\n1\n", "no foot; expected columns left_foot_x_m"),
        ("time_s,left_foot_x_m\n0,1\n1,1\n", "missing columns: left_foot_y_m"),
        ("", "empty"),
    ):
        path.write_text(text)
        with pytest.raises(FormatError, match=match):
            load_poses(path)


def test_quaternions_of_the_wrong_length_are_refused_with_their_line(path):
    names = [f"left_foot_{c}" for c in ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")]
    for q, good in ((1.0000005, True), (1.000002, False), (0, False), (1e200, False)):
        path.write_text("\n".join([",".join(["time_s", *names]), "0,0,0,0,1,0,0,0", f"1,0,0,0,{q},0,0,0"]))
        if good:
            np.testing.assert_allclose(load_poses(path).targets["left_foot"][1], np.eye(4), atol=ROUND_TRIP)
            continue
        with pytest.raises(FormatError, match="not of length 1") as caught:
            load_poses(path)
        assert caught.value.line == 3


def test_unusable_poses_are_refused(turned):
    T, time = turned(), np.arange(N) / 100
    with pytest.raises(GaitError, match="no targets"):
        Poses(time, None, {})
    with pytest.raises(UnknownNameError, match="unknown foot"):
        Poses(time, None, {"left_hand": T})
    with pytest.raises(GaitError, match="left_foot has shape"):
        Poses(time, None, {"left_foot": T[:3]})
    wrong = T.copy()
    wrong[7, 0, 0] = np.nan
    with pytest.raises(GaitError, match="base of frame 7"):
        Poses(time, wrong, {"left_foot": T})
    with pytest.raises(GaitError, match="outside the walk"):
        Poses(time, None, {"left_foot": T}, events=[Event(9, "toe_off", "left")])


def test_rounded_time_stamps_are_evened_and_that_is_stated(path, turned):
    exact = np.arange(60) / 60
    rounded = Poses(np.round(exact, 3), None, {"left_foot": np.tile(np.eye(4), (60, 1, 1))})
    save_poses(rounded, path)
    back = load_poses(path)
    np.testing.assert_allclose(back.time, exact, atol=1e-12)
    assert "60 Hz" in back.remarks[0]
    save_poses(Poses(exact, None, rounded.targets), path)
    assert load_poses(path).remarks == ()

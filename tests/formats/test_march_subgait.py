"""Project MARCH's set points: signs, times of either ROS, cubic Hermite, what its hip lacks, damage."""

from __future__ import annotations

import copy

import numpy as np
import pytest
import yaml

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError
from exo_pin.formats import load_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

END = 1.25  # [s]
NAMES = [f"{side}_{name}" for side in ("left", "right") for name in ("hip_fe", "hip_aa", "knee", "ankle")]
OURS = ["hip_flexion", "hip_adduction", "knee_flexion", "ankle_dorsiflexion"]


def ros1(t):
    return {"secs": int(t), "nsecs": round(1e9 * (t % 1))}


def ros2(t):
    return round(1e9 * t)


def subgait(stamp=ros1, hip_aa=0.0):
    """Joint k goes from .1 to .1 + .05 k and back, standing at each set point; the hip's abduction stays."""

    def points(k, name):
        high = hip_aa if name.endswith("aa") else 0.1 + 0.05 * k
        low = hip_aa if name.endswith("aa") else 0.1
        rows = ((0.0, low), (0.5, high), (END, low))
        return [{"position": x, "time_from_start": stamp(t), "velocity": 0.0} for t, x in rows]

    joints = {name: points(k % 4, name) for k, name in enumerate(NAMES)}
    return {"name": "right_open", "duration": stamp(END), "joints": joints}


@pytest.fixture
def path(tmp_path):
    return tmp_path / "walk.subgait"


def read(path, content):
    path.write_text(yaml.safe_dump(content))
    return load_gait(path)


def angle(gait, joint):
    return gait.q[:, JOINTS.index(joint)]


@pytest.mark.parametrize("stamp", [ros1, ros2])
def test_set_points_are_met_and_joined_by_cubic_hermite(path, stamp):
    gait = read(path, subgait(stamp))
    assert (gait.time[0], gait.time[-1]) == (0, END)
    np.testing.assert_allclose(np.diff(gait.time), 0.01)
    knee = angle(gait, "left_knee_flexion")
    s = gait.time[:51] / 0.5
    np.testing.assert_allclose(knee[:51], 0.1 + 0.1 * (3 * s**2 - 2 * s**3), atol=1e-12)
    np.testing.assert_allclose(angle(gait, "right_ankle_dorsiflexion")[[0, 50, -1]], [0.1, 0.25, 0.1])


def test_what_the_exoskeleton_has_no_motor_for_is_held_and_named(path):
    gait = read(path, subgait())
    for side in ("left", "right"):
        for movement in ("hip_rotation", "ankle_inversion"):
            assert not angle(gait, f"{side}_{movement}").any()
    assert gait.remarks == ("the exoskeleton has no hip rotation and no ankle inversion: held at 0",)


def test_the_thighs_stand_as_the_exoskeletons_own_axes_turn_them(path):
    """Its URDF: the hip turns about the walker's forward axis first (outwards positive), then it flexes."""
    gait = read(path, subgait(hip_aa=0.2))
    robot = load_robot()
    frames = ("left_hip_rotation", "right_hip_rotation")
    thighs = poses(robot, robot.from_gait(gait), frames)[0, :, :3, :3]
    fe = 0.1
    for thigh, out in zip(thighs, (1.0, -1.0), strict=True):  # z up, x forward, y left
        c, s, cf, sf = np.cos(out * 0.2), np.sin(out * 0.2), np.cos(fe), np.sin(fe)
        R = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array([[cf, 0, -sf], [0, 1, 0], [sf, 0, cf]])
        np.testing.assert_allclose(thigh, R, atol=1e-12)
        assert (-R[:, 2])[1] * out > 0  # the knee goes outwards
        assert (-R[:, 2])[0] > 0  # and forwards
    assert "in our order it rotates up to" in gait.remarks[0]


def test_the_older_layout_a_joint_trajectory_is_read_too(path):
    new = subgait()
    names = [name for name in NAMES if not name.endswith("aa")]
    points = [
        {
            "positions": [new["joints"][name][k]["position"] for name in names],
            "velocities": [0.0] * len(names),
            "time_from_start": new["joints"]["left_knee"][k]["time_from_start"],
        }
        for k in range(3)
    ]
    short = [name.replace("_fe", "") for name in names]
    old = {"name": "a", "duration": ros1(END), "trajectory": {"joint_names": short, "points": points}}
    gait = read(path, old)
    np.testing.assert_allclose(gait.q, read(path, new).q, atol=1e-12)
    assert "hip adduction" in gait.remarks[0] or "hip adduction" in read(path, old).remarks[0]


def test_joints_that_end_early_and_joints_unknown_are_said(path):
    content = subgait()
    content["joints"]["left_knee"].pop()
    content["joints"]["rotational_joint"] = copy.deepcopy(content["joints"]["left_ankle"])
    gait = read(path, content)
    assert gait.time[-1] == pytest.approx(0.5)
    text = " ".join(gait.remarks)
    for part in ("says 1.25 s", "end at 0.5 s", "every joint has set points", "not used: rotational_joint"):
        assert part in text


def changed(change):
    content = copy.deepcopy(subgait())
    change(content)
    return content


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda c: c.pop("joints"), "no subgait; expected the key joints"),
        (lambda c: c["joints"].pop("left_knee"), "no set points of left_knee_flexion; the file has"),
        (lambda c: c["joints"]["left_knee"].__setitem__(1, 3), "left_knee, set point 2: time_from_start"),
        (lambda c: c["joints"]["left_knee"][1].update(position=90.0), "position must be a number up to 3.14"),
        (lambda c: c["joints"]["left_knee"][1].update(position=True), "position must be a number"),
        (lambda c: c["joints"]["left_knee"][1].update(velocity="fast"), "velocity must be a number"),
        (lambda c: c["joints"]["left_knee"][1].update(velocity=float("nan")), "velocity must be a number"),
        (lambda c: c["joints"]["left_knee"][1].pop("velocity"), "velocity must be a number"),
        (lambda c: c["joints"]["left_knee"][1].update(time_from_start=10**400), "time_from_start must be"),
        (lambda c: c["joints"]["left_knee"][2].update(time_from_start=0), "each later than the one before"),
        (lambda c: c["joints"].update(left_knee=[]), "at least 2 set points"),
        (lambda c: c["joints"]["left_knee"][2].update(time_from_start=ros1(0.505)) or
         c["joints"]["right_knee"].pop(0), None),
    ],
)  # fmt: skip
def test_damaged_set_points_are_refused_with_their_place(path, change, match):
    content = changed(change)
    if match is None:
        with pytest.raises(FormatError, match="known together from"):
            read(path, content)
        return
    with pytest.raises(FormatError, match=match) as caught:
        read(path, content)
    assert "\n" not in str(caught.value)


def test_signs_and_units_are_not_for_the_user_to_say(path):
    read(path, subgait())
    with pytest.raises(FormatError, match="units is not for this kind of file"):
        load_gait(path, units="deg")

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from exo_pin import viewer
from exo_pin.anatomy import FEET, JOINTS, SIDES, Body
from exo_pin.gait import Gait
from exo_pin.gait.heading import turned
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.robot import load_robot
from exo_pin.viewer.scenes.actor import flat_poses
from exo_pin.viewer.scenes.world import TRACE_ERROR, TRACE_POINTS

SINGLE = 2e-7  # float32 keeps seven digits of numbers near 1
MILLIMETRE = 1e-3
VERTEX = 5e-6  # [m]: float32 metres, and the mean of a ring of them


def shown_base(scene):
    return np.array([pin.XYZQUATToSE3(row.astype(float)).homogeneous for row in scene.arrays["base"]])


def test_angles_arrive_under_their_joints_name(robot, gait, scene):
    (chain,) = [c for c in scene.facts.chains if c.name == "exo"]
    for k, joint in enumerate(chain.joints):
        assert np.abs(scene.arrays["q"][:, k] - gait.q[:, JOINTS.index(joint.name)]).max() < SINGLE


def test_the_plots_show_the_gaits_own_clinical_angles(gait):
    scene = viewer.scene(load_robot(hip_order="yaw_roll_pitch"), gait)
    assert np.abs(scene.arrays["angles"] - gait.q).max() < SINGLE
    assert np.abs(scene.arrays["q"] - gait.q).max() > 0.01  # the robot's own hip angles are others


def test_another_hip_order_shows_the_same_feet(robot, gait, scene):
    other = viewer.scene(load_robot(hip_order="yaw_roll_pitch"), gait)
    assert np.abs(other.arrays["base"] - scene.arrays["base"]).max() < 1e-6


def test_a_floating_robot_shows_the_same_walk(gait, scene):
    floating = viewer.scene(load_robot(base="floating"), gait)
    for name in ("q", "base"):
        assert np.abs(floating.arrays[name] - scene.arrays[name]).max() < 1e-6


def test_the_shown_walk_stands_on_the_belt(robot, gait, scene):
    corners = poses(robot, robot.from_gait(gait), ("left_foot", "right_foot"), base=shown_base(scene))
    assert corners[..., 2, 3].min() > -0.02


def test_the_centre_of_mass_goes_with_the_shown_pelvis(robot, gait, scene):
    com = center_of_mass(robot, robot.from_gait(gait), base=shown_base(scene)).position
    assert np.abs(com - scene.arrays["com"]).max() < 1e-6


def test_what_was_done_to_the_pelvis_is_said(scene):
    assert any("mm" in note and "pelvis" in note.lower() for note in scene.facts.notes)


def test_contact_without_events_is_labelled_an_estimate(robot, gait, scene):
    guessed = viewer.scene(robot, replace(gait, events=()))
    assert "estimated" in guessed.facts.contact
    assert any("estimated" in note for note in guessed.facts.notes)
    assert "estimated" not in scene.facts.contact


def test_a_walk_through_the_room_has_no_treadmill_and_is_followed(robot, gait):
    base = np.tile(robot.placement, (len(gait), 1, 1))
    base[:, 0, 3] = 1.2 * gait.time
    away = Gait(gait.time, gait.q, base=base, events=gait.events)
    facts = viewer.scene(robot, away).facts
    assert facts.follow
    assert facts.marks.belt is None
    assert not any("Treadmill" in group.title for group in facts.groups)


def test_limits_of_the_plots_are_those_of_this_body(gait):
    body = Body.from_stature(limits={"left_knee_flexion": (0.1, 1.2)})
    facts = viewer.scene(load_robot(body), gait).facts
    knee = next(plot for plot in facts.plots[0].plots if plot.title == "Knee flexion")
    left, right = knee.series
    assert (left.lower, left.upper) == pytest.approx((0.1, 1.2))
    assert right.lower == pytest.approx(0.0)


def test_the_reference_is_sent_with_its_own_time(robot, gait):
    reference = gait.resampled(37)
    scene = viewer.scene(robot, gait, reference=reference, reference_title="measured")
    assert scene.facts.reference == "measured"
    assert scene.arrays["angles_reference"].shape == (37, 12)
    assert scene.arrays["angles_reference_time"].shape == (37,)


def test_scenes_are_values(scene):
    assert all(not rows.flags.writeable for rows in scene.arrays.values())
    assert all(rows.dtype == np.float32 for name, rows in scene.arrays.items() if not name.endswith("time"))


def test_every_node_that_the_page_moves_is_drawn(scene):
    drawn = {command["path"] for command in scene.commands}
    marks = scene.facts.marks
    for path in (marks.com, marks.ground, *marks.contact.values()):
        assert path in drawn
    assert all(any(path.startswith(belt) for path in drawn) for belt in marks.belt.paths)
    for group in scene.facts.groups:
        assert all(any(node.startswith(path) for node in drawn) for path in group.paths)


def test_the_contact_sole_is_as_long_as_the_bodys_foot(robot, scene):
    for side in SIDES:
        path = scene.facts.marks.contact[side]
        (shape,) = [
            c["object"]["geometries"][0] for c in scene.commands if c["path"] == path and "object" in c
        ]
        assert shape["width"] == pytest.approx(robot.body.leg(side).foot_length, abs=0.02)


def test_long_recordings_have_thin_traces_that_follow_every_stride(robot, gait):
    strides = Gait(np.arange(3000) * gait.duration / 100, np.tile(gait.q, (30, 1)))
    scene = viewer.scene(robot, strides)
    (path,) = [c for c in scene.commands if c["path"].endswith("traces/left")]
    packed = path["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]
    vertices = np.frombuffer(packed.data, np.float32).reshape(-1, 8, 3)
    assert len(vertices) <= TRACE_POINTS
    drawn = vertices.mean(axis=1)
    feet = poses(robot, robot.from_gait(strides), FEET, base=shown_base(scene))[:, 0, :3, 3]
    ends, starts = drawn[1:], drawn[:-1]
    for foot in feet[::29]:
        share = np.einsum("nk,nk->n", foot - starts, ends - starts) / np.sum((ends - starts) ** 2, axis=1)
        nearest = starts + np.clip(share, 0, 1)[:, None] * (ends - starts)
        assert np.linalg.norm(foot - nearest, axis=1).min() < TRACE_ERROR + VERTEX


def test_foot_traces_run_through_the_feet(robot, gait, scene):
    feet = poses(robot, robot.from_gait(gait), FEET, base=shown_base(scene))[..., :3, 3]
    for k, side in enumerate(SIDES):
        (path,) = [c for c in scene.commands if c["path"].endswith(f"traces/{side}")]
        packed = path["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]
        rings = np.frombuffer(packed.data, "<f4").reshape(-1, 8, 3).mean(axis=1)
        assert np.abs(rings - feet[:, k]).max() < MILLIMETRE


def test_flattened_poses_keep_the_rotation_and_never_jump(rng):
    angle = np.linspace(0, 4 * np.pi, 200)  # two full turns: the quaternion changes sign
    T = np.array([pin.SE3(pin.rpy.rpyToMatrix(0.3, 0.2, a), rng.normal(size=3)).homogeneous for a in angle])
    rows = flat_poses(T)
    back = np.array([pin.XYZQUATToSE3(row).homogeneous for row in rows])
    assert np.abs(back - T).max() < 1e-12
    assert np.abs(np.diff(rows[:, 3:], axis=0)).max() < 0.1


@pytest.mark.parametrize("degrees", [90.0, -150.0])
def test_a_walk_along_another_axis_of_its_laboratory_is_turned_to_the_cameras(robot, gait, scene, degrees):
    across = viewer.scene(robot, turned(gait, np.radians(degrees)))
    assert np.abs(across.arrays["base"] - scene.arrays["base"]).max() < 1e-6
    assert any("Turned about the vertical" in note for note in across.facts.notes)
    assert not any("Turned about the vertical" in note for note in scene.facts.notes)


def test_the_door_shows_the_exoskeleton_as_its_own_compiler_does(robot, gait, scene):
    own = viewer.exoskeleton_scene(robot, gait)
    assert viewer.html(own) == viewer.html(scene)

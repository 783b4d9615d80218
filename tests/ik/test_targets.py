"""Other targets and bodies by the same call: positions, markers, weights, fewer joints, a free pelvis."""

from __future__ import annotations

import re
from importlib.metadata import distribution

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.anatomy import FEET
from exo_pin.errors import DescriptionError
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot, load_urdf

POSE = 1e-9  # [m, rad] the default tolerance
MARKERS = {
    "pelvis": [[0.1, 0.12, 0.05], [0.1, -0.12, 0.05], [-0.15, 0.05, 0.05], [-0.15, -0.05, 0.0]],
    "left_thigh": [[0.06, 0.05, -0.1], [0.0, 0.07, -0.3], [-0.05, 0.0, -0.2]],
    "left_shank": [[0.06, 0.05, -0.1], [0.0, 0.07, -0.3], [-0.05, 0.0, -0.2]],
    "left_sole_plate": [[0.15, 0.0, -0.04], [0.1, 0.05, -0.05], [-0.05, 0.0, -0.03]],
}


def walk(robot, n=8):
    return np.clip(robot.from_gait(normative_gait("free").resampled(n)), robot.lower, robot.upper)


def markers(robot, q, noise=0.0, rng=None):
    """Targets of all marker clusters for configurations (n, nq)."""
    out = {}
    for link, local in MARKERS.items():
        T = poses(robot, q, (link,))[:, 0]
        p = np.einsum("nij,kj->nki", T[:, :3, :3], np.array(local)) + T[:, None, :3, 3]
        if noise:
            p = p + noise * rng.normal(size=p.shape)
        out[link] = ik.Points(local, p)
    return out


def test_positions_alone_are_met_and_rotations_left_free(robot):
    q = walk(robot)
    T = poses(robot, q)
    track = ik.track(robot, {foot: ik.Position(T[:, k, :3, 3]) for k, foot in enumerate(FEET)})
    assert track.converged.all()
    assert track.position_error.max() < POSE
    assert np.isnan(track.rotation_error).all()
    reached = poses(robot, track.q)
    np.testing.assert_allclose(reached[..., :3, 3], T[..., :3, 3], atol=POSE)


def test_a_target_on_a_shank_leaves_the_ankle_alone(robot):
    q = walk(robot, 3)
    T = poses(robot, q, ("left_knee_flexion",))[:, 0]
    track = ik.track(robot, {"left_knee_flexion": ik.Position(T[:, :3, 3])})
    assert track.converged.all()
    np.testing.assert_array_equal(track.q[:, 4:], 0.0)


def test_markers_give_the_joints_and_the_pelvis(rng):
    robot = load_robot(base="floating")
    q = np.tile(robot.neutral, (6, 1))
    q[:, :3] += rng.normal(size=(6, 3)) * 0.3
    turn = rng.normal(size=(6, 4)) * 0.2 + [0.0, 0.0, 0.0, 1.0]
    q[:, 3:7] = turn / np.linalg.norm(turn, axis=1, keepdims=True)
    q[:, 7:13] = walk(load_robot(), 6)[:, :6]
    track = ik.track(robot, markers(robot, q), settings=ik.Dls(tolerance=1e-8))
    assert track.converged.all()
    links = tuple(MARKERS)
    np.testing.assert_allclose(poses(robot, track.q, links), poses(robot, q, links), atol=1e-6)


def test_a_marker_that_was_not_seen_pulls_nowhere(rng):
    robot = load_robot(base="floating")
    q = np.tile(robot.neutral, (2, 1))
    q[:, 10] = 0.5
    targets = markers(robot, q)
    p = np.array(targets["left_shank"].p)
    p[1, 0] = np.nan
    targets["left_shank"] = ik.Points(MARKERS["left_shank"], p)
    track = ik.track(robot, targets, settings=ik.Dls(tolerance=1e-8))
    assert track.converged.all()
    p[1, 0] = [np.inf, 0.0, 0.0]
    targets["left_shank"] = ik.Points(MARKERS["left_shank"], p)
    with pytest.raises(DescriptionError, match="left_shank, frame 1"):
        ik.track(robot, targets)


def test_noisy_markers_are_met_in_the_least_squares_sense(robot, rng):
    """The gradient of the squared errors vanishes along every joint that is not on a limit."""
    q = walk(robot, 2)
    local = np.array(MARKERS["left_shank"])
    T = poses(robot, q, ("left_shank",))[:, 0]
    p = np.einsum("nij,kj->nki", T[:, :3, :3], local) + T[:, None, :3, 3] + 0.01 * rng.normal(size=(2, 3, 3))
    track = ik.track(robot, {"left_shank": ik.Points(local, p)})

    def cost(angles):
        S = poses(robot, angles, ("left_shank",))[0]
        return np.sum((local @ S[:3, :3].T + S[:3, 3] - p[0]) ** 2)

    for j in range(4):
        if not track.active_limits[0, j]:
            step = 1e-5 * np.eye(12)[j]
            slope = (cost(track.q[0] + step) - cost(track.q[0] - step)) / 2e-5
            assert abs(slope) < 1e-7


def test_a_heavier_weight_brings_the_target_nearer(robot):
    T = poses(robot, robot.q()).copy()
    T[:, 2, 3] -= 0.03  # out of reach
    turn = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    T[:, :3, :3] = turn  # and toes straight down, which the ankle's limit forbids
    even = ik.track(robot, {"left_foot": T[None, 0]})
    near = ik.track(robot, {"left_foot": ik.Pose(T[None, 0], position_weight=30.0)})
    assert near.position_error[0, 0] < even.position_error[0, 0]
    assert near.rotation_error[0, 0] > even.rotation_error[0, 0]


def test_a_weight_of_zero_leaves_that_part_free(robot):
    T = poses(robot, walk(robot, 3))[:, 0]
    far = T.copy()
    far[:, 2, 3] -= 2.0
    turned = ik.track(robot, {"left_foot": ik.Pose(far, position_weight=0.0)})
    assert turned.converged.all()
    np.testing.assert_allclose(poses(robot, turned.q)[:, 0, :3, :3], T[:, :3, :3], atol=1e-8)
    placed = ik.track(robot, {"left_foot": ik.Pose(T, rotation_weight=0.0)})
    assert placed.converged.all()
    assert np.isnan(placed.rotation_error).all()


def test_fewer_joints_are_answered_by_least_squares(robot):
    """A leg with its rotation and inversion locked, made from the same URDF."""
    text = robot.urdf
    for movement in ("hip_rotation", "ankle_inversion"):
        for side in ("left", "right"):
            text = re.sub(rf'(name="{side}_{movement}" type=)"revolute"', r'\1"fixed"', text)
    planar = load_urdf(text, placement=robot.placement)
    assert len(planar.joints) == 8
    q = planar.lower + 0.5 * (planar.upper - planar.lower)
    T = poses(planar, q)
    exact = ik.track(planar, {foot: T[None, k] for k, foot in enumerate(FEET)})
    assert exact.converged.all()
    T[0, :3, 3] += [0.0, 0.02, 0.01]
    missed = ik.track(planar, {foot: T[None, k] for k, foot in enumerate(FEET)})
    assert not missed.converged[0]
    assert 0.0 < missed.position_error[0, 0] < 0.0225
    planar.check_limits(missed.q, tolerance=0.0)


def test_a_floating_pelvis_can_be_held_by_base(rng):
    robot = load_robot(base="floating")
    q = np.tile(robot.neutral, (4, 1))
    q[:, 7:] = walk(load_robot(), 4)
    base = np.tile(robot.placement, (4, 1, 1))
    base[:, :3, 3] += rng.normal(size=(4, 3))
    q[:, :3] = base[:, :3, 3]
    T = poses(robot, q)
    track = ik.track(robot, {foot: T[:, k] for k, foot in enumerate(FEET)}, base=base)
    assert track.converged.all()
    assert set(track.answered_by) == {"closed_form"}
    np.testing.assert_allclose(track.q, q, atol=1e-7)


def test_a_humanoid_from_elsewhere_is_answered(rng):
    """TALOS: hips in the order yaw, roll, pitch, one URDF among others, joints of the arms left alone."""
    files = [f for f in distribution("example-robot-data").files or () if f.name == "talos_reduced.urdf"]
    path = files[0].locate()
    robot = load_urdf(path)
    own = [j for j, name in enumerate(robot.joints) if name.startswith("leg_")]
    q = np.zeros((200, robot.nq))
    low, high = np.maximum(robot.lower, -1.0), np.minimum(robot.upper, 1.0)
    q[:, own] = (low + (high - low) * (0.1 + 0.8 * rng.random((200, robot.nq))))[:, own]
    frames = ("left_sole_link", "right_sole_link")
    T = poses(robot, q, frames)
    track = ik.track(robot, {name: T[:, k] for k, name in enumerate(frames)})
    assert track.converged.all()
    assert set(track.answered_by) == {"closed_form"}
    robot.check_limits(track.q, tolerance=0.0)


def test_damping_calms_noisy_feet(robot, rng):
    """Feet with 3 mm of noise throw a nearly straight knee about; the price on motion halves that."""
    gait = normative_gait("free", leg_length=0.93)
    q = np.clip(robot.from_gait(gait.resampled(round(100 * gait.duration))), robot.lower, robot.upper)
    T = poses(robot, q)
    T[..., :3, 3] += 0.003 * rng.normal(size=T[..., :3, 3].shape)
    targets = {foot: T[:, k] for k, foot in enumerate(FEET)}
    knees = [robot.column("left_knee_flexion"), robot.column("right_knee_flexion")]
    plain = ik.track(robot, targets)
    calm = ik.track(robot, targets, settings=ik.Dls(damping=0.05))

    def jump(track):
        return np.degrees(np.abs(np.diff(track.q[:, knees], axis=0)).max())

    def miss(track):
        return np.sqrt(np.mean((track.q - q) ** 2))

    assert jump(plain) > 12.0
    assert jump(calm) < 0.6 * jump(plain)
    assert miss(calm) < miss(plain)
    assert calm.position_error.max() < 0.012


@pytest.mark.parametrize(
    ("target", "reason"),
    [
        (ik.Position(np.zeros((2, 4))), r"\(n, 3\)"),
        (ik.Position(np.full((2, 3), np.nan)), "left_foot, frame 0"),
        (ik.Position(np.zeros((2, 3)), weight=-1.0), "weight"),
        (ik.Points(np.zeros((2, 3)), np.zeros((2, 3, 3))), r"\(n, k, 3\)"),
        (ik.Points(np.zeros((3, 3)), np.zeros((2, 3, 3)), weight=np.nan), "weight"),
        (ik.Pose(np.tile(np.eye(4), (2, 1, 1)), rotation_weight=np.inf), "weight"),
    ],
)
def test_nonsense_is_refused_by_name(robot, target, reason):
    with pytest.raises(DescriptionError, match=reason):
        ik.track(robot, {"left_foot": target})

"""Inverse kinematics finds the angles behind the feet's poses, keeps the limits, and says when it cannot."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin import devices, ik
from exo_pin.anatomy import FEET, HIP_ORDERS, Body
from exo_pin.errors import ConvergenceError, DescriptionError, UnknownNameError
from exo_pin.formats import load_gait
from exo_pin.gait import normative_gait
from exo_pin.kinematics import poses
from exo_pin.robot import load_robot

POSE = 1e-9  # [m, rad] the promise of the issue for a gait
ANGLE = 1e-6  # [rad] the same, where the knee is bent more than 5 degrees
BENT = np.radians(5.0)
SETTINGS = {kind.__name__: kind() for kind in ik.SOLVERS}


@pytest.fixture(scope="module", params=HIP_ORDERS)
def robot(request):
    return load_robot(Body.from_stature(1.75, left_thigh=0.44, right_shank=0.41), hip_order=request.param)


@pytest.fixture(params=SETTINGS.values(), ids=SETTINGS.keys())
def settings(request):
    return request.param


def feet(robot, q, base=None):
    T = poses(robot, q, FEET, base=base)
    return {foot: T[..., k, :, :] for k, foot in enumerate(FEET)}


def uniform(robot, rng, n):
    return robot.lower + (robot.upper - robot.lower) * rng.random((n, 12))


def bent(robot, q):
    """(n, 12) True for the joints of a leg whose knee is bent."""
    out = np.zeros(q.shape, dtype=bool)
    for side in ("left", "right"):
        own = [j.startswith(side) for j in robot.joints]
        out[:, own] = q[:, [robot.column(f"{side}_knee_flexion")]] > BENT
    return out


@pytest.mark.parametrize("samples", [101, 1000])
def test_the_normative_walk_comes_back(robot, settings, samples):
    gait = normative_gait("free", leg_length=robot.body.leg_length).resampled(samples)
    q = robot.from_gait(gait)
    track = ik.track(robot, feet(robot, q, gait.base), base=gait.base, settings=settings)
    assert track.converged.all()
    assert track.position_error.max() < POSE
    assert track.rotation_error.max() < POSE
    assert np.abs(track.q - q)[bent(robot, q)].max() < ANGLE


def test_a_recorded_walk_comes_back_where_it_keeps_the_limits(shared, settings):
    robot = load_robot()
    gait = load_gait(shared / "opensim_subject01_walk" / "subject01_walk1_ik.mot")
    q = robot.from_gait(gait)
    track = ik.track(robot, feet(robot, q, gait.base), base=gait.base, settings=settings)
    outside = (q < robot.lower) | (q > robot.upper)
    assert {robot.joints[j] for j in np.flatnonzero(outside.any(axis=0))} <= {
        "left_knee_flexion",
        "right_knee_flexion",
    }
    assert np.degrees(np.maximum(robot.lower - q, q - robot.upper).max()) < 5.0
    inside = ~outside.any(axis=1)
    assert inside.sum() > 20
    assert track.converged[inside].all()
    assert np.abs(track.q - q)[inside][bent(robot, q)[inside]].max() < ANGLE


def test_random_poses_are_reached_from_mid_range_and_limits_are_kept(robot, settings, rng):
    q = uniform(robot, rng, 300)
    start = np.tile(0.5 * (robot.lower + robot.upper), (len(q), 1))
    track = ik.track(robot, feet(robot, q), start, settings=settings)
    assert track.converged.all()
    robot.check_limits(track.q, tolerance=0.0)


def test_the_errors_are_those_of_the_returned_angles(robot, settings, rng):
    targets = feet(robot, uniform(robot, rng, 20))
    targets["left_foot"] = targets["left_foot"].copy()
    targets["left_foot"][:, 2, 3] -= 0.3
    track = ik.track(robot, targets, settings=settings)
    reached = poses(robot, track.q)
    for f, foot in enumerate(track.frames):
        apart = np.linalg.norm(reached[:, f, :3, 3] - targets[foot][:, :3, 3], axis=1)
        np.testing.assert_allclose(track.position_error[:, f], apart, atol=1e-12)
        turned = np.linalg.norm(reached[:, f, :3, :3] - targets[foot][:, :3, :3], axis=(1, 2))
        angle = 2 * np.arcsin(np.minimum(turned / np.sqrt(8), 1.0))
        np.testing.assert_allclose(track.rotation_error[:, f], angle, atol=1e-7)


def test_a_moving_pelvis_carries_the_targets(robot, settings, rng):
    q = uniform(robot, rng, 5)
    base = np.tile(robot.placement, (5, 1, 1))
    base[:, :2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    base[:, :3, 3] += rng.normal(size=(5, 3))
    track = ik.track(robot, feet(robot, q, base), base=base, settings=settings)
    assert track.converged.all()


def test_one_sample_gives_what_a_track_of_one_gives(robot, settings, rng):
    targets = feet(robot, uniform(robot, rng, 1))
    track = ik.track(robot, targets, settings=settings)
    one = ik.solve(robot, {foot: T[0] for foot, T in targets.items()}, settings=settings)
    np.testing.assert_array_equal(one.q, track.q[0])
    assert one.converged
    assert one.frames == FEET


def test_out_of_reach_is_flagged_with_its_amount(robot, settings):
    targets = feet(robot, robot.q()[None])
    targets["right_foot"] = targets["right_foot"] - np.array([0.0, 0.0, 0.02, 0.0])[:, None] * np.eye(4)[3]
    track = ik.track(robot, targets, settings=settings)
    assert not track.converged[0]
    assert track.reach_slack[0, 1] == pytest.approx(-0.02, abs=1e-9)
    assert track.position_error[0, 1] == pytest.approx(0.02, abs=1e-3)
    assert track.active_limits[0, robot.column("right_knee_flexion")]
    robot.check_limits(track.q, tolerance=0.0)


@pytest.mark.parametrize("settings", [ik.Auto(), ik.Dls()])
def test_a_target_that_leaves_the_reach_is_followed_without_a_jump(robot, settings):
    """Half a millimetre a sample: at the end of reach the knee straightens like a square root."""
    n, step = 120, 0.0005
    T = np.tile(poses(robot, robot.q({"left_knee_flexion": 0.3, "left_hip_flexion": 0.2}))[0], (n, 1, 1))
    T[:, 2, 3] -= step * np.arange(n)
    track = ik.track(robot, {"left_foot": T}, settings=settings)
    out = track.reach_slack[:, 0] < 0.0
    assert 30 < out.sum() < 110
    assert not track.converged[out].any()
    assert track.converged[~out].all()
    jumps = np.abs(np.diff(track.q, axis=0)).max(axis=1)
    assert np.degrees(jumps.max()) < 5.0
    assert np.degrees(jumps[out[:-1]].max()) < 0.2
    assert (track.position_error[out, 0] <= -track.reach_slack[out, 0] + 1e-9).all()


def test_an_ankle_in_the_hip_is_flagged_and_answered_with_numbers(robot, settings):
    T = poses(robot, robot.q())[None, 0].repeat(4, axis=0)
    T[:, :3, 3] = robot.placement[:3, 3] + [0.0, robot.body.hip_width / 2, -robot.body.left_ankle_height]
    track = ik.track(robot, {"left_foot": T}, settings=settings)
    assert not track.converged.any()
    assert np.isfinite(track.q).all()
    robot.check_limits(track.q, tolerance=0.0)


def test_solve_raises_with_the_best_try(robot, settings):
    targets = {foot: T[0] for foot, T in feet(robot, robot.q()[None]).items()}
    targets["left_foot"] = targets["left_foot"] @ np.diag([1.0, 1.0, 1.0, 1.0])
    targets["left_foot"][2, 3] -= 0.05
    with pytest.raises(ConvergenceError, match=r"left_foot misses by .* 50\.0 mm out of reach") as caught:
        ik.solve(robot, targets, settings=settings)
    assert isinstance(caught.value.solution, ik.Solution)
    assert caught.value.solution.position_error[0] == pytest.approx(0.05, abs=2e-3)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused_by_frame_and_sample(robot, settings, bad):
    targets = feet(robot, np.tile(robot.q(), (4, 1)))
    targets["right_foot"][2, 1, 3] = bad
    with pytest.raises(DescriptionError, match="right_foot, frame 2"):
        ik.track(robot, targets, settings=settings)


@pytest.mark.parametrize("change", ["mirrored", "stretched", "bottom"])
def test_matrices_that_are_no_poses_are_refused(robot, settings, change):
    targets = feet(robot, np.tile(robot.q(), (4, 1)))
    T = targets["left_foot"][3]
    if change == "mirrored":
        T[:3, 0] *= -1
    elif change == "stretched":
        T[:3, 0] *= 1.001
    else:
        T[3, 0] = 0.5
    with pytest.raises(DescriptionError, match="left_foot, frame 3: not a pose"):
        ik.track(robot, targets, settings=settings)


def test_wrong_shapes_and_names_are_refused(robot, settings):
    T = np.eye(4)
    with pytest.raises(DescriptionError, match=r"left_foot.*\(n, 4, 4\)"):
        ik.track(robot, {"left_foot": T}, settings=settings)
    with pytest.raises(DescriptionError, match="different numbers of samples"):
        ik.track(robot, {"left_foot": T[None], "right_foot": np.tile(T, (2, 1, 1))}, settings=settings)
    with pytest.raises(DescriptionError, match="q0 has shape"):
        ik.track(robot, {"left_foot": T[None]}, np.zeros(3), settings=settings)
    base = np.tile(T, (3, 1, 1))
    with pytest.raises(DescriptionError, match="2 samples, but base has 3"):
        ik.track(robot, {"left_foot": np.tile(T, (2, 1, 1))}, base=base, settings=settings)
    with pytest.raises(UnknownNameError, match="left_foot"):
        ik.track(robot, {"left_fot": T[None]}, settings=settings)
    with pytest.raises(DescriptionError, match="not an array of real numbers"):
        ik.track(robot, {"left_foot": "here"}, settings=settings)
    with pytest.raises(DescriptionError, match="no target"):
        ik.track(robot, {}, settings=settings)


def test_no_samples_make_an_empty_track(robot, settings):
    track = ik.track(robot, {foot: np.zeros((0, 4, 4)) for foot in FEET}, settings=settings)
    assert track.q.shape == (0, 12)
    assert track.converged.shape == (0,)


def test_targets_are_never_changed_and_answers_are_read_only(robot, settings, rng):
    targets = feet(robot, uniform(robot, rng, 3))
    before = {foot: T.copy() for foot, T in targets.items()}
    track = ik.track(robot, targets, settings=settings)
    for foot in FEET:
        np.testing.assert_array_equal(targets[foot], before[foot])
    with pytest.raises(ValueError, match="read-only"):
        track.q[0, 0] = 1.0


def test_settings_refuse_nonsense():
    with pytest.raises(DescriptionError, match="tolerance"):
        ik.Dls(tolerance=0.0)
    with pytest.raises(DescriptionError, match="damping"):
        ik.Dls(damping=-1.0)
    with pytest.raises(UnknownNameError, match="solver"):
        ik.track(load_robot(), {"left_foot": np.eye(4)[None]}, settings="dls")


def test_a_leg_of_one_joint_comes_as_near_as_it_can():
    robot, whole = load_robot(device=devices.subset(["hip_flexion"])), load_robot()
    walk = whole.q({"left_hip_flexion": 0.3, "left_knee_flexion": 0.2})
    target = poses(whole, walk)[0][None]
    track = ik.track(robot, {"left_foot": ik.Position(target[:, :3, 3])})
    assert not track.converged[0]
    angle = track.q[0, robot.column("left_hip_flexion")]
    for other in (angle - 0.01, angle + 0.01):
        foot = poses(robot, robot.q({"left_hip_flexion": other}))[0, :3, 3]
        assert np.linalg.norm(foot - target[0, :3, 3]) > track.position_error[0, 0]

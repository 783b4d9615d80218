"""The closed form: right branch, right on limits and straight knees, on any body, and only where it holds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exo_pin import ik
from exo_pin.anatomy import FEET, HIP_ORDERS, Body
from exo_pin.errors import ConvergenceError, DescriptionError
from exo_pin.ik.leg import closed_form, scalar
from exo_pin.ik.leg.geometry import exact_geometry
from exo_pin.kinematics import jacobian, poses
from exo_pin.robot import leg_forward as forward
from exo_pin.robot import load_robot, load_urdf

ROUNDING = 1e-14  # [m, rad] a dozen products of numbers of size one
POSE = 1e-12  # [m, rad] the promise
STRAIGHT = 1e-6  # [rad] an arc cosine next to 1 knows half the digits


@pytest.fixture(scope="module", params=HIP_ORDERS)
def robot(request):
    return load_robot(Body.from_stature(1.7, left_thigh=0.43, right_shank=0.40), hip_order=request.param)


def uniform(robot, rng, n):
    return robot.lower + (robot.upper - robot.lower) * rng.random((n, 12))


def on_the_edges(robot, rng, n):
    """Two thirds of the joints exactly on a limit, a third of the knees exactly straight."""
    end = rng.random((n, 12))
    q = np.where(end < 1 / 3, robot.lower, np.where(end < 2 / 3, robot.upper, uniform(robot, rng, n)))
    for side in ("left", "right"):
        q[rng.random(n) < 1 / 3, robot.column(f"{side}_knee_flexion")] = 0.0
    return q


def feet(robot, q):
    T = poses(robot, q)
    return {foot: T[:, k] for k, foot in enumerate(FEET)}


def skewed(robot, joint, angle):
    """The robot with one joint's axis turned by an angle about the vertical."""
    at = robot.urdf.index(f'name="{joint}"')
    begin = robot.urdf.index("<axis", at)
    end = robot.urdf.index("/>", begin) + 2
    axis = f'<axis xyz="{np.sin(angle):.17g} {np.cos(angle):.17g} 0"/>'
    return load_urdf(robot.urdf[:begin] + axis + robot.urdf[end:], placement=robot.placement)


def test_the_chain_agrees_with_pinocchio(robot, rng):
    q = uniform(robot, rng, 50)
    for foot in FEET:
        own = robot.leg(foot)
        R, p = forward.components(
            poses(robot, q, (foot,))[:, 0, :3, :3], poses(robot, q, (foot,))[:, 0, :3, 3]
        )
        tip, J = forward.pose_and_jacobian(own, q[:, own.columns].T)
        distance, angle = forward.errors(tip, R, p)
        assert distance.max() < ROUNDING
        assert angle.max() < ROUNDING
        np.testing.assert_allclose(
            J.transpose(2, 0, 1), jacobian(robot, q, foot)[:, :, own.columns], atol=ROUNDING
        )


def test_angles_between_rotations_are_exact_where_they_are_tiny():
    tiny = 1e-12
    turned = [[1.0, -tiny, 0.0], [tiny, 1.0, 0.0], [0.0, 0.0, 1.0]]
    eye = np.eye(3)
    tip = forward.Tip([[np.array([x]) for x in row] for row in turned], [np.zeros(1)] * 3)
    _, angle = forward.errors(tip, [[np.array([x]) for x in row] for row in eye], [np.zeros(1)] * 3)
    assert angle[0] == pytest.approx(tiny, rel=1e-6)


def test_random_angles_come_back_on_the_right_branch(robot, rng):
    q = uniform(robot, rng, 20_000)
    track = ik.track(robot, feet(robot, q))
    assert set(track.answered_by) == {"closed_form"}
    assert track.position_error.max() < POSE
    assert np.abs(track.q - q).max() < STRAIGHT


def test_limits_and_straight_knees_come_back(robot, rng):
    q = on_the_edges(robot, rng, 20_000)
    track = ik.track(robot, feet(robot, q))
    assert track.converged.all()
    assert track.position_error.max() < POSE
    assert np.abs(track.q - q).max() < STRAIGHT
    robot.check_limits(track.q, tolerance=0.0)


def test_some_poses_need_the_negative_remaining_component(robot, rng):
    """A formula that takes it as positive would fail these."""
    q = uniform(robot, rng, 5000)
    own = robot.leg("left_foot")
    T = poses(robot, q, ("left_foot",))[:, 0]
    ankle = T[:, :3, :3] @ own.ankle_in_frame + T[:, :3, 3]
    up = np.einsum("ni,ni->n", own.hip - ankle, T[:, :3, 2])  # of the hip, as the foot sees it
    backwards = up < 0
    assert 0.01 < backwards.mean() < 0.2
    assert ik.track(robot, {"left_foot": T[backwards]}).converged.all()


@settings(max_examples=12, deadline=None)
@given(
    order=st.sampled_from(sorted(HIP_ORDERS)),
    sizes=st.tuples(*[st.floats(0.25, 0.60)] * 4),
    ankle=st.floats(0.03, 0.12),
    hips=st.floats(0.10, 0.25),
    seed=st.integers(0, 2**32 - 1),
)
def test_any_body_comes_back(order, sizes, ankle, hips, seed):
    body = Body.from_stature(
        1.75,
        left_thigh=sizes[0],
        right_thigh=sizes[1],
        left_shank=sizes[2],
        right_shank=sizes[3],
        left_ankle_height=ankle,
        hip_width=hips,
    )
    robot = load_robot(body, hip_order=order)
    q = uniform(robot, np.random.default_rng(seed), 50)
    track = ik.track(robot, feet(robot, q), settings=ik.ClosedForm())
    assert track.converged.all()
    assert np.abs(track.q - q).max() < STRAIGHT


def test_one_frame_in_plain_math_gives_what_many_frames_give(robot, rng):
    q = uniform(robot, rng, 200)
    for foot in FEET:
        own = robot.leg(foot)
        geometry, formula = exact_geometry(own), scalar.exact_formula(own)
        T = poses(robot, q, (foot,))[:, 0]
        many = closed_form.angles(geometry, *forward.components(T[:, :3, :3], T[:, :3, 3])).T
        one = np.array([formula(pose.ravel().tolist()) for pose in T])
        np.testing.assert_allclose(one, np.clip(many, own.lower, own.upper), atol=1e-9)


def test_a_formula_keeps_the_limits_it_is_made_with(robot):
    """Made twice for one leg, the second one does not answer within the limits of the first."""
    own, knee = robot.leg("left_foot"), 3
    T = poses(robot, robot.q({"left_knee_flexion": 1.0}), ("left_foot",))[0].ravel().tolist()
    narrow = own.upper.copy()
    narrow[knee] = 0.2
    geometry = exact_geometry(own)
    assert scalar.formula(geometry, own.lower, own.upper)(T)[knee] == pytest.approx(1.0)
    assert scalar.formula(geometry, own.lower, narrow)(T)[knee] == 0.2
    assert scalar.exact_formula(own)(T)[knee] == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["left_knee_flexion", "right_ankle_inversion"])
def test_a_robot_with_other_limits_is_answered_within_them(robot, name):
    """Whatever a robot keeps about its legs, a narrower copy does not inherit it."""
    q = robot.q({name: 0.3})
    targets = {foot: T[0] for foot, T in feet(robot, q[None]).items()}
    assert ik.solve(robot, targets).q == pytest.approx(q, abs=STRAIGHT)
    limits = {name: (0.0, 0.2)}
    narrow = load_robot(Body.from_stature(1.7, left_thigh=0.43, right_shank=0.40, limits=limits))
    with pytest.raises(ConvergenceError) as caught:
        ik.solve(narrow, targets)
    best = caught.value.solution
    assert isinstance(best, ik.Solution)
    narrow.check_limits(best.q, tolerance=0.0)


def test_a_leg_that_is_turned_as_a_whole_keeps_its_closed_form(robot, rng):
    turned = np.eye(4)
    turned[:3, :3] = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]]
    turned[:3, 3] = [0.3, -0.2, 1.0]
    other = load_urdf(robot.urdf, placement=turned)
    q = uniform(other, rng, 500)
    track = ik.track(other, feet(other, q), settings=ik.ClosedForm())
    assert track.converged.all()
    assert np.abs(track.q - q).max() < STRAIGHT
    loop = ik.Online(other)
    T = feet(other, q)
    loop.step(T["left_foot"][0], T["right_foot"][0])
    assert loop.reached


def test_a_skewed_axis_is_noticed_and_still_answered(robot, rng):
    other = skewed(robot, "left_knee_flexion", np.radians(2.0))
    assert exact_geometry(other.leg("left_foot")) is None
    assert exact_geometry(other.leg("right_foot")) is not None
    q = uniform(other, rng, 300)
    targets = feet(other, q)
    with pytest.raises(DescriptionError, match="no closed form"):
        ik.track(other, targets, settings=ik.ClosedForm())
    track = ik.track(other, targets)
    assert track.converged.all()
    assert set(track.answered_by) == {"dls"}


def test_permuting_frames_permutes_the_answers(robot, rng):
    q = uniform(robot, rng, 300)
    targets = feet(robot, q)
    order = rng.permutation(len(q))
    there = ik.track(robot, targets)
    back = ik.track(robot, {foot: T[order] for foot, T in targets.items()})
    np.testing.assert_allclose(back.q, there.q[order], atol=1e-12)


def test_no_frame_with_an_error_is_called_converged_and_none_leaves_the_limits(robot, rng):
    """A fuzz: half of the targets out of reach, turned, or nonsense."""
    n = 100_000
    q = uniform(robot, rng, 500)
    T = np.tile(poses(robot, q), (n // len(q), 1, 1, 1))
    T[..., :3, 3] += rng.normal(size=(n, 2, 3)) * rng.choice([0.0, 1e-6, 0.3], size=(n, 2, 1))
    track = ik.track(robot, {foot: T[:, k] for k, foot in enumerate(FEET)}, settings=ik.ClosedForm())
    reached = np.empty_like(T)
    for k, foot in enumerate(FEET):
        own = robot.leg(foot)
        tip = forward.pose(own, track.q[:, own.columns].T)
        reached[:, k, :3, :3] = np.moveaxis(np.array(tip.R), -1, 0)
        reached[:, k, :3, 3] = np.array(tip.p).T
    apart = np.linalg.norm(reached[..., :3, 3] - T[..., :3, 3], axis=-1).max(axis=1)
    assert (apart[track.converged] < 1e-9).all()
    assert (track.converged == (apart < 1e-9)).mean() > 0.999
    robot.check_limits(track.q, tolerance=0.0)

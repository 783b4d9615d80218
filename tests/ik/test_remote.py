"""Inverse kinematics of targets on an accelerator, by an array that allows what CuPy's arrays allow."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.arrays import Array
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics import poses
from exo_pin.robot import Robot, load_robot
from tests.remote_array import RemoteArray

FEET = ("left_foot", "right_foot")
ANGLES = 1e-7  # rounding of the targets at a straight knee (STRAIGHT_COSINE) [rad]
ROUNDING = 1e-14  # of a product of eight poses of about 1 m [m]


@pytest.fixture
def targets(robot: Robot, gait: Gait) -> dict[str, Array]:
    feet = poses(robot, robot.from_gait(gait), FEET)
    return {name: np.ascontiguousarray(feet[:, k]) for k, name in enumerate(FEET)}


@pytest.mark.parametrize("settings", [ik.Auto(), ik.ClosedForm()])
def test_the_answer_is_the_same_and_no_sample_leaves_the_accelerator(
    robot: Robot, targets: dict[str, Array], settings: Any
) -> None:
    RemoteArray.copied = 0
    far = ik.track(robot, _remote(targets), settings=settings)
    assert RemoteArray.copied < len(far)  # questions of whole arrays only: is it a pose, is one missed
    near = ik.track(robot, targets, settings=settings)
    for name in (
        "q",
        "position_error",
        "rotation_error",
        "converged",
        "reach_slack",
        "solver",
        "active_limits",
    ):
        assert isinstance(getattr(far, name), RemoteArray)
        np.testing.assert_array_equal(getattr(far, name).get(), getattr(near, name))


def test_samples_out_of_reach_are_answered_on_the_host(robot: Robot, targets: dict[str, Array]) -> None:
    targets["left_foot"][20:25, 2, 3] -= 0.5
    RemoteArray.copied = 0
    far = ik.track(robot, _remote(targets))
    assert RemoteArray.copied < 5 * len(far)
    near = ik.track(robot, targets)
    np.testing.assert_array_equal(_host(far.q), near.q)
    assert not _host(far.converged)[20:25].any()
    assert far.answered_by[22] == "dls"


@pytest.mark.parametrize("settings", [ik.Dls(), ik.Auto()])
def test_what_has_no_closed_form_is_solved_on_the_host(
    robot: Robot, targets: dict[str, Array], settings: Any
) -> None:
    ankles = {name: ik.Position(RemoteArray(T[:5, :3, 3].copy())) for name, T in targets.items()}
    far = ik.track(robot, ankles, settings=settings)
    near = ik.track(
        robot, {name: ik.Position(T[:5, :3, 3]) for name, T in targets.items()}, settings=settings
    )
    assert isinstance(far.q, RemoteArray)
    np.testing.assert_array_equal(_host(far.q), near.q)


def test_a_moving_pelvis_may_live_on_the_accelerator_or_the_host(
    robot: Robot, gait: Gait, targets: dict[str, Array]
) -> None:
    assert gait.base is not None
    world = {name: gait.base @ np.linalg.inv(robot.placement) @ T for name, T in targets.items()}
    near = ik.track(robot, world, base=gait.base)
    for base in (gait.base, RemoteArray(gait.base)):
        far = ik.track(robot, _remote(world), base=base)
        np.testing.assert_array_equal(_host(far.q), near.q)


def test_a_floating_pelvis_held_or_free_is_answered_from_the_accelerator(gait: Gait) -> None:
    robot = load_robot(base="floating")
    q = robot.from_gait(gait)[:20]
    T = poses(robot, q)
    targets, base = {name: T[:, f] for f, name in enumerate(FEET)}, gait.base
    assert base is not None
    for held in (base[:20], base[0], None):
        near = ik.track(robot, targets, q[0], base=held)
        for start in (q[0], RemoteArray(q[0])):
            there = None if held is None else RemoteArray(held)
            far = ik.track(robot, _remote(targets), start, base=there)
            np.testing.assert_array_equal(_host(far.q), near.q)


def test_a_card_gives_the_answers_of_the_host(robot: Robot, targets: dict[str, Array]) -> None:
    cupy = pytest.importorskip("cupy", reason="needs CuPy (extra gpu)")
    if not cupy.cuda.is_available():
        pytest.skip("needs a card with CUDA")
    targets["left_foot"][20:25, 2, 3] -= 0.5
    far = ik.track(robot, {name: cupy.asarray(T) for name, T in targets.items()})
    assert isinstance(far.q, cupy.ndarray)
    np.testing.assert_allclose(far.q.get(), ik.track(robot, targets).q, atol=ANGLES)


def test_two_kinds_of_arrays_in_one_call_are_refused(robot: Robot, targets: dict[str, Array]) -> None:
    mixed = targets | {"left_foot": RemoteArray(targets["left_foot"])}
    with pytest.raises(DescriptionError, match="one kind"):
        ik.track(robot, mixed)


def test_a_wrong_pose_is_named_as_on_the_host(robot: Robot, targets: dict[str, Array]) -> None:
    targets["right_foot"][7, 0, 0] = np.nan
    with pytest.raises(DescriptionError, match="right_foot, frame 7"):
        ik.track(robot, _remote(targets))


def test_poses_of_feet_are_computed_where_the_angles_live(robot: Robot, gait: Gait) -> None:
    q = robot.from_gait(gait)
    far = poses(robot, RemoteArray(q), FEET, base=gait.base)
    np.testing.assert_allclose(_host(far), poses(robot, q, FEET, base=gait.base), atol=ROUNDING)


def test_frames_off_the_legs_need_an_array_of_the_host(robot: Robot, gait: Gait) -> None:
    with pytest.raises(DescriptionError, match="left_shank"):
        poses(robot, RemoteArray(robot.from_gait(gait)), ["left_shank"])


def _remote(targets: dict[str, Array]) -> dict[str, Any]:
    return {name: RemoteArray(T.copy()) for name, T in targets.items()}


def _host(values: Any) -> Array:
    assert isinstance(values, RemoteArray)
    return np.asarray(values.get())

"""A floating base in q: poses there and back, one and many, against Pinocchio."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.errors import DescriptionError
from exo_pin.robot.floating_base import FREE, base_coordinates, base_poses, unit_quaternion

ROUNDING = 1e-14  # of a rotation's entries


@given(st.integers(0, 2**32 - 1))
def test_poses_become_coordinates_and_poses_again(seed: int) -> None:
    pin.seed(seed)
    T = np.array([pin.SE3.Random().homogeneous for _ in range(5)])
    q = base_coordinates(T)
    assert q.shape == (5, FREE)
    np.testing.assert_allclose(base_poses(q), T, atol=ROUNDING)
    for one, pose in zip(q, T, strict=True):
        theirs = np.asarray(pin.SE3ToXYZQUAT(pin.SE3(pose)))
        np.testing.assert_allclose(one[:3], theirs[:3], atol=ROUNDING)
        np.testing.assert_allclose(abs(one[3:] @ theirs[3:]), 1.0, atol=ROUNDING)
        np.testing.assert_allclose(base_coordinates(pose), one, atol=ROUNDING)
        np.testing.assert_allclose(base_poses(one), pose, atol=ROUNDING)


def test_half_turns_about_every_axis_come_back() -> None:
    T = np.tile(np.eye(4), (3, 1, 1))
    for axis in range(3):
        T[axis, :3, :3] = 2.0 * np.outer(np.eye(3)[axis], np.eye(3)[axis]) - np.eye(3)
    np.testing.assert_allclose(base_poses(base_coordinates(T)), T, atol=ROUNDING)


def test_a_quaternion_is_brought_to_length_1_or_refused() -> None:
    q = np.zeros((2, FREE + 3))
    q[:, 6] = [2.0, 1.0]
    np.testing.assert_array_equal(unit_quaternion(q)[:, 6], 1.0)
    assert unit_quaternion(q[1:])[0, 6] == 1.0
    q[1, 6] = 0.0
    with pytest.raises(DescriptionError, match="quaternion"):
        unit_quaternion(q)

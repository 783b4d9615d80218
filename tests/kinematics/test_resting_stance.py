"""The resting stance: a held pelvis stands upright, faces as the walk does and goes along with it evenly."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.gait import normative_gait
from exo_pin.gait.heading import mean_heading, turned
from exo_pin.kinematics.resting_stance import stand, travel

ROUNDING = 1e-12


@pytest.mark.parametrize("yaw", [0.0, 0.7, np.pi / 2, -2.5])
def test_the_stand_is_upright_and_faces_the_mean_heading(yaw):
    walk = turned(normative_gait("free"), yaw)
    held = stand(walk.time, walk.base, periodic=True)
    np.testing.assert_allclose(held[:, :3, 2], np.tile([0.0, 0.0, 1.0], (len(walk), 1)), atol=ROUNDING)
    np.testing.assert_allclose(
        held[:, :2, 0], np.tile(mean_heading(walk.base), (len(walk), 1)), atol=ROUNDING
    )
    np.testing.assert_allclose(held[0, :2, 0], [np.cos(yaw), np.sin(yaw)], atol=1e-3)
    assert np.linalg.det(held[0, :3, :3]) == pytest.approx(1.0)


def test_under_a_periodic_walk_it_rests_at_the_mean_place():
    walk = normative_gait("slow")
    held = stand(walk.time, walk.base, periodic=True)
    np.testing.assert_allclose(held[:, :3, 3], np.tile(walk.base[:, :3, 3].mean(axis=0), (len(walk), 1)))


def test_over_ground_it_goes_along_a_line_at_the_mean_height(rng):
    time = np.sort(rng.uniform(0.0, 3.0, 40))
    place = np.array([0.2, -0.1, 0.9]) + time[:, None] * [1.3, 0.4, 0.0]
    np.testing.assert_allclose(travel(time, place, periodic=False), place, atol=1e-9)
    bobbing = place + np.sin(9 * time)[:, None] * [0.0, 0.0, 0.03]
    even = travel(time, bobbing, periodic=False)
    np.testing.assert_allclose(even[:, 2], bobbing[:, 2].mean())
    np.testing.assert_allclose(even[:, :2], place[:, :2], atol=1e-9)

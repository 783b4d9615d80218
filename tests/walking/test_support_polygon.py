"""The convex hull and the distance from its edge, by examples that one can see."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exo_pin.errors import DescriptionError
from exo_pin.walking import convex_hull, margin

SQUARE = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]


def test_the_margin_is_the_distance_from_the_nearest_edge_and_negative_outside():
    assert np.allclose(
        margin(SQUARE, [[1.0, 1.0], [0.25, 1.0], [2.0, 1.0], [3.0, 1.0]]), [1.0, 0.25, 0.0, -1.0]
    )


@settings(max_examples=30)
@given(st.lists(st.tuples(*[st.integers(-20, 20)] * 2), min_size=3, max_size=30))
def test_every_point_is_inside_its_own_hull(points):
    points = np.array(points, dtype=float)
    if np.linalg.matrix_rank(points - points[0]) < 2:
        with pytest.raises(DescriptionError):
            convex_hull(points)
        return
    hull = convex_hull(points)
    assert margin(hull, points).min() > -1e-9
    assert set(map(tuple, hull)) <= set(map(tuple, points))


@pytest.mark.parametrize("turn", [0.0, 0.3, np.pi / 2])
def test_corners_on_one_line_but_for_rounding_make_the_hull_that_one_sees(turn):
    """Two soles side by side: eight corners, four of them on two lines within 1e-10."""
    x, y = np.meshgrid([-0.1, 0.1], [-0.2, -0.1, 0.1, 0.2])
    points = np.stack([x.ravel(), y.ravel()], axis=1) + 1e-10 * np.sin(np.arange(16.0)).reshape(8, 2)
    R = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    hull = convex_hull(points @ R.T)
    area = 0.5 * abs(np.sum(hull[:, 0] * np.roll(hull[:, 1], -1) - hull[:, 1] * np.roll(hull[:, 0], -1)))
    assert area == pytest.approx(0.2 * 0.4, abs=1e-6)
    assert margin(hull, points @ R.T).min() > -2e-6

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.viewer.scenes import props
from exo_pin.viewer.scenes.props import Treadmill

speeds = st.floats(0, 3)
periods = st.floats(0.5, 3)


@given(speeds, periods)
def test_the_belt_closes_its_loop_without_a_jump(speed, period):
    mill = Treadmill(0, 2.0, 0, speed, period)
    slats = speed * period / mill.pitch
    assert speed * period < 0.1 or slats == pytest.approx(round(slats), abs=1e-6)
    assert 0.08 < mill.pitch < 0.36


@given(speeds, periods, st.floats(1.5, 4))
def test_slats_stay_on_the_belt_while_they_move(speed, period, length):
    mill = Treadmill(0, length, 0, speed, period)
    commands = props.treadmill("/t", mill)
    x = np.array(
        [c["matrix"][12] for c in commands if c["type"] == "set_transform" and "/slats/" in c["path"]]
    )
    assert len(x) >= 3
    assert x.min() - mill.pitch >= -length / 2 - 1e-9
    assert x.max() <= length / 2 + 1e-9


def test_a_tube_keeps_its_radius_and_looks_outwards():
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    circle = np.stack([np.cos(angle), 0.1 * np.sin(3 * angle), np.sin(angle)], axis=1)
    vertices, faces, normals = props.tube(circle, 0.01, closed=True)
    middle = np.repeat(circle, 8, axis=0)
    assert np.linalg.norm(vertices - middle, axis=1) == pytest.approx(0.01)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    outward = np.einsum("fk,fk->f", np.cross(b - a, c - a), normals[faces].mean(axis=1))
    assert (outward > 0).all()


@pytest.mark.parametrize(("closed", "count"), [(True, 10), (False, 9)])
def test_an_open_tube_does_not_join_its_ends(closed, count):
    points = np.arange(30.0).reshape(10, 3)
    _, faces, _ = props.tube(points, 0.01, closed=closed)
    assert len(faces) == count * 8 * 2


def test_the_grid_covers_the_floor_in_both_directions():
    command = next(c for c in props.floor("/f", 0.0, 9.0) if c["path"] == "/f/grid" and "object" in c)
    packed = command["object"]["geometries"][0]["data"]["attributes"]["position"]["array"]
    ends = np.frombuffer(packed.data, "<f4").reshape(-1, 2, 3)
    assert np.abs(ends[:, 1] - ends[:, 0]).sum(axis=1) == pytest.approx(2.0)
    low, high = ends.min(axis=(0, 1)), ends.max(axis=(0, 1))
    assert low[:2].tolist() == (-high[:2]).tolist()
    assert 5 < high[0] == high[1] < 9


def test_left_is_redder_and_right_is_bluer():
    left, right = props.SIDE_COLORS["left"], props.SIDE_COLORS["right"]
    assert left[0] > 2 * left[2]
    assert right[2] > 2 * right[0]

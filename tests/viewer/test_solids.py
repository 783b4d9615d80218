from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.viewer.meshes import solids

lengths = st.floats(0.004, 1.0)


def volume(solid):
    """By the divergence theorem: right only if every face is seen from outside and no face is missing."""
    a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
    return float(np.einsum("fk,fk->", a, np.cross(b, c)) / 6)


def closed(solid):
    """Whether every edge, by place, is run through once in each direction."""
    places = np.unique(solid.vertices.round(9), axis=0, return_inverse=True)[1].reshape(-1)
    faces = places[solid.faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]  # the poles of a sphere are points
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward, back = ({tuple(edge) for edge in order} for order in (edges, edges[:, ::-1]))
    return forward == back and len(forward) == len(edges)


@given(st.tuples(lengths, lengths, lengths))
def test_a_box_keeps_its_size_and_nearly_its_volume(size):
    solid = solids.box(size)
    assert np.ptp(solid.vertices, axis=0) == pytest.approx(size)
    assert 0.75 * np.prod(size) < volume(solid) <= np.prod(size)
    assert closed(solid)


@given(lengths, lengths)
def test_a_cylinder_keeps_its_size_and_nearly_its_volume(radius, length):
    solid = solids.cylinder(radius, length)
    assert np.ptp(solid.vertices, axis=0) == pytest.approx([2 * radius, 2 * radius, length])
    assert 0.75 < volume(solid) / (np.pi * radius**2 * length) <= 1
    assert closed(solid)


def test_a_sphere_is_closed_and_round():
    solid = solids.sphere(0.2)
    assert np.linalg.norm(solid.vertices, axis=1) == pytest.approx(0.2)
    assert volume(solid) == pytest.approx(4 / 3 * np.pi * 0.008, rel=0.02)
    assert closed(solid)


@pytest.mark.parametrize("solid", [solids.box((1, 2, 3)), solids.cylinder(1, 2), solids.sphere(1)])
def test_normals_are_units_and_point_outwards(solid):
    assert np.linalg.norm(solid.normals, axis=1) == pytest.approx(1)
    a, b, c = (solid.vertices[solid.faces[:, k]] for k in range(3))
    facing = np.einsum("fk,fk->f", np.cross(b - a, c - a), solid.normals[solid.faces].sum(axis=1))
    assert (facing >= -1e-12).all()


def test_joining_and_placing_keep_volumes(rng):
    T = np.eye(4)
    T[:3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    T[:3, :3] *= np.linalg.det(T[:3, :3])
    T[:3, 3] = rng.normal(size=3)
    parts = [solids.box((0.1, 0.2, 0.3)), solids.cylinder(0.1, 0.2)]
    both = solids.joined([parts[0], parts[1].placed(T)])
    assert volume(both) == pytest.approx(sum(map(volume, parts)))

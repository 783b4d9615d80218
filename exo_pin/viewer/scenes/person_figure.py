"""The figure of a person: the meshes of example-robot-data's `human_description`, welded, thinned, turned.

BSD-2-Clause, Gepetto team (LAAS-CNRS). In our axes: x forward, y left, z up.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.errors import ExoPinError
from exo_pin.examples import located
from exo_pin.files import read_bytes
from exo_pin.viewer.meshes.mesh_files import stl_corners
from exo_pin.viewer.meshes.solids import Solid

_Triple = tuple[float, float, float]

_CELL = 0.045
"""Meshes are thinned to cells of this share of their largest side."""

_HOME = "human_description/robots/human.urdf"

MISSING = "the wearer is not drawn: the figure comes with example-robot-data (pip install example-robot-data)"
"""What to say where the figure is not installed."""


def installed() -> bool:
    """Whether the figure can be drawn."""
    return located(_HOME) is not None


def part(name: str, scale: _Triple, offset: _Triple = (0.0, 0.0, 0.0)) -> Solid:
    """A mesh of the figure, scaled and moved.

    Args:
        name: Of its file, without `_mesh.STL`.
        scale: Along x, y, z; the file counts in its own unit.
        offset: Along x, y, z [m].

    Raises:
        ExoPinError: example-robot-data is not installed.
    """
    vertices, faces = _thinned(name)
    return _smooth(vertices * np.array(scale) + np.array(offset), faces)


def scaled(solid: Solid, scale: _Triple) -> Solid:
    """A solid stretched along x, y, z."""
    return _smooth(solid.vertices * np.array(scale), solid.faces)


def _smooth(vertices: Array, faces: Index) -> Solid:
    """A solid whose normals are the mean of the faces around each vertex."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    area = np.cross(b - a, c - a)
    sums = [np.bincount(faces.ravel(), np.repeat(area[:, k], 3), len(vertices)) for k in range(3)]
    normals = np.stack(sums, axis=1)
    return Solid(vertices, faces, normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12))


def _thinned(name: str) -> tuple[Array, Index]:
    """A mesh with its vertices clustered: smooth to look at, a tenth of the size."""
    corners = stl_corners(read_bytes(_folder() / f"{name}_mesh.STL"))[:, [0, 2, 1]] * (1, -1, 1)  # y is up
    cell = _CELL * np.ptp(corners, axis=0).max()
    keys = np.floor((corners - corners.min(axis=0)) / cell).astype(int)
    flat = np.ravel_multi_index(tuple(keys.T), tuple(keys.max(axis=0) + 1))  # sorts faster than rows do
    _, index, count = np.unique(flat, return_inverse=True, return_counts=True)
    vertices = np.stack([np.bincount(index, weights=corners[:, k]) for k in range(3)], axis=1)
    faces = index.reshape(-1, 3)
    kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return vertices / count[:, None], np.unique(faces[kept], axis=0)


def _folder() -> Path:
    urdf = located(_HOME)
    if urdf is None:
        raise ExoPinError(MISSING)
    return urdf.parent.parent / "meshes"

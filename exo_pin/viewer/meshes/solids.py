"""Boxes, cylinders and spheres as triangles with rounded edges, joined into one mesh per material.

A link of twenty primitives would cost twenty draw calls; joined it costs three or four. Over a rounded edge
the normals turn from face to face, so that it catches the light as a machined one does.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array, Index

Color = tuple[float, float, float, float]
"""Red, green, blue and opacity, each from 0 to 1."""

_ROUND = 0.0025
"""Edges are rounded over this [m], or over a sixth of the thinnest side."""

_SEGMENTS = 36
"""Sides of a cylinder."""


@dataclass(frozen=True, eq=False)
class Solid:
    """Triangles: vertices `(v, 3)` [m], faces `(f, 3)` seen from outside, normals `(v, 3)`."""

    vertices: Array
    faces: Index
    normals: Array

    def placed(self, T: Array) -> Solid:
        """The solid at a pose `(4, 4)`."""
        R = T[:3, :3]
        return Solid(self.vertices @ R.T + T[:3, 3], self.faces, self.normals @ R.T)


def translation(x: float, y: float, z: float) -> Array:
    """`(4, 4)` pose without rotation.

    Args:
        x: Forward [m].
        y: Left [m].
        z: Up [m].
    """
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def joined(solids: Iterable[Solid]) -> Solid:
    """Several solids as one."""
    parts = list(solids)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    return Solid(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=True)]),
        np.concatenate([part.normals for part in parts]),
    )


def box(size: ArrayLike) -> Solid:
    """A box with the given lengths along x, y, z [m].

    Every corner of the box has three vertices, one on each of its faces; edges and corners are the strips and
    triangles between them, over which the normals turn.
    """
    half = np.asarray(size, dtype=float) / 2
    inset = min(_ROUND, half.min() / 3)
    return Solid(_BOX_SIGNS * (half - inset) + _BOX_NORMALS * inset, _BOX_FACES, _BOX_NORMALS)


def cylinder(radius: float, length: float) -> Solid:
    """A cylinder along z [m]."""
    inset = min(_ROUND, radius / 3, length / 6)
    angle = np.arange(_SEGMENTS) * 2 * np.pi / _SEGMENTS
    around = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    end, wall = length / 2 * up, (length / 2 - inset) * up
    cap = (radius - inset) * around
    rings = [cap - end, radius * around - wall, radius * around + wall, cap + end]
    turns = [0 * around - up, around, around, 0 * around + up]
    vertices = np.vstack([*rings, -end, end])
    normals = np.vstack([*turns, -up, up])
    here = np.arange(_SEGMENTS)
    after = (here + 1) % _SEGMENTS
    strips = [np.stack([k + here, k + after, k + _SEGMENTS + after, k + _SEGMENTS + here], axis=1)
              for k in (0, _SEGMENTS, 2 * _SEGMENTS)]  # fmt: skip
    quads = np.concatenate(strips)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    low = np.stack([np.full(_SEGMENTS, 4 * _SEGMENTS), after, here], axis=1)
    top = 3 * _SEGMENTS
    high = np.stack([np.full(_SEGMENTS, 4 * _SEGMENTS + 1), top + here, top + after], axis=1)
    return Solid(vertices, np.concatenate([faces, low, high]), normals)


def sphere(radius: float) -> Solid:
    """A sphere [m]."""
    down = np.linspace(0, np.pi, _SEGMENTS // 2 + 1)[:, None]
    angle = np.linspace(0, 2 * np.pi, _SEGMENTS + 1)
    normals = np.stack(
        np.broadcast_arrays(np.sin(down) * np.cos(angle), np.sin(down) * np.sin(angle), np.cos(down)), axis=-1
    )
    i, j = np.mgrid[: _SEGMENTS // 2, :_SEGMENTS]
    width = _SEGMENTS + 1
    quads = np.stack(
        [i * width + j, (i + 1) * width + j, (i + 1) * width + j + 1, i * width + j + 1], axis=-1
    )
    faces = quads.reshape(-1, 4)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    flat = normals.reshape(-1, 3)
    return Solid(radius * flat, faces, flat)


def capsule(end: ArrayLike, radius: float) -> Solid:
    """A rod with round ends from the origin to a point (3,) [m]."""
    tip = np.asarray(end, dtype=float)
    length = float(np.linalg.norm(tip))
    z = tip / length
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(z)))], z)
    T = np.eye(4)
    T[:3, :3] = np.stack([x / np.linalg.norm(x), np.cross(z, x / np.linalg.norm(x)), z], axis=1)
    ball = sphere(radius)
    rod = cylinder(radius, length).placed(translation(*(tip / 2)) @ T)
    return joined([ball, rod, ball.placed(translation(*tip))])


_Numbers = dict[tuple[tuple[int, ...], int], int]
"""Signs of a box's corner and the axis of a face there -> number of the vertex."""


def _box_pattern() -> tuple[Array, Array, Index]:
    """What all boxes share: the corners' signs, the normals, the faces."""
    number: _Numbers = {(signs, axis): 0 for signs in product((-1, 1), repeat=3) for axis in range(3)}
    number = {key: k for k, key in enumerate(number)}
    signs = np.array([key[0] for key in number], dtype=float)
    normals = np.array([np.eye(3)[axis] * corner[axis] for corner, axis in number])
    polygons = [*_box_faces(number), *_box_edges(number), *_box_corners(number)]
    return signs, normals, _triangles(signs + normals / 2, polygons)


def _box_faces(number: _Numbers) -> Iterable[list[int]]:
    for axis, sign in product(range(3), (-1, 1)):
        corners = [signs for signs, a in number if a == axis and signs[axis] == sign]
        a, b, c, d = (number[signs, axis] for signs in corners)
        yield [a, b, d, c]


def _box_edges(number: _Numbers) -> Iterable[list[int]]:
    for along in range(3):
        one, two = (axis for axis in range(3) if axis != along)
        for signs in (s for s, a in number if a == along and s[along] == -1):
            other = tuple(1 if axis == along else sign for axis, sign in enumerate(signs))
            yield [number[signs, one], number[signs, two], number[other, two], number[other, one]]


def _box_corners(number: _Numbers) -> Iterable[list[int]]:
    for signs in dict.fromkeys(signs for signs, _ in number):
        yield [number[signs, axis] for axis in range(3)]


def _triangles(vertices: Array, polygons: Iterable[list[int]]) -> Index:
    """Convex polygons around the origin as triangles, turned so that they are seen from outside."""
    faces = []
    for polygon in polygons:
        for k in range(1, len(polygon) - 1):
            a, b, c = polygon[0], polygon[k], polygon[k + 1]
            outward = np.cross(vertices[b] - vertices[a], vertices[c] - vertices[a]) @ vertices[a]
            faces.append([a, b, c] if outward > 0 else [a, c, b])
    return np.array(faces)


_BOX_SIGNS, _BOX_NORMALS, _BOX_FACES = _box_pattern()

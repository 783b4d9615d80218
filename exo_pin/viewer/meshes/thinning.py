"""Meshes and paths made light: vertices clustered with edges kept, normals smooth but for creases."""

from __future__ import annotations

import heapq

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.viewer.meshes.solids import Solid

_CREASE = np.cos(np.radians(38.0))
"""Faces that meet at a sharper angle show an edge (a choice)."""

_MOST_PAIRS = 20_000_000
"""Corners that are compared with those of the same vertex: bounds memory where thousands share one."""

_WEAK_PLANES = 1e-3
"""Directions in which a cell's planes say less than this share of the most are left at the mean."""


def polyline(points: Array, error: float, most: int) -> Array:
    """Points of a path that suffice to draw it, closely where it turns (Douglas and Peucker 1973).

    The worst stretch is split first, so that a limited number of points goes where it helps most.

    Args:
        points: `(n, 3)`, at least two [m].
        error: Every point left out is nearer than this to the line between its neighbours [m].
        most: No more points than this, at least two, whatever the error.

    Returns:
        `(m, 3)`, a selection that holds both ends.
    """
    kept, stretches = [0, len(points) - 1], [_worst(points, 0, len(points) - 1)]
    while stretches and len(kept) < most:
        away, middle, first, last = heapq.heappop(stretches)
        if -away <= error:
            break
        kept.append(middle)
        heapq.heappush(stretches, _worst(points, first, middle))
        heapq.heappush(stretches, _worst(points, middle, last))
    selected: Array = points[np.sort(kept)]
    return selected


def _worst(points: Array, first: int, last: int) -> tuple[float, int, int, int]:
    """The point of a stretch that lies furthest from the line between its ends, negative for the heap."""
    if last - first < 2:
        return (0.0, first, first, last)
    away = _distances(points[first + 1 : last], points[first], points[last])
    furthest = int(away.argmax())
    return (-float(away[furthest]), first + 1 + furthest, first, last)


def _distances(points: Array, start: Array, end: Array) -> Array:
    """`(n,)` distances of points from the straight line between two others, its ends included."""
    along, seen = end - start, points - start
    length = float(along @ along)
    share = np.clip(seen @ along / length, 0.0, 1.0) if length > 0 else np.zeros(len(points))
    out: Array = np.linalg.norm(seen - share[:, None] * along, axis=1)
    return out


def thinned(vertices: Array, faces: Index, cell: float) -> tuple[Array, Index]:
    """Vertices of the same cell of a grid become one, where the planes of their faces meet best.

    Lindstrom 2000, Out-of-core simplification of large polygonal models: flat walls stay flat and edges
    stay edges, which means of vertices would round off.

    Args:
        vertices: `(v, 3)` [m].
        faces: `(f, 3)`.
        cell: Side of a cell [m].

    Returns:
        Fewer vertices and the faces that are left.
    """
    keys = np.floor((vertices - vertices.min(axis=0)) / cell).astype(np.int64)
    flat = np.ravel_multi_index(tuple(keys.T), tuple(keys.max(axis=0) + 1))
    _, index, count = np.unique(flat, return_inverse=True, return_counts=True)
    mean = np.stack([np.bincount(index, vertices[:, k]) for k in range(3)], axis=1) / count[:, None]
    corners = index[faces]
    kept = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    return _moved_to_planes(mean, vertices, faces, corners, cell), np.unique(corners[kept], axis=0)


def shaded(vertices: Array, faces: Index) -> Solid:
    """A solid with normals: at each corner the mean of the faces around that turn less than a crease."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    area = np.cross(b - a, c - a)
    size = np.linalg.norm(area, axis=1, keepdims=True)
    solid = size[:, 0] > 0  # what has no area has no normal
    faces, area = faces[solid], area[solid]
    unit = area / size[solid]
    corner = np.argsort(faces.ravel(), kind="stable")  # corners of one vertex stand together
    count = np.bincount(faces.ravel(), minlength=len(vertices))
    group = np.repeat(count, count)  # how many share the corner's vertex
    start = np.repeat(np.cumsum(count) - count, count)
    crowded = group > max(_MOST_PAIRS // max(len(corner), 1), 1)  # those keep the normals of their faces
    group, start = np.where(crowded, 1, group), np.where(crowded, np.arange(len(corner)), start)
    one = np.repeat(np.arange(len(corner)), group)
    other = np.repeat(start - (np.cumsum(group) - group), group) + np.arange(len(one))
    mine, its = corner[one] // 3, corner[other] // 3
    near = np.einsum("pk,pk->p", unit[mine], unit[its]) > _CREASE
    sums = [np.bincount(corner[one[near]], area[its[near], k], faces.size) for k in range(3)]
    normals = np.stack(sums, axis=1).astype(float)
    long = np.linalg.norm(normals, axis=1, keepdims=True)
    return _joined(vertices, faces, normals / np.maximum(long, 1e-30))


def _moved_to_planes(mean: Array, vertices: Array, faces: Index, corners: Index, cell: float) -> Array:
    """The means moved to where the planes of the faces at each cell meet best, within the cell."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    n = np.cross(b - a, c - a) / cell**2
    A, r = np.zeros((len(mean), 9)), np.zeros((len(mean), 3))
    outer = (n[:, :, None] * n[:, None, :]).reshape(-1, 9)
    for k in range(3):
        at = corners[:, k]
        offset = n * np.einsum("fk,fk->f", n, a - mean[at])[:, None]
        A += np.stack([np.bincount(at, outer[:, j], len(mean)) for j in range(9)], axis=1)
        r += np.stack([np.bincount(at, offset[:, j], len(mean)) for j in range(3)], axis=1)
    values, axes = np.linalg.eigh(A.reshape(-1, 3, 3))
    strong = values > _WEAK_PLANES * np.maximum(values[:, -1:], 1e-30)
    along = np.einsum("vkj,vk->vj", axes, r)
    step = np.einsum("vkj,vj->vk", axes, np.where(strong, along / np.where(strong, values, 1.0), 0.0))
    return np.asarray(mean + np.where(np.abs(step).max(axis=1, keepdims=True) <= cell, step, 0.0))


def _joined(vertices: Array, faces: Index, normals: Array) -> Solid:
    """Corners with the same place and (rounded) normal become one vertex."""
    rounded = np.round(normals * 127).astype(np.int64) + 128
    key = ((faces.ravel() * 256 + rounded[:, 0]) * 256 + rounded[:, 1]) * 256 + rounded[:, 2]
    _, first, index = np.unique(key, return_index=True, return_inverse=True)
    return Solid(vertices[faces.ravel()[first]], index.reshape(-1, 3), normals[first])

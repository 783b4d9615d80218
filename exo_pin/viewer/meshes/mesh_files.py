"""Mesh files as triangles: STL, OBJ and COLLADA, one entry in a table per kind; geometry and colours alone.

Nothing that a mesh file names (textures, material libraries) is opened.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.errors import FormatError
from exo_pin.files import read_bytes
from exo_pin.viewer.meshes.solids import Color

_BINARY = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEAD = 84  # bytes of a binary STL before its triangles, their number at the end


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles of one colour.

    Attributes:
        vertices: `(v, 3)` in the file's own unit, scaled to metres where the file names its unit.
        faces: `(f, 3)` rows of vertices.
        color: Red, green, blue, opacity, or None where the file names none.
        y_up: Whether the file says that its y points up; most tools ignore it.
    """

    vertices: Array
    faces: Index
    color: Color | None = None
    y_up: bool = False


def read(path: Path) -> list[MeshPart]:
    """The triangles of a mesh file.

    Raises:
        FormatError: It cannot be read, is of no known kind, or is damaged.
    """
    kind = path.suffix.lower()
    if kind not in _READERS:
        raise FormatError(path, f"{kind or 'no ending'} is no mesh; {', '.join(_READERS)} are accepted")
    data = read_bytes(path)
    try:
        parts = _READERS[kind](data)
    except (ValueError, LookupError, OverflowError, ET.ParseError) as error:
        raise FormatError(path, f"is damaged: {error}") from None
    for part in parts:
        if not np.isfinite(part.vertices).all() or (len(part.faces) and not _within(part)):
            raise FormatError(path, "is damaged: a triangle has no such corner")
    return [part for part in parts if len(part.faces)]


def stl(data: bytes) -> list[MeshPart]:
    """An STL file, binary or text."""
    return [_welded(stl_corners(data))]


def stl_corners(data: bytes) -> Array:
    """Corners `(3 f, 3)` of the triangles of an STL file, three a triangle, in the file's own unit.

    Raises:
        ValueError: It is damaged.
    """
    count = int.from_bytes(data[_HEAD - 4 : _HEAD], "little")
    if len(data) >= _HEAD and len(data) >= _HEAD + count * _BINARY.itemsize and not _is_text(data, count):
        corners = np.frombuffer(data, _BINARY, count, _HEAD)["corners"].reshape(-1, 3)
    else:
        words = data.decode("ascii", "replace").split()
        if words[:1] != ["solid"]:
            raise ValueError("neither a binary nor a text STL")
        starts = np.flatnonzero(np.array(words, dtype=object) == "vertex")
        corners = np.array([words[k + 1 : k + 4] for k in starts], dtype=float).reshape(-1, 3)
    return np.asarray(corners[: len(corners) // 3 * 3], dtype=float)


def obj(data: bytes) -> list[MeshPart]:
    """A Wavefront OBJ file; its polygons become fans, its materials are left away."""
    vertices: list[list[float]] = []
    faces: list[tuple[int, int, int]] = []
    for line in data.decode("utf-8", "replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            ring = [k - 1 if k > 0 else len(vertices) + k for k in corners]
            faces += [(ring[0], b, c) for b, c in pairwise(ring[1:])]
    return [
        MeshPart(
            np.array(vertices, dtype=float).reshape(-1, 3), np.array(faces, dtype=np.int64).reshape(-1, 3)
        )
    ]


def dae(data: bytes) -> list[MeshPart]:
    """A COLLADA file."""
    from exo_pin.viewer.meshes.collada import parts

    found, y_up = parts(data)
    return [_used(vertices, faces, color, y_up) for vertices, faces, color in found]


_READERS: Mapping[str, Callable[[bytes], list[MeshPart]]] = MappingProxyType(
    {".stl": stl, ".obj": obj, ".dae": dae}
)
"""What reads the content of a file, by its ending."""


def _is_text(data: bytes, count: int) -> bool:
    """Whether it begins as a text file and has not the size that a binary file's header gives."""
    return data.startswith(b"solid") and len(data) != _HEAD + count * _BINARY.itemsize


def _welded(corners: Array) -> MeshPart:
    """Triangles that share their corners."""
    keys = np.ascontiguousarray(corners.astype("<f4")).view([("", "<f4")] * 3).ravel()
    _, first, index = np.unique(keys, return_index=True, return_inverse=True)
    return MeshPart(corners[first], index.reshape(-1, 3).astype(np.int64))


def _used(vertices: Array, faces: Index, color: Color | None, y_up: bool) -> MeshPart:
    """Without the vertices that no face uses."""
    kept, index = np.unique(faces, return_inverse=True)
    return MeshPart(vertices[kept], index.reshape(-1, 3).astype(np.int64), color, y_up)


def _within(part: MeshPart) -> bool:
    return bool(part.faces.min() >= 0 and part.faces.max() < len(part.vertices))

"""Mesh files as triangles: STL, OBJ and COLLADA, one entry in a table per kind; geometry and colours alone.

Nothing that a mesh file names (textures, material libraries) is opened.
"""

from __future__ import annotations

import io
from array import array
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.errors import DamagedMeshError, FormatError
from exo_pin.files import read_bytes
from exo_pin.viewer.meshes.solids import Color

_BINARY = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_LARGEST = 32
"""Of a file [MiB]."""

MOST_TRIANGLES = 1_200_000
"""Of a file; those of robots have some ten thousand."""

_FURTHEST = 1e6
"""From the origin, along each axis, in the file's unit (often millimetres)."""

_LONGEST_LINE = 2**20
"""Of an OBJ file [characters]."""

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
    if len(data) > _LARGEST * 2**20:
        raise FormatError(path, f"larger than {_LARGEST} MiB; a robot's mesh is smaller")
    try:
        parts = _READERS[kind](data)
    except DamagedMeshError as error:
        raise FormatError(path, f"is damaged: {error}") from None
    except (ValueError, LookupError, OverflowError):
        raise FormatError(path, "is damaged: numbers are missing, too many, or no numbers") from None
    _judge(path, parts)
    return [part for part in parts if len(part.faces)]


def _judge(path: Path, parts: list[MeshPart]) -> None:
    """Refuse corners too far away or not finite, corners that do not exist, and too many triangles."""
    if sum(len(part.faces) for part in parts) > MOST_TRIANGLES:
        raise FormatError(path, f"more than {MOST_TRIANGLES} triangles")
    for part in parts:
        if not (np.abs(part.vertices) <= _FURTHEST).all():
            raise FormatError(path, f"is damaged: a corner is no place within {_FURTHEST:g}")
        if len(part.faces) and not _within(part):
            raise FormatError(path, "is damaged: a triangle has no such corner")


def stl(data: bytes) -> list[MeshPart]:
    """An STL file, binary or text."""
    corners = stl_corners(data)
    if not (np.abs(corners) <= _FURTHEST).all():
        raise DamagedMeshError(f"a corner is no place within {_FURTHEST:g}")
    return [_welded(corners)]


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
            raise DamagedMeshError("neither a binary nor a text STL")
        starts = np.flatnonzero(np.array(words, dtype=object) == "vertex")
        corners = np.array([words[k + 1 : k + 4] for k in starts], dtype=float).reshape(-1, 3)
    return np.asarray(corners[: len(corners) // 3 * 3], dtype=float)


def obj(data: bytes) -> list[MeshPart]:
    """A Wavefront OBJ file; its polygons become fans, its materials are left away."""
    places, faces = array("d"), array("q")
    text = io.TextIOWrapper(io.BytesIO(data), "utf-8", "replace")
    for number, line in enumerate(iter(lambda: text.readline(_LONGEST_LINE), ""), 1):
        if len(line) == _LONGEST_LINE:
            raise DamagedMeshError(f"line {number} is longer than {_LONGEST_LINE} characters")
        words = line.split()
        try:
            if words[:1] == ["v"]:
                places.extend(_place(words))
            elif words[:1] == ["f"]:
                faces.extend(_fan(words, len(places) // 3))
        except (ValueError, OverflowError):
            raise DamagedMeshError(f"line {number} is no {words[0]!r} line of numbers") from None
        if max(len(faces), len(places)) > 3 * MOST_TRIANGLES:
            raise DamagedMeshError(f"more than {MOST_TRIANGLES} triangles or corners")
    return [MeshPart(np.array(places).reshape(-1, 3), np.array(faces, dtype=np.int64).reshape(-1, 3))]


def _place(words: list[str]) -> tuple[float, float, float]:
    x, y, z = map(float, words[1:4])
    return x, y, z


def _fan(words: list[str], known: int) -> list[int]:
    """The triangles of a polygon, one after the other; corners are counted from 1, or from the last."""
    corners = [int(word.partition("/")[0]) for word in words[1:]]
    ring = [k - 1 if k > 0 else known + k for k in corners]
    return [corner for b, c in pairwise(ring[1:]) for corner in (ring[0], b, c)]


def dae(data: bytes) -> list[MeshPart]:
    """A COLLADA file."""
    from exo_pin.viewer.meshes.collada import parts

    found, y_up = parts(data, MOST_TRIANGLES)
    return [MeshPart(vertices, faces, color, y_up) for vertices, faces, color in found]


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


def _within(part: MeshPart) -> bool:
    return bool(part.faces.min() >= 0 and part.faces.max() < len(part.vertices))

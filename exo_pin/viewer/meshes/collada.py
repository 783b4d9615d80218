"""COLLADA files: triangles where the scene puts them, in the diffuse colours of their materials."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.errors import DamagedMeshError, FormatError
from exo_pin.gait.rigid_poses import about
from exo_pin.safe.xml_reader import XmlLimits, parse_xml

_Color = tuple[float, float, float, float]
_Triangles = tuple[Array, Index, _Color | None]

_Read = TypeVar("_Read")

_DEEPEST_NODE = 50
"""Nodes of a scene that are nested deeper are refused: a real one has a handful."""

_MOST_NODES = 10_000
"""Nodes of a scene, each as often as it is shown."""

_MOST_NUMBERS = 8_000_000
"""Of one element: corners of a million triangles."""

_LARGEST_NUMBER = _LARGEST_SCALE = 1e9
"""Of what is read; integers are exact up to it."""

_LIMITS = XmlLimits(mebibytes=64, elements=100_000)
"""Of the XML; its many numbers stand in few elements."""


def parts(data: bytes, most: int) -> tuple[list[_Triangles], bool]:
    """Vertices `(v, 3)` [m], faces `(f, 3)` and colour of each primitive; whether the file has y up.

    The unit is applied, the `up_axis` is not: ROS's tools ignore it, others apply it.

    Args:
        data: The file's content.
        most: Triangles that are read at most; a geometry counts as often as it is shown.

    Raises:
        DamagedMeshError: It is no XML, too large, or refers to what is missing.
        ValueError: Something in the file does not fit.
    """
    text = re.sub(rb'\sxmlns="[^"]*"', b"", data, count=1)  # names without their namespace
    try:
        document = _Document(parse_xml(text, Path("mesh"), _LIMITS), most)
    except FormatError as error:
        raise DamagedMeshError(
            error.why if error.line is None else f"line {error.line}: {error.why}"
        ) from None
    return list(document.triangles()), document.root.findtext("asset/up_axis", "").strip() == "Y_UP"


class _Document:
    def __init__(self, root: ET.Element, most: int) -> None:
        self.root, self.left, self.nodes = root, most, 0
        self.known: dict[ET.Element, Any] = {}  # what was read of an element that many others may show
        self.ids = {str(element.get("id")): element for element in root.iter() if element.get("id")}
        unit = root.find("asset/unit")
        self.unit = 1.0 if unit is None else float(unit.get("meter", "1"))

    def triangles(self) -> Iterator[_Triangles]:
        T = np.diag([self.unit, self.unit, self.unit, 1.0])
        scenes = self.root.findall("library_visual_scenes/visual_scene")
        if not scenes:
            for geometry in self.root.findall("library_geometries/geometry"):
                yield from self._geometry(geometry, T, {})
        for scene in scenes:
            for node in scene.findall("node"):
                yield from self._node(node, T, 0)

    def _node(self, node: ET.Element, T: Array, depth: int) -> Iterator[_Triangles]:
        self.nodes += 1
        if depth > _DEEPEST_NODE or self.nodes > _MOST_NODES:
            raise DamagedMeshError(
                f"more than {_MOST_NODES} nodes, or nodes nested deeper than {_DEEPEST_NODE}"
            )
        for child in node:
            if child.tag in _MOVES:
                T = T @ _MOVES[child.tag](_numbers(child, 16))
        for instance in node.findall("instance_geometry"):
            materials = {
                str(m.get("symbol")): str(m.get("target")) for m in instance.iter("instance_material")
            }
            yield from self._geometry(self._at(instance.get("url")), T, materials)
        for instance in node.findall("instance_node"):
            yield from self._node(self._at(instance.get("url")), T, depth + 1)
        for child in node.findall("node"):
            yield from self._node(child, T, depth + 1)

    def _at(self, url: str | None) -> ET.Element:
        found = self.ids.get(str(url).removeprefix("#"))
        if found is None:
            raise DamagedMeshError(f"refers to {str(url)[:40]!r}, which it does not have")
        return found

    def _geometry(self, geometry: ET.Element, T: Array, materials: dict[str, str]) -> Iterator[_Triangles]:
        for kind in ("triangles", "polylist", "polygons"):
            for primitive in geometry.findall(f"mesh/{kind}"):
                vertices, faces = self._once(primitive, self._primitive)
                self.left -= len(faces)
                if self.left < 0 or not np.abs(T).max() < _LARGEST_SCALE:
                    raise DamagedMeshError("more triangles than a robot's mesh, or scales beyond 1e9")
                symbol = str(primitive.get("material"))
                yield vertices @ T[:3, :3].T + T[:3, 3], faces, self._color(materials.get(symbol, symbol))

    def _once(self, element: ET.Element, read: Callable[[ET.Element], _Read]) -> _Read:
        """What is read of an element, the first time only."""
        if element not in self.known:
            self.known[element] = read(element)
        found: _Read = self.known[element]
        return found

    def _primitive(self, primitive: ET.Element) -> tuple[Array, Index]:
        inputs = {str(i.get("semantic")): i for i in primitive.findall("input")}
        width = 1 + max(int(i.get("offset", "0")) for i in inputs.values())
        vertex = inputs["VERTEX"]
        positions = self._at(vertex.get("source")).find("input[@semantic='POSITION']")
        if positions is None:
            raise DamagedMeshError("its vertices have no positions")
        source = self._at(positions.get("source"))
        floats = source.find("float_array")
        accessor = source.find("technique_common/accessor")
        stride = 3 if accessor is None else int(accessor.get("stride", "3"))
        numbers = np.zeros(0) if floats is None else self._once(floats, _numbers)
        rows = [_numbers(p).astype(np.int64) for p in primitive.findall("p")]
        column = int(vertex.get("offset", "0"))
        corners = [row.reshape(-1, width)[:, column] for row in rows]
        counts = primitive.find("vcount")
        sizes = (
            [len(corner) for corner in corners]
            if primitive.tag == "polygons"
            else [3] * (sum(map(len, corners)) // 3)
            if counts is None
            else _numbers(counts)
        )
        ring = np.concatenate(corners) if corners else np.zeros(0, dtype=np.int64)
        faces = _fans(ring, np.asarray(sizes).astype(np.int64))
        kept, index = np.unique(faces, return_inverse=True)  # without the vertices that no face uses
        if kept.size and kept[0] < 0:
            raise DamagedMeshError("a triangle has no such corner")
        return numbers.reshape(-1, stride)[kept, :3], index.reshape(-1, 3).astype(np.int64)

    def _color(self, target: str) -> _Color | None:
        """The diffuse colour of a material; opacities are left away, exporters disagree on their sense."""
        material = self.ids.get(target.removeprefix("#"))
        effect = None if material is None else material.find("instance_effect")
        found = None if effect is None else self._at(effect.get("url")).find(".//diffuse/color")
        if found is None:
            return None
        red, green, blue = _numbers(found, 4)[:3].tolist()
        return red, green, blue, 1.0


def _fans(ring: Index, sizes: Index) -> Index:
    """Polygons, their corners one after the other, as fans of triangles."""
    if (sizes < 0).any() or (sizes > len(ring)).any() or sizes.sum() != len(ring):
        raise DamagedMeshError("its polygons have other numbers of corners than they say")
    starts = np.cumsum(sizes) - sizes
    fans = np.maximum(sizes - 2, 0)
    polygon = np.repeat(np.arange(len(sizes)), fans)
    k = np.arange(len(polygon)) - np.repeat(np.cumsum(fans) - fans, fans)
    first = starts[polygon]
    return np.stack([ring[first], ring[first + k + 1], ring[first + k + 2]], axis=1).reshape(-1, 3)


def _numbers(element: ET.Element, most: int = _MOST_NUMBERS) -> Array:
    """The numbers in an element, read one at a time: a list of all words would take gigabytes."""
    words = (float(word[0]) for word in re.finditer(r"\S+", element.text or ""))
    numbers = np.fromiter(islice(words, most + 1), dtype=float)
    if len(numbers) > most:
        raise DamagedMeshError(f"more than {most} numbers in <{element.tag[:40]}>")
    if not (np.abs(numbers) < _LARGEST_NUMBER).all():
        raise DamagedMeshError(f"a number in <{element.tag[:40]}> is not below {_LARGEST_NUMBER:g}")
    return numbers


def _translation(numbers: Array) -> Array:
    T = np.eye(4)
    T[:3, 3] = numbers
    return T


def _rotation(numbers: Array) -> Array:
    """About an axis by degrees."""
    T = np.eye(4)
    T[:3, :3] = about(numbers[:3] / max(float(np.linalg.norm(numbers[:3])), 1e-12), math.radians(numbers[3]))
    return T


def _matrix(numbers: Array) -> Array:
    return numbers.reshape(4, 4)


def _scale(numbers: Array) -> Array:
    return np.diag([*numbers.reshape(3), 1.0])


_MOVES = {"matrix": _matrix, "translate": _translation, "rotate": _rotation, "scale": _scale}
"""What moves a node, by its element's name."""

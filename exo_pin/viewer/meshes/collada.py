"""COLLADA files: triangles where the scene puts them, in the diffuse colours of their materials."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator

import numpy as np

from exo_pin.arrays import Array, Index
from exo_pin.gait.rigid_poses import about

_Color = tuple[float, float, float, float]
_Triangles = tuple[Array, Index, _Color | None]

_DEEPEST_NODE = 50
"""Nodes of a scene that are nested deeper are refused: a real one has a handful."""


def parts(data: bytes) -> tuple[list[_Triangles], bool]:
    """Vertices `(v, 3)` [m], faces `(f, 3)` and colour of each primitive; whether the file has y up.

    The unit is applied, the `up_axis` is not: ROS's tools ignore it, others apply it.

    Raises:
        ValueError: Something in the file does not fit.
        KeyError: Something that it refers to is missing.
        xml.etree.ElementTree.ParseError: It is no XML.
    """
    text = re.sub(rb'\sxmlns="[^"]*"', b"", data, count=1)  # names without their namespace
    document = _Document(ET.fromstring(text))
    return list(document.triangles()), document.root.findtext("asset/up_axis", "").strip() == "Y_UP"


class _Document:
    def __init__(self, root: ET.Element) -> None:
        self.root = root
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
        if depth > _DEEPEST_NODE:
            raise ValueError(f"its nodes are nested deeper than {_DEEPEST_NODE}")
        for child in node:
            if child.tag in _MOVES:
                T = T @ _MOVES[child.tag](np.array((child.text or "").split(), dtype=float))
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
        return self.ids[str(url).removeprefix("#")]

    def _geometry(self, geometry: ET.Element, T: Array, materials: dict[str, str]) -> Iterator[_Triangles]:
        for kind in ("triangles", "polylist", "polygons"):
            for primitive in geometry.findall(f"mesh/{kind}"):
                vertices, faces = self._primitive(primitive)
                symbol = str(primitive.get("material"))
                yield vertices @ T[:3, :3].T + T[:3, 3], faces, self._color(materials.get(symbol, symbol))

    def _primitive(self, primitive: ET.Element) -> tuple[Array, Index]:
        inputs = {str(i.get("semantic")): i for i in primitive.findall("input")}
        width = 1 + max(int(i.get("offset", "0")) for i in inputs.values())
        vertex = inputs["VERTEX"]
        positions = self._at(vertex.get("source")).find("input[@semantic='POSITION']")
        if positions is None:
            raise ValueError("its vertices have no positions")
        source = self._at(positions.get("source"))
        floats = source.find("float_array")
        accessor = source.find("technique_common/accessor")
        stride = 3 if accessor is None else int(accessor.get("stride", "3"))
        numbers = np.array(((floats.text if floats is not None else "") or "").split(), dtype=float)
        rows = [np.array((p.text or "").split(), dtype=np.int64) for p in primitive.findall("p")]
        column = int(vertex.get("offset", "0"))
        corners = [row.reshape(-1, width)[:, column] for row in rows]
        counts = primitive.find("vcount")
        sizes = (
            [len(corner) for corner in corners]
            if primitive.tag == "polygons"
            else [3] * (sum(map(len, corners)) // 3)
            if counts is None
            else [int(x) for x in (counts.text or "").split()]
        )
        ring = np.concatenate(corners) if corners else np.zeros(0, dtype=np.int64)
        return numbers.reshape(-1, stride)[:, :3], _fans(ring, np.array(sizes, dtype=np.int64))

    def _color(self, target: str) -> _Color | None:
        """The diffuse colour of a material; opacities are left away, exporters disagree on their sense."""
        material = self.ids.get(target.removeprefix("#"))
        effect = None if material is None else material.find("instance_effect")
        found = None if effect is None else self._at(effect.get("url")).find(".//diffuse/color")
        if found is None:
            return None
        red, green, blue = (float(x) for x in (found.text or "").split()[:3])
        return red, green, blue, 1.0


def _fans(ring: Index, sizes: Index) -> Index:
    """Polygons, their corners one after the other, as fans of triangles."""
    if sizes.sum() != len(ring) or (sizes < 0).any():
        raise ValueError("its polygons have other numbers of corners than they say")
    starts = np.cumsum(sizes) - sizes
    fans = np.maximum(sizes - 2, 0)
    polygon = np.repeat(np.arange(len(sizes)), fans)
    k = np.arange(len(polygon)) - np.repeat(np.cumsum(fans) - fans, fans)
    first = starts[polygon]
    return np.stack([ring[first], ring[first + k + 1], ring[first + k + 2]], axis=1).reshape(-1, 3)


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

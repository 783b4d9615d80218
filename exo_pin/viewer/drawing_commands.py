"""Meshcat's drawing commands as plain dicts: shapes, materials, placements; the same bytes on every run.

meshcat's own Python classes draw random identifiers and take 0.2 s to import (they bring ZMQ along); the
protocol itself is three.js's JSON object format in four kinds of command, and that is all the page needs.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Command = dict[str, Any]
"""One meshcat command: `type`, `path` and what belongs to the type."""


_SEGMENTS = 40
_ARRAYS = {
    "float32": ("Float32Array", 0x17),
    "uint32": ("Uint32Array", 0x16),
    "uint16": ("Uint16Array", 0x14),
}
"""What meshcat calls an array type, and its msgpack extension type."""

_GRAIN = 2.0**-15
"""Vertices are rounded to this [m] (0.03 mm), normals to 2^-7: short numbers compress to half."""
_UPRIGHT = [1.0, 0, 0, 0, 0, 0, 1.0, 0, 0, -1.0, 0, 0, 0, 0, 0, 1.0]
"""Turns three.js's cylinder, whose axis is y, to the URDF's z (column by column)."""


@dataclass(frozen=True)
class Material:
    """The surface of a shape.

    Attributes:
        color: Red, green, blue and opacity, each from 0 to 1.
        roughness: 0 mirror, 1 chalk.
        metalness: 0 plastic, 1 bare metal.
        glow: Share of the colour that shines by itself.
        more: Further three.js properties, e.g. `depthWrite`.
    """

    color: tuple[float, float, float, float]
    roughness: float = 0.5
    metalness: float = 0.1
    glow: float = 0.0
    more: tuple[tuple[str, Any], ...] = ()

    def command(self) -> Command:
        """The material as three.js reads it."""
        red, green, blue, opacity = self.color
        data = {
            "type": "MeshStandardMaterial",
            "color": hexadecimal((red, green, blue)),
            "emissive": hexadecimal((red * self.glow, green * self.glow, blue * self.glow)),
            "roughness": self.roughness,
            "metalness": self.metalness,
            "opacity": opacity,
            "transparent": opacity < 1.0,
            "side": 0,
        }
        return data | dict(self.more)


@dataclass(frozen=True)
class Shape:
    """A geometry as three.js reads it, and the placement that belongs to the shape itself."""

    geometry: Command
    matrix: Sequence[float] = field(default_factory=lambda: np.eye(4).ravel().tolist())


def hexadecimal(color: Sequence[float]) -> int:
    """Red, green, blue from 0 to 1 as the number 0xrrggbb."""
    red, green, blue = (round(255 * min(max(part, 0.0), 1.0)) for part in color)
    return red << 16 | green << 8 | blue


def box(size: Sequence[float]) -> Shape:
    """A box with the given lengths along x, y, z [m]."""
    width, height, depth = map(float, size)
    return Shape({"type": "BoxGeometry", "width": width, "height": height, "depth": depth})


def cylinder(radius: float, length: float) -> Shape:
    """A cylinder along z [m]."""
    data = {"radiusTop": radius, "radiusBottom": radius, "height": length, "radialSegments": _SEGMENTS}
    return Shape({"type": "CylinderGeometry", **data}, _UPRIGHT)


def sphere(radius: float) -> Shape:
    """A sphere [m]."""
    return Shape({"type": "SphereGeometry", "radius": radius, "widthSegments": 28, "heightSegments": 20})


def mesh(vertices: ArrayLike, faces: ArrayLike, normals: ArrayLike | None = None) -> Shape:
    """Triangles.

    Args:
        vertices: `(v, 3)` [m].
        faces: `(f, 3)` rows of vertices.
        normals: `(v, 3)`; three.js makes smooth ones if left out.
    """
    attributes = {"position": _packed(np.round(np.asarray(vertices) / _GRAIN) * _GRAIN, "<f4")}
    if normals is not None:
        attributes["normal"] = _packed(np.round(np.asarray(normals) * 128) / 128, "<f4")
    index = _packed(np.reshape(faces, (-1, 1)), "<u2" if len(np.asarray(vertices)) < 65_536 else "<u4")
    return Shape({"type": "BufferGeometry", "data": {"attributes": attributes, "index": index}})


def draw(path: str, shape: Shape, material: Material, *, order: int = 0) -> Command:
    """Puts a shape at a path, replacing what was there.

    Args:
        path: Node.
        shape: Geometry.
        material: Surface.
        order: Rendering order: translucent things with a higher one are drawn later.
    """
    return _object(path, "Mesh", shape, material.command(), {"renderOrder": order} if order else {})


def translucent(path: str, shape: Shape, color: tuple[float, float, float, float]) -> Command:
    """A see-through body of which only the outer skin shows.

    The shape is drawn twice: first into the depth buffer alone, then in colour where it is nearest, so that
    its inner parts and far sides stay hidden.

    Args:
        path: Node.
        shape: Geometry.
        color: Red, green, blue and opacity, each from 0 to 1.
    """
    depth = {"type": "MeshBasicMaterial", "color": 0, "transparent": True, "colorWrite": False, "side": 0}
    nearest = (("depthWrite", False), ("depthFunc", 3))  # three.js's "less or equal"
    skin = Material(color, 0.8, 0.0, more=nearest).command()
    name = _identifier(path)
    ids = {"geometry": f"g{name}", "type": "Mesh"}
    command = _object(path, "Group", shape, skin, {})
    data = command["object"]
    data["materials"].append({"uuid": f"d{name}", **depth})
    data["object"]["children"] = [
        {"uuid": f"a{name}", "material": f"d{name}", "renderOrder": 1, "castShadow": True, **ids},
        {"uuid": f"b{name}", "material": f"m{name}", "renderOrder": 2, **ids},
    ]
    return command


def lines(path: str, points: ArrayLike, color: Sequence[float], opacity: float) -> Command:
    """Separate thin lines.

    Args:
        path: Node.
        points: `(2 k, 3)` ends, two a line [m].
        color: Red, green, blue, each from 0 to 1.
        opacity: 0 to 1.
    """
    position = {"position": _packed(np.asarray(points), "<f4")}
    shape = Shape({"type": "BufferGeometry", "data": {"attributes": position}})
    style = {"color": hexadecimal(color), "opacity": opacity, "transparent": True}
    return _object(path, "LineSegments", shape, {"type": "LineBasicMaterial", **style}, {})


def place(path: str, T: ArrayLike) -> Command:
    """Sets the pose of a node in its parent, `(4, 4)`."""
    matrix = np.asarray(T, dtype=np.float64).T.ravel().tolist()
    return {"type": "set_transform", "path": path, "matrix": matrix}


def setting(path: str, name: str, value: Any) -> Command:
    """Sets a property of a node.

    Args:
        path: Node.
        name: Property as three.js names it, e.g. `"visible"`.
        value: Plain value for JSON.
    """
    return {"type": "set_property", "path": path, "property": name, "value": value}


def _object(path: str, kind: str, shape: Shape, material: Command, extra: Command) -> Command:
    name = _identifier(path)
    item = {"uuid": f"o{name}", "type": kind, "geometry": f"g{name}", "material": f"m{name}", **extra}
    return {
        "type": "set_object",
        "path": path,
        "object": {
            "metadata": {"version": 4.5, "type": "Object"},
            "geometries": [{"uuid": f"g{name}", **shape.geometry}],
            "materials": [{"uuid": f"m{name}", **material}],
            "object": {**item, "matrix": list(shape.matrix)},
        },
    }


def _identifier(path: str) -> str:
    """The identifier that three.js wants for every part, made from the path instead of at random."""
    return f"{zlib.crc32(path.encode()):08x}"


def _packed(rows: NDArray[Any], kind: str) -> Command:
    import umsgpack  # comes with meshcat

    rows = np.ascontiguousarray(rows, dtype=kind)
    name, code = _ARRAYS[rows.dtype.name]
    data = umsgpack.Ext(code, rows.tobytes())
    return {"itemSize": rows.shape[1], "type": name, "array": data, "normalized": False}

"""Props around the figures: light, floor, treadmill, the feet's paths, the centre of mass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Index
from exo_pin.ground import PlacedWalk
from exo_pin.viewer.drawing_commands import (
    Command,
    Material,
    box,
    cylinder,
    draw,
    lines,
    mesh,
    place,
    setting,
    sphere,
)
from exo_pin.viewer.meshes.solids import translation
from exo_pin.viewer.scenes.scene import Belt, Box

SIDE_COLORS: dict[Side, tuple[float, float, float]] = {
    "left": (0.82, 0.24, 0.29),
    "right": (0.16, 0.46, 0.78),
}
"""Red left, blue right, in the scene and in the plots alike."""

PLAIN_LIGHTS = {
    "AmbientLight": 0.50,
    "PointLightNegativeX": 0.26,
    "PointLightPositiveX": 0.24,
    "FillLight": 0.10,
    "SpotLight": 0.22,
}
"""Intensities where software renders without environment and shadow."""

_STUDIO = {"AmbientLight": 0.12, "PointLightNegativeX": 0.06, "PointLightPositiveX": 0.06, "FillLight": 0.05}

DECK = 0.118
"""Height of the belt above the floor [m]."""

_TAIL, _HOOD, _BREADTH = 0.2, 0.34, 0.85
"""Of a treadmill [m]: what its rails reach beyond the belt, length of the hood, width."""

_SLAT = 0.175  # distance of the slats is about this [m]
_RING = 8  # corners of a tube's cross-section


@dataclass(frozen=True)
class Treadmill:
    """A treadmill under the walk.

    Attributes:
        center: Its middle along x [m].
        length: Of the belt [m].
        height: Of the belt's surface [m].
        speed: Of the belt [m/s].
        period: Duration of the loop [s], in which the belt moves on by whole slats.
        aside: Its middle along y [m].
    """

    center: float
    length: float
    height: float
    speed: float
    period: float
    aside: float = 0.0

    @classmethod
    def under(cls, walk: PlacedWalk, period: float = 1.0) -> Treadmill:
        """The treadmill under a walk on the spot.

        Args:
            walk: The walk on its ground.
            period: In which its belt moves on by whole slats [s].
        """
        low, high = float(walk.corners[..., 0].min()), float(walk.corners[..., 0].max())
        length = max(high - low + 0.75, 1.5)
        return cls((low + high) / 2 + 0.05, length, 0.0, walk.support.belt_speed, period)

    @property
    def pitch(self) -> float:
        """Distance of the slats [m]: whole slats a loop, so that the belt does not jump when it closes."""
        travel = self.speed * self.period
        return travel / max(round(travel / _SLAT), 1) if travel > _SLAT / 2 else _SLAT


def studio() -> list[Command]:
    """Background, dimmed default lights, one spot light with shadow; meshcat's grid and axes are hidden."""
    spot = "/Lights/SpotLight/<object>"
    return [
        setting("/Background", "top_color", [0.925, 0.945, 0.965]),
        setting("/Background", "bottom_color", [0.885, 0.91, 0.935]),
        setting("/Grid", "visible", False),
        setting("/Axes", "visible", False),
        *(setting(f"/Lights/{name}/<object>", "intensity", value) for name, value in _STUDIO.items()),
        setting("/Lights/SpotLight", "visible", True),
        setting(spot, "castShadow", True),
        setting(spot, "position", [1.6, 2.2, 4.2]),
        setting(spot, "intensity", 0.36),
        setting(spot, "penumbra", 1.0),
        setting(spot, "angle", 0.75),
    ]


def floor(path: str, height: float, reach: float) -> list[Command]:
    """A matt floor with a thin half-metre grid.

    Args:
        path: Node.
        height: Of its surface [m].
        reach: How far it must extend each way [m]; it is larger where the fog demands it.
    """
    half = 2 * math.ceil(max(reach, 9) / 2)  # beyond the fog: the floor has no visible edge
    matt = Material((0.667, 0.702, 0.737, 1.0), 1.0, 0.0, glow=0.34, more=(("envMapIntensity", 0.5),))
    return [
        draw(f"{path}/plane", box((2 * half, 2 * half, 0.02)), matt),
        place(f"{path}/plane", translation(0, 0, height - 0.011)),
        lines(f"{path}/grid", _grid(half - 4), (0.30, 0.34, 0.39), 0.32),
        place(f"{path}/grid", translation(0, 0, height + 0.001)),
    ]


def _grid(half: int) -> Array:
    """Ends of the grid's lines, in pieces of 2 m: some renderers drop lines that reach behind the camera."""
    along, across = np.meshgrid(np.arange(-half, half, 2), np.arange(-half, half + 0.25, 0.5))
    start = np.stack([along, across, 0 * across], axis=-1).reshape(-1, 1, 3)
    pieces = np.concatenate([start, start + np.array([2.0, 0.0, 0.0])], axis=1)
    return np.concatenate([pieces, pieces[..., [1, 0, 2]]]).reshape(-1, 3)


def treadmill(path: str, mill: Treadmill) -> list[Command]:
    """Belt, rails, hood and slats; the slats hang in one node that the page moves."""
    dark = Material((0.10, 0.11, 0.12, 1.0), 0.8, 0.05)
    metal = Material((0.30, 0.33, 0.37, 1.0), 0.45, 0.25)
    signal = Material((0.95, 0.55, 0.12, 1.0), 0.5, 0.0)
    long, hood = mill.length + _TAIL, mill.length / 2 + _HOOD / 2
    parts = [
        ("belt", (mill.length, 0.62, 0.03), (0.0, 0.0, -0.0151), dark),
        ("hood", (_HOOD, _BREADTH, 0.15), (hood, 0.0, -0.042), metal),
    ]
    for name, s in (("left", 1), ("right", -1)):
        parts.append((f"rail_{name}", (long, 0.11, DECK), (0.0, 0.365 * s, -DECK / 2 + 0.002), metal))
        parts.append((f"strip_{name}", (long, 0.008, 0.022), (0.0, 0.4212 * s, -0.05), signal))
    commands = [place(path, translation(mill.center, mill.aside, mill.height))]
    for name, size, at, material in parts:
        commands += [draw(f"{path}/{name}", box(size), material), place(f"{path}/{name}", translation(*at))]
    return commands + _slats(f"{path}/slats", mill)


def frame(mill: Treadmill) -> Box:
    """What a camera has to frame to show all of the treadmill."""
    back, front = -(mill.length + _TAIL) / 2, mill.length / 2 + _HOOD
    center = (mill.center + (back + front) / 2, mill.aside, mill.height - DECK / 2)
    return Box(center, (front - back, _BREADTH, DECK))


def belt(paths: Sequence[str], mill: Treadmill) -> Belt:
    """What the page needs to move the slats of equal treadmills at some paths."""
    return Belt(tuple(f"{path}/slats" for path in paths), mill.pitch, mill.speed)


def _slats(path: str, mill: Treadmill) -> list[Command]:
    material = Material((0.32, 0.34, 0.36, 1.0), 0.8, 0.05)
    first = -mill.length / 2 + mill.pitch  # they move back by up to one pitch and stay on the belt
    count = int(mill.length / mill.pitch + 1e-9)
    commands = []
    for k in range(count):
        commands.append(draw(f"{path}/{k}", box((0.008, 0.60, 0.002)), material))
        commands.append(place(f"{path}/{k}", translation(first + k * mill.pitch, 0, 0.0005)))
    return commands


def trace(path: str, points: Array, color: tuple[float, float, float], *, closed: bool) -> Command:
    """A path in space as a thin tube (GL's own lines are one pixel wide).

    Args:
        path: Node.
        points: `(n, 3)` in the world [m].
        color: Red, green, blue.
        closed: Whether the last point leads to the first.
    """
    vertices, faces, normals = tube(points, 0.0045, closed=closed)
    return draw(path, mesh(vertices, faces, normals), Material((*color, 0.95), 0.5, 0.0, glow=0.4))


def tube(points: Array, radius: float, *, closed: bool) -> tuple[Array, Index, Array]:
    """Triangles of a tube around a polyline.

    Args:
        points: `(n, 3)` [m].
        radius: Of the tube [m].
        closed: Whether the last point leads to the first.

    Returns:
        Vertices `(8 n, 3)`, faces, normals `(8 n, 3)`.
    """
    before = np.roll(points, 1, axis=0) if closed else np.vstack([points[:1], points[:-1]])
    after = np.roll(points, -1, axis=0) if closed else np.vstack([points[1:], points[-1:]])
    along = _unit(after - before)
    across = _unit(np.cross(along, [0.0, 1.0, 0.0]))
    angle = np.linspace(0, 2 * np.pi, _RING, endpoint=False)[:, None]
    normals = np.cos(angle) * across[:, None] + np.sin(angle) * np.cross(along, across)[:, None]
    n, k = len(points), np.arange(_RING)
    i = np.arange(n if closed else n - 1)[:, None]
    near, far = i * _RING, (i + 1) % n * _RING
    quads = np.stack([near + k, far + k, far + (k + 1) % _RING, near + (k + 1) % _RING], axis=-1)
    faces = quads.reshape(-1, 4)[:, [0, 2, 1, 0, 3, 2]].reshape(-1, 3)
    return (points[:, None] + radius * normals).reshape(-1, 3), faces, normals.reshape(-1, 3)


def centre_of_mass(path: str) -> list[Command]:
    """A ball for the centre of mass and a disc for its projection on the ground."""
    gold = (0.95, 0.72, 0.02, 1.0)
    return [
        draw(f"{path}/ball", sphere(0.028), Material(gold, 0.35, 0.1, glow=0.15)),
        draw(f"{path}/disc", cylinder(0.035, 0.004), Material(gold, 0.6, 0.0, glow=0.15)),
    ]


def contact_sole(
    path: str, size: tuple[float, float], center: tuple[float, float, float], T: Array
) -> list[Command]:
    """A green plate around a sole, shown while the foot stands.

    Args:
        path: Node below the foot's.
        size: Length and width [m].
        center: In the sole's own axes [m].
        T: Pose of these axes in the foot's node (4, 4).
    """
    green = Material((0.21, 0.78, 0.35, 1.0), 0.6, 0.0, glow=0.25)
    length, width = size
    return [draw(path, box((length, width, 0.016)), green), place(path, T @ translation(*center))]


def _unit(v: Array) -> Array:
    long = np.linalg.norm(v, axis=-1, keepdims=True)
    unit: Array = v / np.maximum(long, 1e-12)
    return unit

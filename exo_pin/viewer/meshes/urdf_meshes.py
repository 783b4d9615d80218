"""The meshes that a URDF names: found inside its own package alone, thinned, in the link's own metres.

A URDF is not trusted: no file name in it is followed out of the folders that belong to it: the URDF's
own folder (and the one above, where it lies in a folder like `urdf/`), the package that it lies in, packages
beside that one, those of ROS's search path, and example-robot-data.
"""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from exo_pin import ros_packages
from exo_pin.errors import FormatError
from exo_pin.viewer.meshes import mesh_files
from exo_pin.viewer.meshes.solids import Color, Solid
from exo_pin.viewer.meshes.thinning import shaded, thinned

_Triple = tuple[float, float, float]

_FINENESS = 280
"""Meshes are thinned to cells of this share of the robot's size: 6 mm for a person's."""

_MOST_TRIANGLES = 3_000_000
"""Triangles that are read at most; what comes then is left away."""


@dataclass(frozen=True, eq=False)
class ThinnedFile:
    """A mesh file as it is drawn.

    Attributes:
        triangles: Number of triangles in the file.
        y_up: Whether the file says that its y points up.
        parts: Its parts, thinned, each with its colour if it has one.
    """

    triangles: int
    y_up: bool
    parts: tuple[tuple[Solid, Color | None], ...]


class ThinnedFiles:
    """Reads and thins mesh files, each once: a robot and its ghost share them."""

    def __init__(self) -> None:
        self._known: dict[tuple[Path, _Triple, float, bool], ThinnedFile] = {}

    def read(self, path: Path, scale: _Triple, cell: float, *, turned: bool) -> ThinnedFile:
        """A mesh file.

        Args:
            path: Of the file.
            scale: Factors along x, y, z; a negative product mirrors.
            cell: Side of a cell in which vertices become one [m].
            turned: What has y up is turned to z up.

        Raises:
            FormatError: It cannot be read, is of no known kind, or is damaged.
        """
        key = path, scale, cell, turned
        if key not in self._known:
            parts = mesh_files.read(path)
            self._known[key] = ThinnedFile(
                sum(len(part.faces) for part in parts),
                any(part.y_up for part in parts),
                tuple((_thin(part, scale, cell, turned), part.color) for part in parts),
            )
        return self._known[key]


class Meshes:
    """Finds and reads the meshes of one URDF; what cannot be had is counted in `missing`, with a reason."""

    def __init__(
        self, urdf: Path | None, size: float, files: ThinnedFiles | None = None, *, turned: bool = False
    ) -> None:
        """Read on demand.

        Args:
            urdf: The URDF's path; None: it has no meshes.
            size: Of the robot [m].
            files: Files that were read before.
            turned: Apply COLLADA's `up_axis`: what has y up is turned to z up.
        """
        self.files = files or ThinnedFiles()
        self.turned, self.y_up = turned, False
        self.urdf = None if urdf is None else Path(os.path.realpath(urdf))
        self.cell = size / _FINENESS
        self.missing: dict[str, str] = {}
        self.triangles = 0

    def solids(self, name: str, scale: _Triple) -> list[tuple[Solid, Color | None]]:
        """The parts of a mesh by its file name in the URDF, each with its colour if it has one."""
        path = self.find(name)
        if path is None:
            self.missing[name] = "not found in the URDF's package"
            return []
        try:
            file = self.files.read(path, scale, self.cell, turned=self.turned)
        except FormatError as error:
            self.missing[name] = error.why
            return []
        self.y_up = self.y_up or file.y_up
        self.triangles += file.triangles
        if self.triangles > _MOST_TRIANGLES:
            self.missing[name] = f"more than {_MOST_TRIANGLES} triangles in all"
            return []
        return list(file.parts)

    def find(self, name: str) -> Path | None:
        """Where a file name of the URDF leads, or None where that is outside of what belongs to the URDF."""
        if self.urdf is None or "\0" in name:
            return None
        scheme, mark, rest = name.partition("://")
        if mark and scheme == "package":
            package, _, inside = rest.lstrip("/").partition("/")
            tried = [(root, root / inside) for root in ros_packages.named(self.urdf, package)]
        elif mark and scheme != "file":
            return None
        else:
            tried = [
                (root, self.urdf.parent / (rest if mark else name)) for root in ros_packages.own(self.urdf)
            ]
        for root, path in tried:
            with suppress(OSError):  # a name that is too long
                real = Path(os.path.realpath(path))
                if real.is_relative_to(os.path.realpath(root)) and real.is_file():
                    return real
        return None


def _thin(part: mesh_files.MeshPart, scale: _Triple, cell: float, turned: bool) -> Solid:
    vertices = part.vertices
    if part.y_up and turned:
        vertices = vertices[:, [0, 2, 1]] * (1, -1, 1)
    vertices = vertices * np.array(scale)
    faces = part.faces if np.prod(scale) > 0 else part.faces[:, ::-1]
    size = float(np.ptp(vertices, axis=0).max())
    # smaller for small parts, so that a finger is not a lump; never so small that a grid overflows
    return shaded(*thinned(vertices, faces, max(min(cell, size / 24), size / 4000, 1e-6)))

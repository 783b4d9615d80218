"""ROS packages: the folders that a URDF or xacro file belongs to, and those that it may name.

A description is not trusted: no file name in it is followed out of these folders.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from exo_pin.examples import located

_MANIFEST = 65536
"""Characters of a package.xml in which its name is looked for."""

_INNER = ("urdf", "urdfs", "robot", "robots", "model", "models", "xacro")
"""Names of folders that lie inside a package rather than being it."""


def own(file: Path) -> Iterator[Path]:
    """The folders in which a description may name files by their place."""
    yield file.parent.parent if file.parent.name.lower() in _INNER else file.parent
    for folder in file.parents:
        if (folder / "package.xml").is_file():
            yield folder
            return


def named(file: Path, name: str) -> Iterator[Path]:
    """The folders that a package of that name may be: around the file, on ROS's search paths.

    Args:
        file: The description, its path resolved.
        name: Of the package.
    """
    if not name or name in (".", "..") or "/" in name or os.sep in name:
        return
    yield from _around(file, name)
    for root in _search_path("ROS_PACKAGE_PATH"):
        yield from (folder for folder in (root, root / name) if folder.name == name)
    for root in _search_path("AMENT_PREFIX_PATH"):
        yield root / "share" / name
    if name == "example-robot-data":
        manifest = located("example-robot-data/package.xml")
        if manifest is not None:
            yield manifest.parent


def _around(file: Path, name: str) -> Iterator[Path]:
    """The packages of that name that a description lies in, or beside."""
    for folder in file.parents:
        if folder.name == name or _manifest_name(folder) == name:
            yield folder
        if (folder / name / "package.xml").is_file():
            yield folder / name


def _manifest_name(folder: Path) -> str:
    """The name of the package that lies in a folder, by its package.xml; empty without one."""
    try:
        with (folder / "package.xml").open(encoding="utf-8", errors="replace") as file:
            found = re.search(r"<name>\s*([\w-]+)\s*</name>", file.read(_MANIFEST))
    except OSError:
        return ""
    return found[1] if found else ""


def _search_path(variable: str) -> list[Path]:
    return [Path(root) for root in os.environ.get(variable, "").split(os.pathsep) if root]

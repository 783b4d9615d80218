"""Files of the package example-robot-data, found without importing it: as pip or as conda installed it."""

from __future__ import annotations

import csv
import os
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

_FOLDER = Path("share", "example-robot-data")


def located(end: str) -> Path | None:
    """The file of example-robot-data whose path ends so (from a `/` on), or None."""
    recorded = _files(lambda name: f"/{name}".endswith(f"/{end}"))
    places = (place / end for folder in _folders() for place in (folder / "robots", folder.parent))
    return next((path for path in (*recorded, *places) if path.is_file()), None)


def licences() -> list[Path]:
    """The texts under which example-robot-data may be passed on; none where it is not installed."""
    return _files(lambda name: name.rpartition("/")[2].startswith("LICENSE"))


def _files(wanted: Callable[[str], bool]) -> list[Path]:
    """The wanted files of the package, by the list that its installer wrote."""
    try:
        package = distribution("example-robot-data")
    except PackageNotFoundError:
        return []
    record = package.read_text("RECORD")
    names = (row[0] for row in csv.reader(record.splitlines())) if record else map(str, package.files or [])
    return [Path(str(package.locate_file(name))) for name in names if wanted(name)]


def _folders() -> Iterator[Path]:
    """Where the package may lie without such a list: in conda's environment, beside pip's, on ROS's path."""
    prefixes = [sys.prefix, os.environ.get("CONDA_PREFIX", "")]
    prefixes += [f"{entry}/cmeel.prefix" for entry in sys.path if entry]
    prefixes += os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    yield from (Path(prefix) / _FOLDER for prefix in prefixes if prefix)

"""Files of the package example-robot-data, found without importing it."""

from __future__ import annotations

import csv
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path


def located(end: str) -> Path | None:
    """The file of example-robot-data whose path ends so (from a `/` on), or None."""
    return next(iter(_files(lambda name: f"/{name}".endswith(f"/{end}"))), None)


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

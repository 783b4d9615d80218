"""Files of the package example-robot-data, found without importing it."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path


@cache
def located(end: str) -> Path | None:
    """The file of example-robot-data whose path ends so (from a `/` on), or None."""
    return next((path for path in _files() if path.as_posix().endswith(f"/{end}")), None)


def licences() -> list[Path]:
    """The texts under which example-robot-data may be passed on; none where it is not installed."""
    return [path for path in _files() if path.name.startswith("LICENSE")]


@cache
def _files() -> tuple[Path, ...]:
    """All of them: the list is read once, which takes 50 ms."""
    try:
        files = distribution("example-robot-data").files or []
    except PackageNotFoundError:
        return ()
    return tuple(Path(str(file.locate())) for file in files)

"""Files of example-robot-data, wherever it is installed."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path


@cache
def located(end: str) -> Path | None:
    """The file of example-robot-data whose path ends so (from a `/` on); None where there is none."""
    try:
        files = distribution("example-robot-data").files or []
    except PackageNotFoundError:
        return None
    return next((Path(str(file.locate())) for file in files if str(file).endswith(f"/{end}")), None)

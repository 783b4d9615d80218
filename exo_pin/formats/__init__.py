"""Gait files: one entry in FORMATS per format."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from exo_pin.errors import FormatError
from exo_pin.formats import gait_csv, opensim
from exo_pin.formats.poses import Poses, load_poses, save_poses
from exo_pin.formats.presets import PRESETS
from exo_pin.gait import Gait

__all__ = ["FORMATS", "PRESETS", "Format", "Poses", "load_gait", "load_poses", "save_gait", "save_poses"]


class Format(NamedTuple):
    """A way to keep a gait in a file.

    Attributes:
        name: What people call it.
        suffixes: File name endings, in lower case.
        read: Path and the name of a preset of signs (or None) to gait.
        write: Gait and path.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[Path, str | None], Gait]
    write: Callable[[Gait, Path], None]


_ALL = (
    Format("exo_pin CSV", (".csv",), gait_csv.read_gait, gait_csv.write_gait),
    Format("OpenSim coordinates", (".mot", ".sto"), opensim.read_gait, opensim.write_gait),
)

FORMATS = MappingProxyType({suffix: entry for entry in _ALL for suffix in entry.suffixes})
"""File name ending -> format."""


def load_gait(path: str | Path, *, preset: str | None = None) -> Gait:
    """Read a walk from a file; its ending tells the format.

    Args:
        path: A file in one of `FORMATS`, at most 128 MiB.
        preset: The sign convention of an OpenSim file, one of `PRESETS`; None: find out or refuse.

    Raises:
        FormatError: The file cannot be read; with file, line, reason and what would be accepted.
        UnknownNameError: There is no such preset.
    """
    path = Path(path)
    return _format(path).read(path, preset)


def save_gait(gait: Gait, path: str | Path) -> None:
    """Write a walk to a file; its ending tells the format. All or nothing: never a half-written file.

    Raises:
        FormatError: The ending is unknown or the file cannot be written.
    """
    path = Path(path)
    _format(path).write(gait, path)


def _format(path: Path) -> Format:
    if path.suffix.lower() not in FORMATS:
        raise FormatError(
            path, f"unknown kind of file {path.suffix!r}; a gait file ends in {', '.join(FORMATS)}"
        )
    return FORMATS[path.suffix.lower()]

"""Names of the files of one Motion-BIDS recording: entities, suffix, and the files beside it."""

from __future__ import annotations

import re
from pathlib import Path

from exo_pin.errors import FormatError

_ENDING = "_motion.tsv"

_NAME = re.compile(
    r"sub-(?P<sub>[A-Za-z0-9]+)(_ses-[A-Za-z0-9]+)?_task-(?P<task>[A-Za-z0-9]+)_tracksys-(?P<tracksys>[A-Za-z0-9]+)"
    r"(_acq-[A-Za-z0-9]+)?(_run-[0-9]+)?_motion\.tsv"
)
"""BIDS specification, "Motion recording data": order and letters of the entities."""

EXPORTER = "ExoPin"
"""Key of the .json under which stands what BIDS has no field for."""


def is_motion_bids(path: Path) -> bool:
    """Whether a file's name has the ending of a motion recording."""
    return path.name.lower().endswith(_ENDING)


def entities(path: Path) -> dict[str, str]:
    """Subject, task and tracking system by the file's name.

    Raises:
        FormatError: BIDS does not allow the name; with one that it does.
    """
    match = _NAME.fullmatch(path.name)
    if match is None:
        why = "BIDS wants a name like sub-01_task-walk_tracksys-imu_motion.tsv"
        raise FormatError(path, f"cannot be written: {why} (letters and digits after each hyphen)")
    return {name: match[name] for name in ("sub", "task", "tracksys")}


def beside(path: Path, ending: str) -> Path:
    """The file of the same recording with another ending, e.g. `_channels.tsv`."""
    return path.with_name(path.name[: -len(_ENDING)] + ending)

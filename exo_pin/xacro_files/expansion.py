"""The URDF text of a xacro file, expanded in a child process within limits of time, memory and reach."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from exo_pin.errors import DescriptionError

_CHILD = Path(__file__).with_name("restricted.py")

_SECONDS = 5
"""Of the child process's own time; a humanoid takes one or two."""

_PATIENCE = 30.0
"""Seconds by the clock, on a busy machine."""

_MEGABYTES = 1024
"""Memory of the child process."""

_LONGEST_REASON = 200


def expanded(path: Path) -> str:
    """The URDF text that a xacro file of one's own stands for; each argument of it has its default.

    `$(find package)` is looked up beside the file, above it, and on `ROS_PACKAGE_PATH` and
    `AMENT_PREFIX_PATH`. Expressions in xacro files are Python, so they run in a process of their own, which
    reads only the packages that the file names, writes nothing and starts nothing.

    Raises:
        DescriptionError: xacro refuses it, a package is not found, or it takes too long; the message has the
            reason.
    """
    try:
        is_file = path.is_file()
    except (OSError, ValueError):  # a name that is too long, or holds a zero byte
        is_file = False
    if not is_file:
        raise DescriptionError(f"{path}: no such file")
    words = [sys.executable, "-P", str(_CHILD), str(path), str(_MEGABYTES), str(_SECONDS)]
    environment = os.environ | {"PYTHONUTF8": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        ended = subprocess.run(words, capture_output=True, timeout=_PATIENCE, env=environment, check=False)
    except subprocess.TimeoutExpired:
        raise DescriptionError(f"{path}: {_TOO_MUCH}") from None
    try:
        text, why = json.loads(ended.stdout)
    except ValueError:  # it was ended before it could answer
        raise DescriptionError(f"{path}: {_TOO_MUCH}") from None
    if why:
        plain = " ".join("".join(mark if mark.isprintable() else " " for mark in why).split())
        raise DescriptionError(f"{path}: {plain[:_LONGEST_REASON]}")
    return str(text)


_TOO_MUCH = f"xacro cannot expand it within {_SECONDS} s and {_MEGABYTES} MiB; endless macros?"

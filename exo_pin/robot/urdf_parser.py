"""Pinocchio's URDF parser, its error output in one exception instead of lines on the console."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from typing import Any

import pinocchio as pin

from exo_pin.errors import DescriptionError


def built(text: str, *root: Any) -> Any:
    """Pinocchio's model of a URDF's text; `root` is the joint of a floating base, if any.

    Raises:
        DescriptionError: Pinocchio does not accept it; the message holds the parser's first error.
    """
    lines: list[str] = []
    try:
        with _captured(lines):
            return pin.buildModelFromXML(text, *root)
    except (ValueError, RuntimeError) as error:
        first = re.search(r"Error:\s*(.+)", "".join(lines))
        why = " ".join((str(error) if first is None else first[1]).split())[:200]
        raise DescriptionError(f"Pinocchio does not accept this URDF: {why}") from None


@contextlib.contextmanager
def _captured(lines: list[str]) -> Iterator[None]:
    """Collect what C++ code writes to the standard error file, instead of printing it."""
    sys.stderr.flush()
    try:
        kept = os.dup(2)
    except OSError:  # the process has no standard error
        yield
        return
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            file.seek(0)
            lines.append(file.read().decode(errors="replace"))

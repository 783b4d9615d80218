"""Files that a command writes: never one that it reads; a note where an earlier file was replaced."""

from __future__ import annotations

import argparse
import os
import stat
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from exo_pin.errors import FormatError

_ARGUMENTS = ("output", "html", "page", "csv")
"""Names of the arguments that hold a file to write."""


@contextmanager
def watched(args: argparse.Namespace, more: Sequence[str] = ()) -> Iterator[None]:
    """Refuse to write over an input before the command runs, and say afterwards which files it replaced.

    Args:
        args: Of the command.
        more: Further files that it writes.

    Raises:
        FormatError: A file to write is one that the command reads, also by a link or under another name.
    """
    outputs = [str(name) for name in map(vars(args).get, _ARGUMENTS) if name] + list(more)
    before = {name: state for name in outputs if (state := _plain_file(name))}
    for given in _texts([value for name, value in vars(args).items() if name not in _NOT_READ]):
        state = _plain_file(given)
        for name, there in before.items():
            if state and os.path.samestat(state, there):
                why = f"is read by this command ({given}), so it is not written to; name another file"
                raise FormatError(name, why)
    _check(args, outputs)
    yield
    for name, there in before.items():
        now = _plain_file(name)
        if now and (now.st_ino, now.st_mtime_ns) != (there.st_ino, there.st_mtime_ns):
            print(f"note: {name}: an earlier file of this name was replaced", file=sys.stderr)


def _check(args: argparse.Namespace, outputs: Sequence[str]) -> None:
    """Refuse a page that is no .html, and a folder that is not there, before the work."""
    page = getattr(args, "html", None)
    if page and Path(page).suffix.lower() not in _PAGES:
        raise FormatError(page, "a page ends in .html; its browser prints it as PDF")
    for name in outputs:
        folder = Path(name).parent
        if Path(name).suffix and not folder.is_dir():  # folders that a command fills are made by it
            raise FormatError(name, f"cannot be written: the folder {folder} does not exist")


_PAGES = (".html", ".htm")

_NOT_READ = {*_ARGUMENTS, "words", "command"}


def _texts(value: object) -> Iterator[str]:
    """All texts in the arguments, and both parts of those like GAIT=SHARE."""
    if isinstance(value, str):
        name, sign, rest = value.partition("=")
        yield from (value, name, rest) if sign else (value,)
    elif isinstance(value, (list, tuple)):
        for part in value:
            yield from _texts(part)


def _plain_file(name: str) -> os.stat_result | None:
    """The state of a plain file, links followed; None for anything else."""
    try:
        state = os.stat(name)
    except (OSError, ValueError):
        return None
    return state if stat.S_ISREG(state.st_mode) else None

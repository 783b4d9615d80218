"""The cache's folder, and the files in it that only this user can have written."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from exo_pin.files import LARGEST_FILE

VARIABLE = "EXO_PIN_CACHE"
"""Environment variable that names the folder."""

_OPEN = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
"""Neither follow a link nor wait for the writer of a pipe; Windows has neither flag."""

_WRITABLE_BY_OTHERS = 0o022


def folder() -> Path | None:
    """Where results are kept, or None: nowhere."""
    chosen = os.environ.get(VARIABLE)
    if chosen is not None:
        return Path(chosen) if chosen else None
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "exo_pin"
    except RuntimeError:  # nobody's home is known
        return None


@contextlib.contextmanager
def switched_off() -> Iterator[None]:
    """Nothing is kept or recalled meanwhile, by processes that are started meanwhile neither."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = ""
    try:
        yield
    finally:
        del os.environ[VARIABLE]
        if before is not None:
            os.environ[VARIABLE] = before


def refusal(home: Path) -> str:
    """Why a folder is not used as the cache: a link, another user's ...; empty if it may be used or made."""
    try:
        found = os.lstat(home)
    except (FileNotFoundError, NotADirectoryError):
        return ""
    except (OSError, ValueError) as error:
        return getattr(error, "strerror", None) or str(error)
    return doubt(found, folder=True)


def doubt(found: os.stat_result, *, folder: bool = False) -> str:
    """Why a file or folder may hold what another user has planted; empty if it cannot.

    Args:
        found: Its state (`os.lstat`, `os.fstat`).
        folder: Whether a folder is expected, else a plain file.
    """
    if stat.S_ISLNK(found.st_mode):
        return "a link"
    if not (stat.S_ISDIR if folder else stat.S_ISREG)(found.st_mode):
        return "not a folder" if folder else "not a plain file"
    if hasattr(os, "geteuid"):  # Windows keeps each user's folder from others by itself
        if found.st_uid != os.geteuid():
            return f"it belongs to another user (uid {found.st_uid})"
        if found.st_mode & _WRITABLE_BY_OTHERS:
            return f"others may write to it (mode {stat.S_IMODE(found.st_mode):o})"
    return ""


def read(path: Path) -> bytes | None:
    """The content of a plain file that only this user may write; None where there is no such file."""
    try:
        if doubt(os.lstat(path)):
            return None
        handle = os.open(path, _OPEN)
    except (OSError, ValueError):
        return None
    try:
        if doubt(os.fstat(handle)):  # it was exchanged meanwhile
            os.close(handle)
            return None
        with os.fdopen(handle, "rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError:
        return None
    return data if len(data) <= LARGEST_FILE else None

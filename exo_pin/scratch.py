"""Private scratch folders: for their owner alone, removed at every end; those of killed runs are swept.

A folder is locked as long as its process lives. The system drops the lock however the process ends, so an
unlocked folder has no owner any more: the next run removes it.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

_PREFIX = "exo_pin-private-"

_ATTEMPTS, _PAUSE = 50, 0.05
"""So often a folder is removed whose last writer is still ending, and the time between [s]."""


@contextlib.contextmanager
def folder(parent: Path | None = None) -> Iterator[Path]:
    """A new empty folder that only this user can enter; it is removed at the end, also by an exception.

    Args:
        parent: Where it is made; the system's folder for temporary files if left out.

    Raises:
        OSError: No folder can be made there.
    """
    parent = Path(tempfile.gettempdir()) if parent is None else parent
    sweep(parent)
    path, lock = parent / f"{_PREFIX}{os.urandom(6).hex()}", -1
    try:
        while lock < 0:  # once; again where another run swept the folder before it was locked
            path.mkdir(0o700)
            lock = _locked(path, wait=True)
        yield path
    finally:
        _remove(path)
        if lock >= 0:
            os.close(lock)


def sweep(parent: Path | None = None) -> None:
    """Remove the folders of this user's runs that were killed.

    Args:
        parent: Where to look; the system's folder for temporary files if left out.
    """
    parent = Path(tempfile.gettempdir()) if parent is None else parent
    with contextlib.suppress(OSError):
        for path in [path for path in parent.iterdir() if path.name.startswith(_PREFIX)]:
            lock = _locked(path, wait=False)
            if lock >= 0:
                shutil.rmtree(path, ignore_errors=True)
                os.close(lock)


def _locked(path: Path, *, wait: bool) -> int:
    """A descriptor that locks this user's own folder, or -1: not there, another's, a link, or in use.

    Args:
        path: The folder.
        wait: Whether it is a new folder of this run: wait for the lock; no error where the system has none.
    """
    if sys.platform == "win32":  # it has no such locks: nothing is swept there
        return os.open(os.devnull, os.O_RDONLY) if wait else -1
    import fcntl

    try:
        handle = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:
        return -1
    mine = os.fstat(handle).st_uid == os.geteuid()
    try:
        if mine:
            fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:  # in use, or a file system without locks, where nothing is ever swept
        mine = wait
    if mine and _is_still(path, handle):
        return handle
    os.close(handle)
    return -1


def _is_still(path: Path, handle: int) -> bool:
    """Whether the open folder is still at its path."""
    with contextlib.suppress(FileNotFoundError):
        found = os.lstat(path)
        return stat.S_ISDIR(found.st_mode) and os.path.samestat(found, os.fstat(handle))
    return False


def _remove(path: Path) -> None:
    for _ in range(_ATTEMPTS):  # a program that ends may still write for a moment
        shutil.rmtree(path, ignore_errors=True)
        if not path.exists():
            return
        time.sleep(_PAUSE)

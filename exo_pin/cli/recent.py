"""What `replay` made of the same arguments last time: shown at once, until this run's own is there."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from exo_pin import cache

_KIND = "scene"
_CODE = {".py", ".xacro", ".js", ".css", ".html"}
"""Files of the package that an older picture may not fit."""
_ELSEWHERE = {"port", "host", "no_open", "html", "command"}
"""Arguments that do not change the picture."""


def recall(args: argparse.Namespace) -> bytes | None:
    """The packed scene of the last run with these arguments, files and code, or None."""
    return cache.recall(_KIND, _name(args))


def keep(args: argparse.Namespace, packed: bytes) -> None:
    """Keep a packed scene for the next run."""
    cache.keep(_KIND, _name(args), packed)


def _name(args: argparse.Namespace) -> str:
    given = {name: value for name, value in sorted(vars(args).items()) if name not in _ELSEWHERE}
    files = (word for value in given.values() for word in (value if isinstance(value, list) else [value]))
    code = (path for path in sorted(Path(cache.__file__).parent.rglob("*")) if path.suffix in _CODE)
    return cache.key((repr(given), *_states(map(str, files)), *_states(map(str, code))))


def _states(paths: Iterable[str]) -> Iterator[str]:
    """Size and time of each path that is there: another state gives another name."""
    for path in paths:
        try:
            state = os.stat(path)
        except (OSError, ValueError):
            continue
        yield f"{path} {state.st_size} {state.st_mtime_ns}"

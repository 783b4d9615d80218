"""Cache of results between runs, in the user's cache folder: checked when read, silent on failure.

The folder is `$XDG_CACHE_HOME/exo_pin` (`~/.cache/exo_pin`), or what `EXO_PIN_CACHE` names; if that is empty,
nothing is kept. It may be deleted at any time.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Iterable
from pathlib import Path

from exo_pin.errors import FormatError
from exo_pin.files import write_bytes

VARIABLE = "EXO_PIN_CACHE"
"""Environment variable that names the folder."""

MOST_RESULTS = 40
"""At most so many results of a kind are kept; the oldest go first."""

_DIGEST = hashlib.sha256().digest_size


def folder() -> Path | None:
    """Where results are kept, or None: nowhere."""
    chosen = os.environ.get(VARIABLE)
    if chosen is not None:
        return Path(chosen) if chosen else None
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "exo_pin"
    except RuntimeError:  # nobody's home is known
        return None


def key(parts: Iterable[str | bytes]) -> str:
    """A name for what follows from these parts; any change in any of them gives another name."""
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode(errors="surrogateescape") if isinstance(part, str) else part
        digest.update(len(data).to_bytes(8, "big") + data)
    return digest.hexdigest()[:40]


def recall(kind: str, name: str) -> bytes | None:
    """What was kept under a name, or None: nothing, damaged, or another user's."""
    home = folder()
    if home is None:
        return None
    try:
        with (home / f"{kind}-{name}").open("rb") as file:
            if hasattr(os, "getuid") and os.fstat(file.fileno()).st_uid != os.getuid():
                return None
            content = file.read()
    except OSError:
        return None
    digest, data = content[:_DIGEST], content[_DIGEST:]
    return data if hashlib.sha256(data).digest() == digest else None


def keep(kind: str, name: str, data: bytes) -> None:
    """Keep a result for later runs: whole or not at all, also when other processes write.

    Args:
        kind: Of result; each kind has its own number of results.
        name: Of `key`.
        data: The result.
    """
    home = folder()
    if home is None:
        return
    with contextlib.suppress(OSError, FormatError):
        home.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_bytes(home / f"{kind}-{name}", hashlib.sha256(data).digest() + data)
        _forget(home, kind)


def _forget(home: Path, kind: str) -> None:
    files = sorted(home.glob(f"{kind}-*"), key=lambda file: file.stat().st_mtime, reverse=True)
    for file in files[MOST_RESULTS:]:
        file.unlink(missing_ok=True)

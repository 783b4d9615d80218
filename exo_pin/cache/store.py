"""Results by kind and name, each sealed with a key that only this user can read.

The seal (HMAC-SHA-256, RFC 2104) covers kind, name and content: a file that was planted, changed or renamed
is not recalled. Failures are silent, since every result can be computed again.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import os
import re
import secrets
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from exo_pin.cache import place
from exo_pin.errors import FormatError
from exo_pin.files import write_private

MOST_RESULTS = 40
"""At most so many results of a kind are kept; the oldest go first."""

_KEY_FILE = "key"
_SIZE = hashlib.sha256().digest_size
"""Of the key and of a seal [bytes]."""

_NAME_DIGITS = 40
_RESULT = re.compile(rf"(?P<kind>[a-z]+)-[0-9a-f]{{{_NAME_DIGITS}}}")
_DRAFT = re.compile(r"\..+\.part")
_STALE_DRAFT = 3600.0
"""No write takes so long [s]: an older draft is a killed run's."""


@dataclass(frozen=True)
class Kept:
    """How much of a kind is kept.

    Attributes:
        kind: Of the results.
        number: Of results.
        size: Of their files together [bytes].
    """

    kind: str
    number: int
    size: int


def key(parts: Iterable[str | bytes]) -> str:
    """A name for what follows from these parts; any change in any of them gives another name."""
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode(errors="surrogateescape") if isinstance(part, str) else part
        digest.update(len(data).to_bytes(8, "big") + data)
    return digest.hexdigest()[:_NAME_DIGITS]


def recall(kind: str, name: str) -> bytes | None:
    """What was kept under a name, or None: nothing, damaged, or not certainly this user's.

    Args:
        kind: Of result.
        name: Of `key`.
    """
    home = place.folder()
    if home is None or place.refusal(home):
        return None
    file, secret = home / f"{kind}-{name}", place.read(home / _KEY_FILE)
    content = place.read(file)
    if content is None or secret is None or len(secret) != _SIZE:
        return None
    seal, data = content[:_SIZE], content[_SIZE:]
    return data if hmac.compare_digest(seal, _seal(secret, file.name, data)) else None


def keep(kind: str, name: str, data: bytes) -> None:
    """Keep a result for later runs: whole or not at all, also when other processes write.

    Args:
        kind: Of result; each kind has its own number of results.
        name: Of `key`.
        data: The result.
    """
    home = place.folder()
    if home is None:
        return
    with contextlib.suppress(OSError, FormatError):
        home.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not place.refusal(home):
            file = home / f"{kind}-{name}"
            write_private(file, _seal(_secret(home), file.name, data) + data)
            _forget(home, kind)


def contents() -> list[Kept]:
    """What is kept, by kind."""
    found: dict[str, list[int]] = {}
    for file, state in _entries():
        kind = _RESULT.fullmatch(file.name)
        if kind and not place.doubt(state):
            found.setdefault(kind["kind"], []).append(state.st_size)
    return [Kept(kind, len(sizes), sum(sizes)) for kind, sizes in sorted(found.items())]


def refused_entry() -> tuple[Path, str] | None:
    """The first file of the folder that is not used, and why; None if all are used."""
    for file, state in _entries():
        why = place.doubt(state)
        if why:
            return file, why
    return None


def clear() -> int:
    """Delete all results, drafts and the key, and the folder if nothing else is in it.

    Returns:
        How many results were deleted.

    Raises:
        FormatError: The folder is another user's or a link, or a file cannot be deleted.
    """
    home, number = place.folder(), 0
    why = place.refusal(home) if home else ""
    if home and why and not why.startswith("others may write"):
        raise FormatError(home, f"not emptied: {why}")
    try:
        for file, _ in _entries():
            number += bool(_RESULT.fullmatch(file.name))
            file.unlink(missing_ok=True)
    except OSError as error:
        raise FormatError(file, f"cannot be deleted: {error.strerror}") from error
    if home:
        with contextlib.suppress(OSError):  # another file of the user's is in it
            home.rmdir()
    return number


def _entries() -> list[tuple[Path, os.stat_result]]:
    """The cache's files in its folder, with their state; others that may be there are not touched."""
    home, found = place.folder(), []
    with contextlib.suppress(OSError):
        for file in sorted(home.iterdir() if home else ()):
            if file.name == _KEY_FILE or _RESULT.fullmatch(file.name) or _DRAFT.fullmatch(file.name):
                with contextlib.suppress(OSError):  # another run has deleted it meanwhile
                    found.append((file, os.lstat(file)))
    return found


def _seal(secret: bytes, name: str, data: bytes) -> bytes:
    return hmac.digest(secret, name.encode() + b"\0" + data, "sha256")


def _secret(home: Path) -> bytes:
    """The folder's key; a new one where there is none that may be used.

    Raises:
        OSError: It cannot be made.
    """
    file = home / _KEY_FILE
    known = place.read(file)
    if known is not None and len(known) == _SIZE:
        return known
    if known is not None or os.path.lexists(file):
        file.unlink(missing_ok=True)
    draft = home / f".{_KEY_FILE}.{secrets.token_hex(4)}.part"
    write_private(draft, secrets.token_bytes(_SIZE))
    try:
        os.link(draft, file)  # of processes that begin at the same time the first one's key holds
    except FileExistsError:
        pass
    except OSError:  # a file system without hard links
        draft.replace(file)
    finally:
        draft.unlink(missing_ok=True)
    made = place.read(file)
    if made is None or len(made) != _SIZE:
        raise OSError("no key")
    return made


def _forget(home: Path, kind: str) -> None:
    """Delete the oldest results of a kind, and drafts that killed runs have left."""
    files = sorted(home.glob(f"{kind}-*"), key=lambda file: os.lstat(file).st_mtime, reverse=True)
    stale = [file for file in home.glob(".*.part") if os.lstat(file).st_mtime < time.time() - _STALE_DRAFT]
    for file in (*files[MOST_RESULTS:], *stale):
        file.unlink(missing_ok=True)

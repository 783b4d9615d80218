"""TOML files for people: one commented line per value, written whole or not at all."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from exo_pin.errors import FormatError

_LARGEST = 1_000_000  # bytes; a body file has about 4 kB


def write(
    path: str | Path,
    title: str,
    values: Mapping[str, object],
    *,
    comments: Mapping[str, str],
    tables: Mapping[str, Mapping[str, object]],
) -> None:
    """Write values, then tables; `comments` stand behind the values that they name.

    Raises:
        FormatError: The file cannot be written.
    """
    import tomlkit  # only this function needs it

    document = tomlkit.document()
    document.add(tomlkit.comment(title))
    for name, value in values.items():
        item = tomlkit.item(value)
        if name in comments:
            item.comment(comments[name])
        document.add(name, item)
    for name, table in tables.items():
        document.add(name, tomlkit.item(dict(table)))
    target = Path(path)
    draft = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        draft.write_text(tomlkit.dumps(document), encoding="utf-8")
        draft.replace(target)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise FormatError(path, f"cannot be written: {error.strerror or error}") from None


def read(path: str | Path) -> dict[str, Any]:
    """The file's values.

    Raises:
        FormatError: The file cannot be read or is no TOML.
    """
    try:
        if Path(path).stat().st_size > _LARGEST:
            raise FormatError(path, "is too large for a settings file; at most 1 MB is accepted")
        return tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise FormatError(path, f"cannot be read: {error.strerror or error}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise FormatError(path, f"is not TOML: {error}") from None

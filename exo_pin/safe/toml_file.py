"""TOML files with a comment behind each value, written whole or not at all."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from exo_pin.errors import FormatError
from exo_pin.files import read_lines, write_text


def write(
    path: str | Path,
    title: str,
    values: Mapping[str, object],
    *,
    comments: Mapping[str, str],
    tables: Mapping[str, Mapping[str, object]],
) -> None:
    """Write values, then tables.

    Args:
        path: The file.
        title: Comment lines above.
        values: Name -> value.
        comments: Name -> comment behind that value.
        tables: Name -> values of a table.

    Raises:
        FormatError: The file cannot be written.
    """
    import tomlkit  # only this function needs it

    document = tomlkit.document()
    for line in title.splitlines():
        document.add(tomlkit.comment(line))
    for name, value in values.items():
        item = tomlkit.item(value)
        if name in comments:
            item.comment(comments[name])
        document.add(name, item)
    for name, table in tables.items():
        document.add(name, tomlkit.item(dict(table)))
    write_text(path, tomlkit.dumps(document))


def read(path: str | Path) -> dict[str, Any]:
    """The file's values.

    Raises:
        FormatError: The file cannot be read or is no TOML.
    """
    try:
        return tomllib.loads("\n".join(read_lines(path)))
    except tomllib.TOMLDecodeError as error:
        raise FormatError(path, f"is not TOML: {error}") from None

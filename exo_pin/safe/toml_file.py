"""TOML files with a comment behind each value, written whole or not at all."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from exo_pin.errors import FormatError, shortened
from exo_pin.files import control_character, read_text, write_text

_LARGEST = 2**20
"""Characters; a body has some 3000."""

_LARGEST_NUMBER = 1e12
"""Of any unit."""

_DEEPEST = 12
"""Tables and lists within each other; a device has three."""


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
    text = read_text(path)
    if len(text) > _LARGEST:
        raise FormatError(path, f"larger than {_LARGEST} characters; no such file is")
    try:
        values = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        why = " ".join(str(error).split())[:200]
        raise FormatError(path, f"is not TOML: {why}") from None
    except (ValueError, RecursionError):  # a number of thousands of digits, an impossible date, deep brackets
        raise FormatError(path, "is not TOML: brackets too deep, or an invalid number or date") from None
    _judge(path, "", values, 0)
    return values


def _judge(path: str | Path, place: str, value: object, depth: int) -> None:
    """Refuse what no reader of a file expects: huge numbers, control characters, deep tables.

    Args:
        path: The file.
        place: Names of the tables and the entry, e.g. `actuators.knee`.
        value: What stands there.
        depth: Tables and lists around it.
    """
    where = shortened(place, 60)
    if depth > _DEEPEST:
        raise FormatError(path, f"{where}: more than {_DEEPEST} tables and lists within each other")
    for name, inner in _inside(value):
        found = control_character(name)
        if found:
            raise FormatError(path, f"a name in {where or 'the file'} holds the control character {found}")
        _judge(path, ".".join(filter(None, (place, name))), inner, depth + 1)
    if isinstance(value, str) and (found := control_character(value)):
        raise FormatError(path, f"{where} holds the control character {found}; remove it")
    if isinstance(value, int | float) and not abs(value) <= _LARGEST_NUMBER:
        raise FormatError(path, f"{where} is no finite number of at most {_LARGEST_NUMBER:g}")


def _inside(value: object) -> Iterable[tuple[str, object]]:
    """What a table or list holds, with the names in it."""
    if isinstance(value, dict):
        return value.items()
    return (("", inner) for inner in value) if isinstance(value, list) else ()

"""Short texts of records for an interactive session: arrays by their shape, long values by their size."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sized
from typing import Any

LONGEST = 500
"""Characters of a record's text at most."""

_LONGEST_VALUE = 48


def short_repr(record: Any) -> str:
    """`Name(field=value, ...)` of a dataclass or named tuple in at most `LONGEST` characters.

    Give it to a record that holds arrays or other records as its `__repr__`: the generated one prints them
    all, up to megabytes.
    """
    fields = dataclasses.fields(record) if _is_record(record) else ()
    names = [field.name for field in fields if field.repr] or record._fields
    parts = ", ".join(f"{name}={_short(getattr(record, name))}" for name in names)
    text = f"{type(record).__name__}({parts})"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 5]} ...)"


def _short(value: object) -> str:
    shape = getattr(value, "shape", None)
    if isinstance(shape, tuple) and shape:
        return f"array{shape}".replace(",)", ")")
    if _is_record(value):
        return f"<{type(value).__name__}>"
    if isinstance(value, Mapping | list | tuple | set | frozenset):
        return _several(value)
    text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    if len(text) > _LONGEST_VALUE or "\n" in text or " object at 0x" in text:
        size = f"{len(value)} characters" if isinstance(value, str) else type(value).__name__
        return f"<{size}>"
    return text


def _is_record(value: object) -> bool:
    return dataclasses.is_dataclass(value) and not isinstance(value, type)


def _several(values: Sized) -> str:
    """Members one by one if they are few and short, else how many there are."""
    if isinstance(values, Mapping):
        text = f"{{{', '.join(f'{key!r}: {_short(value)}' for key, value in values.items())}}}"
    elif isinstance(values, tuple | list):
        text = f"({', '.join(map(_short, values))})"
    else:
        text = repr(values)
    return text if len(text) <= _LONGEST_VALUE else f"<{len(values)} in a {type(values).__name__}>"

"""Fingerprints of a study's inputs: equal if and only if everything that a row depends on is equal."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.description import sources

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_DIGITS = 16
"""Hexadecimal digits of a fingerprint: a million rows have a collision with probability 3e-8."""

_NOT_COMPUTING = ("cli", "report", "viewer")
"""Rooms that only show numbers: their code does not change a row."""


def code_digest() -> str:
    """Digest of the code that the numbers follow from: this package without the rooms that only show them."""
    package = Path(__file__).parents[1]
    shown = {package / room for room in _NOT_COMPUTING}
    files = sorted(file for file in package.rglob("*.py") if not shown & set(file.parents))
    files += sorted(sources().glob("*.xacro"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def fingerprint(*inputs: object) -> str:
    """Of values whose text is the same in every process; records as `plain` makes them."""
    return hashlib.sha256(repr(inputs).encode()).hexdigest()[:_DIGITS]


def plain(record: DataclassInstance) -> dict[str, Any]:
    """A record's fields as values whose text is the same in every process."""
    values = {field.name: getattr(record, field.name) for field in dataclasses.fields(record)}
    return {name: dict(value) if isinstance(value, Mapping) else value for name, value in values.items()}

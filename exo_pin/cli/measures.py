"""Lengths and masses as people type them: a decimal comma, a unit behind the number, or neither."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from exo_pin.safe import plain_numbers

_UNITS: Mapping[str, Mapping[str, float]] = {
    "m": {"": 1.0, "m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "kg": {"": 1.0, "kg": 1.0, "g": 1e-3},
}
_NUMBER = re.compile(r"\s*([+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z]*)\s*", re.ASCII)


def metres(text: str) -> float:
    """A length: `1.58`, `1,58`, `1.58m`, `158cm` and `1580 mm` are the same [m].

    Raises:
        ArgumentTypeError: It is no length.
    """
    return _measure(text, "m")


def kilograms(text: str) -> float:
    """A mass: `70`, `70,0` and `70kg` are the same [kg].

    Raises:
        ArgumentTypeError: It is no mass.
    """
    return _measure(text, "kg")


def number(text: str) -> float:
    """A number with a decimal point or a comma.

    Raises:
        ValueError: It is no number.
    """
    return plain_numbers.number(text.replace(",", ".") if text.count(",") == 1 and "." not in text else text)


def listed(words: Iterable[str]) -> list[str]:
    """`a b,c` and `a, b, c` as the names a, b and c; a name with a comma that is a file stays whole."""
    found: list[str] = []
    for word in words:
        found += [word] if Path(word).exists() else [part.strip() for part in word.split(",") if part.strip()]
    return found


def _measure(text: str, unit: str) -> float:
    found = _NUMBER.fullmatch(text)
    scale = found and _UNITS[unit].get(found[2].lower())
    if not found or scale is None:
        example = "1.75, 1,75, 1.75m or 175cm" if unit == "m" else "70, 70,5 or 70kg"
        raise argparse.ArgumentTypeError(f"{text!r} is not in {unit}; write it like {example}")
    value = number(found[1])
    return value if scale == 1.0 else round(scale * value, 9)

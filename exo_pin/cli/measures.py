"""Lengths and masses as people type them: a decimal comma, a unit behind the number, or neither."""

from __future__ import annotations

import argparse
import math
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


def seconds(text: str) -> float:
    """A time: `20`, `20s` and `20 s` are the same [s].

    Raises:
        ArgumentTypeError: It is no positive time.
    """
    found = _NUMBER.fullmatch(text)
    if not found or found[2].lower() not in ("", "s") or not 0 < (value := number(found[1])) < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no time in seconds; write it like 20 or 20s")
    return value


def share(text: str) -> float:
    """A part of a whole: `0.3` and `30%` are the same.

    Raises:
        ArgumentTypeError: It is not within 0 and 1.
    """
    plain = text.strip()
    try:
        value = number(plain.removesuffix("%")) / (100 if plain.endswith("%") else 1)
    except ValueError:
        value = math.nan
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError(f"{text!r} is no part of a whole; write it like 0.3 or 30%")
    return value


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

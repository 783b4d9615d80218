"""Numbers as every program reads them: digits of ASCII, no `1_000`, finite where that is expected."""

from __future__ import annotations

import math


def number(text: str) -> float:
    """The number of a text.

    Raises:
        ValueError: It holds none, or one that Python alone reads: `0.4_1`, digits of other scripts.
    """
    if "_" in text or not text.isascii():
        raise ValueError("no number")
    return float(text)


def number_or_nan(text: str) -> float:
    """The number of a text; NaN where it holds none."""
    try:
        return number(text)
    except ValueError:
        return math.nan


def finite(text: str, count: int | None = None) -> list[float]:
    """The finite numbers of a text, parted by blanks.

    Args:
        text: E.g. `"0 0 1"`.
        count: How many are expected; None: any.

    Raises:
        ValueError: One is no finite number, or there are not as many.
    """
    numbers = [number(word) for word in text.split()]
    if not all(map(math.isfinite, numbers)) or count not in (None, len(numbers)):
        raise ValueError("no such finite numbers")
    return numbers

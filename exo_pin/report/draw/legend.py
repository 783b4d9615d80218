"""The legend below a chart: marks and labels, broken into rows."""

from __future__ import annotations

from collections.abc import Mapping

from exo_pin.report.draw import svg

ROW_HEIGHT = 15.0
"""[px]"""

_LETTER = 5.6  # mean width of a letter at 10.5 px


def rows(marks: Mapping[str, str], left: float, top: float, right: float) -> tuple[list[str], int]:
    """The legend as markup, and how many rows it takes.

    Args:
        marks: Words -> a mark of 16 px around its own (0, 0), as markup.
        left: Where rows begin [px].
        top: Of the first row [px].
        right: Where they end at the latest [px].
    """
    parts, row, x = list[str](), 0, left
    for words, mark in marks.items():
        width = 22 + _LETTER * len(words) + 12
        if x > left and x + width > right:
            row, x = row + 1, left
        y = top + 10 + ROW_HEIGHT * row
        parts.append(svg.tag("g", mark, transform=f"translate({svg.number(x)} {svg.number(y - 3.5)})"))
        parts.append(svg.text(x + 21, y, words, font_size=10.5))
        x += width
    return parts, row + 1 if parts else 0

"""Tables whose cells are shaded by their numbers, and strips of dots, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from exo_pin.report.draw import svg
from exo_pin.report.draw.chart_axis import extent, label, ticks
from exo_pin.report.draw.drawing import Drawing

_LETTER = 6.1  # mean width of a letter at 11 px
_LONGEST = 44  # letters of a row's heading
_ROW, _HEAD, _TOP = 24.0, 20.0, 30.0
_HIGH, _LOW = np.array([205, 73, 40]), np.array([41, 117, 199])
"""Colours of the largest and, where values have a sign, of the smallest cell."""


def heat(
    name: str,
    title: str,
    columns: Sequence[str],
    rows: Mapping[str, Sequence[float]],
    *,
    width: float = 520.0,
    digits: int = 1,
    top: float | None = None,
) -> Drawing:
    """A table of numbers, darker where they are larger; negative ones are shaded in another colour.

    Args:
        name: Of the drawing's file.
        title: What the numbers are, with their unit.
        columns: Headings.
        rows: Heading of a row -> its numbers; NaN is shown as a dash.
        width: Of the picture [px].
        digits: Number of decimals.
        top: Value of the darkest cell; the largest in the table if left out.
    """
    left = _left(rows)
    wide = (width - left - 4) / len(columns)
    values = np.array(list(rows.values()), dtype=float)
    most = top or max(float(np.nanmax(np.abs(values), initial=0.0)), 1e-12)
    lines = _headings(columns, left, wide)
    high = _TOP + _HEAD * max(len(words) for words in map(_words, columns)) * 0.65 + 6
    for k, (row, numbers) in enumerate(rows.items()):
        y = high + _ROW * k
        lines.append(svg.text(left - 8, y + 16, _short(row), text_anchor="end"))
        for j, value in enumerate(numbers):
            lines += _cell(left + wide * j, y, wide, float(value), most, digits)
    head = svg.text(2, 15, title, font_size=12.5, font_weight=600)
    return Drawing(name, title, svg.drawing(width, high + _ROW * len(rows) + 4, [head, *lines], title))


def strips(name: str, title: str, rows: Mapping[str, Sequence[float]], *, width: float = 520.0) -> Drawing:
    """One row of dots for each name, and a stroke at the row's median.

    Args:
        name: Of the drawing's file.
        title: What the numbers are, with their unit.
        rows: Heading of a row -> its numbers.
        width: Of the picture [px].
    """
    left, right = _left(rows), 14.0
    low, high = extent([np.append(list(values), 0.0) for values in rows.values()], 1.0, pad=0.02)
    scale = (width - left - right) / (high - low)
    bottom = _TOP + _ROW * len(rows)
    marks = ticks(low, high, 7)
    parts = [svg.text(2, 15, title, font_size=12.5, font_weight=600)]
    for x in marks:
        at = left + scale * (x - low)
        parts.append(svg.line([[at, _TOP], [at, bottom]], svg.FAINT, stroke_width=0.8))
        words = label(x, marks)
        parts.append(svg.text(at, bottom + 14, words, text_anchor="middle", font_size=10, fill=svg.GREY))
    for k, (row, values) in enumerate(rows.items()):
        y = _TOP + _ROW * (k + 0.5)
        parts.append(svg.text(left - 8, y + 4, _short(row), text_anchor="end"))
        for value in values:
            x = left + scale * (value - low)
            parts.append(svg.tag("circle", cx=x, cy=y, r=3.4, fill="#2975c7", fill_opacity=0.45))
        middle = left + scale * (float(np.median(list(values))) - low)
        parts.append(svg.line([[middle, y - 8], [middle, y + 8]], svg.INK, stroke_width=2))
    return Drawing(name, title, svg.drawing(width, bottom + 20, parts, title))


def _left(rows: Iterable[str]) -> float:
    """Room for the rows' headings [px]."""
    return 12 + _LETTER * max(len(_short(row)) for row in rows)


def _short(row: str) -> str:
    return row if len(row) <= _LONGEST else f"… {row[2 - _LONGEST :]}"


def _headings(columns: Sequence[str], left: float, wide: float) -> list[str]:
    parts = []
    for j, column in enumerate(columns):
        for i, word in enumerate(_words(column)):
            x, y = left + wide * (j + 0.5), _TOP + 8 + 13 * i
            parts.append(svg.text(x, y, word, text_anchor="middle", font_size=10.5, fill=svg.GREY))
    return parts


def _words(column: str) -> list[str]:
    return column.split(" ")


def _cell(x: float, y: float, wide: float, value: float, most: float, digits: int) -> list[str]:
    if np.isnan(value):
        return [svg.text(x + wide / 2, y + 16, "-", text_anchor="middle", fill=svg.GREY)]
    share = min(abs(value) / most, 1.0) ** 0.7  # a root: small losses differ in shade too
    colour = 255 + share * 0.85 * ((_HIGH if value > 0 else _LOW) - 255)
    fill = "#" + "".join(f"{round(c):02x}" for c in colour)
    ink = "#fff" if colour @ [0.30, 0.59, 0.11] < 140 else svg.INK
    words = f"{round(value, digits) + 0.0:.{digits}f}"
    return [
        svg.tag("rect", x=x + 1, y=y + 1, width=wide - 2, height=_ROW - 2, rx=3, fill=fill),
        svg.text(x + wide / 2, y + 16, words, text_anchor="middle", fill=ink),
    ]

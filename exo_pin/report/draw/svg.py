"""SVG elements as text: escaped content, rounded numbers, the same bytes for the same input."""

from __future__ import annotations

import html
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

SIDE_COLOURS = {"left": "#d13d4a", "right": "#2975c7"}
"""One colour per side, as in the viewer."""

INK, GREY, FAINT = "#1d2733", "#5d6875", "#d9dee4"
_FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"


def number(value: float) -> str:
    """Two decimals at most, no minus before a zero."""
    text = f"{round(float(value), 2) + 0.0:.2f}".rstrip("0").rstrip(".")
    return text or "0"


def tag(name: str, content: str = "", /, **attributes: object) -> str:
    """One element; `stroke_width` becomes `stroke-width`, numbers are rounded, everything is escaped.

    Args:
        name: Of the element.
        content: Markup inside it, already escaped.
        attributes: Those that are None are left out.
    """
    parts = [
        f' {key.rstrip("_").replace("_", "-")}="{_value(value)}"'
        for key, value in attributes.items()
        if value is not None
    ]
    return f"<{name}{''.join(parts)}>{content}</{name}>" if content else f"<{name}{''.join(parts)}/>"


def text(x: float, y: float, words: str, /, **attributes: object) -> str:
    """Words at a point.

    Args:
        x: From the left [px].
        y: Of the base line, from the top [px].
        words: Any characters; they are escaped.
        attributes: Of the element, over the defaults `font_size` 11 and `fill` `INK`.
    """
    given: dict[str, object] = {"font_size": 11, "fill": INK, **attributes}
    return tag("text", html.escape(words), x=x, y=y, **given)


def path(points: ArrayLike, *, closed: bool = False) -> str:
    """The `d` of a line through points `(n, 2)`; a gap where one is NaN."""
    words, pen = [], "M"
    for x, y in np.asarray(points, dtype=float):
        if not (np.isfinite(x) and np.isfinite(y)):
            pen = "M"
            continue
        words.append(f"{pen}{number(x)} {number(y)}")
        pen = "L"
    return "".join(words) + ("Z" if closed and words else "")


def line(points: ArrayLike, colour: str, **attributes: object) -> str:
    """A line through points `(n, 2)` [px]."""
    given: dict[str, object] = {"stroke_width": 1.6, "stroke_linejoin": "round", **attributes}
    return tag("path", d=path(points), fill="none", stroke=colour, **given)


def drawing(width: float, height: float, parts: Iterable[str], title: str) -> str:
    """A whole picture that fills the width it is given.

    Args:
        width: Of the picture [px].
        height: Of the picture [px].
        parts: Its elements, as markup.
        title: For screen readers; any characters.
    """
    body = tag("title", html.escape(title)) + "".join(parts)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {number(width)} {number(height)}" role="img" '
        f'font-family="{html.escape(_FONT)}" fill="{INK}">{body}</svg>'
    )


def _value(value: object) -> str:
    if isinstance(value, (int, float, np.floating, np.integer)):
        return number(float(value))
    return html.escape(str(value))

"""Records as small pieces of HTML for notebooks: a table, and panels of curves as SVG."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence

import numpy as np

from exo_pin.anatomy.names import MOVEMENTS
from exo_pin.arrays import Array

COLOURS = ("#d13d4a", "#2976c7")
"""Of left and right, as the viewer has them."""

_WIDTH, _HEIGHT, _MARGIN = 150.0, 80.0, 16.0  # of a panel [px]
_MOST_POINTS = 200  # of a line


def table(facts: Mapping[str, object]) -> str:
    """Two columns: what, and how much.

    Args:
        facts: Name -> value; a number is shown with four digits.
    """
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th><td>{html.escape(_text(value))}</td></tr>"
        for name, value in facts.items()
    )
    return f"<table>{rows}</table>"


def panels(time: Array, curves: Mapping[str, Sequence[Array]], unit: str) -> str:
    """A row of small plots, one for each name, left and right in their colours.

    Args:
        time: `(n,)` [s].
        curves: Name -> curves `(n,)`, of the left and the right side.
        unit: Of the curves.
    """
    drawn = [_panel(k, name, time, lines, unit) for k, (name, lines) in enumerate(curves.items())]
    width, height = _WIDTH * min(len(drawn), 6), _HEIGHT * -(-len(drawn) // 6)
    size = f"width='{width:.0f}' height='{height:.0f}' viewBox='0 0 {width:.0f} {height:.0f}'"
    return f"<svg xmlns='http://www.w3.org/2000/svg' {size} font-family='sans-serif'>{''.join(drawn)}</svg>"


def joint_panels(time: Array, values: Array, unit: str) -> str:
    """Panels of the six movements of the legs.

    Args:
        time: `(n,)` [s].
        values: `(n, 12)` in the order of `JOINTS`.
        unit: Of the values.
    """
    half = len(MOVEMENTS)
    pairs = {name.replace("_", " "): (values[:, k], values[:, half + k]) for k, name in enumerate(MOVEMENTS)}
    return panels(time, pairs, unit)


def _panel(k: int, name: str, time: Array, lines: Sequence[Array], unit: str) -> str:
    x0, y0 = _WIDTH * (k % 6), _HEIGHT * (k // 6)
    known = [line[np.isfinite(line)] for line in lines]
    every = np.concatenate(known) if known else np.zeros(0)
    low, high = (float(every.min()), float(every.max())) if every.size else (0.0, 1.0)
    title = f"{html.escape(name)}, {low:.0f} to {high:.0f} {html.escape(unit)}"
    drawn = "".join(
        f"<polyline fill='none' stroke='{colour}' points='{_points(time, line, x0, y0, low, high)}'/>"
        for colour, line in zip(COLOURS, lines, strict=False)
    )
    return f"<text x='{x0:.0f}' y='{y0 + 10:.0f}' font-size='8'>{title}</text>{drawn}"


def _points(time: Array, line: Array, x0: float, y0: float, low: float, high: float) -> str:
    step = max(len(line) // _MOST_POINTS, 1)
    good = np.isfinite(line[::step])
    t, y = time[::step][good], line[::step][good]
    span = max(float(time[-1] - time[0]), 1e-9)
    x = x0 + (_WIDTH - _MARGIN) * (t - time[0]) / span
    down = y0 + _HEIGHT - 4.0 - (_HEIGHT - _MARGIN - 4.0) * (y - low) / max(high - low, 1e-9)
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x.tolist(), down.tolist(), strict=True))


def _text(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)

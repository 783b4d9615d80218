"""The loop of inverse kinematics (the paper's Fig. 2) as a diagram, and its error against the step."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from exo_pin.arrays import Array
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart import Chart, Curve, Level, draw
from exo_pin.report.draw.drawing import Drawing


def convergence(errors: Array, tolerance: float, percent: float) -> Drawing:
    """The errors on a logarithmic scale (decades).

    Args:
        errors: `(k + 1,)` after 0, 1 .. k corrections [m or rad].
        tolerance: At which the iteration ends [m or rad].
        percent: Where in the walk the sample lies.
    """
    decades = np.log10(np.maximum(errors, 1e-16))
    steps = np.arange(len(errors))
    chart = Chart(
        title="Larger foot error after k corrections, log10 of [m, rad]",
        x_label=f"corrections k (sample at {percent:.0f} % of the walk, start: mid-range)",
        curves=(Curve(steps, decades, svg.INK),),
        levels=(Level(float(np.log10(tolerance)), svg.GREY, "tolerance"),),
        y_range=(min(float(decades.min()), float(np.log10(tolerance))) - 1, float(decades.max()) + 1),
        width=420,
        height=320,
    )
    return Drawing("fig2_convergence", chart.title, draw(chart))


def diagram(tolerance: float) -> Drawing:
    """Guess, forward kinematics, compare, correct, repeat; `tolerance` [m and rad]."""
    boxes = (
        (20, "start: mid-range, or the sample before", "q"),
        (92, "forward kinematics: poses of both feet", "T(q)"),
        (164, "compare with the target poses", "e = error of position and rotation"),
        (236, f"every error below {tolerance:.0e} m, rad?", ""),
        (318, "correct within the joint limits", "minimise |J x - e|² + damping |x|²,  q ← q + x"),
    )
    parts = [_box(y, *words) for y, *words in boxes]
    parts += [_arrow([[190, a + 46], [190, b]]) for (a, *_), (b, *_) in pairwise(boxes[:4])]
    parts.append(_arrow([[190, 282], [190, 318]]))
    parts.append(svg.text(198, 304, "no", fill=svg.GREY))
    parts.append(_arrow([[30, 341], [12, 341], [12, 115], [30, 115]]))
    parts.append(_arrow([[350, 259], [396, 259]]))
    parts.append(svg.text(356, 252, "yes", fill=svg.GREY))
    parts.append(svg.text(402, 263, "q", font_weight=600))
    title = "The loop of inverse kinematics"
    return Drawing("fig2_loop", title, svg.drawing(420, 376, parts, title))


def _box(y: float, words: str, formula: str) -> str:
    shape = {"x": 30, "y": y, "width": 320, "height": 46, "rx": 6}
    parts = svg.tag("rect", fill="#f3f5f7", stroke=svg.GREY, **shape)
    parts += svg.text(190, y + (20 if formula else 27), words, text_anchor="middle", font_size=12.5)
    if formula:
        parts += svg.text(190, y + 37, formula, text_anchor="middle", font_size=11, fill=svg.GREY)
    return parts


def _arrow(points: list[list[float]]) -> str:
    p = np.array(points, dtype=float)
    along = (p[-1] - p[-2]) / np.linalg.norm(p[-1] - p[-2])
    across = np.array([-along[1], along[0]])
    head = [p[-1], p[-1] - 8 * along + 4 * across, p[-1] - 8 * along - 4 * across]
    p[-1] -= 6 * along
    return svg.line(p, svg.GREY) + svg.tag("path", d=svg.path(head, closed=True), fill=svg.GREY)

"""Bars of several trials against normal walks: a panel for each number, a row for each trial."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from exo_pin.report.draw import svg
from exo_pin.report.draw.chart_axis import ticks
from exo_pin.report.draw.drawing import Drawing

_WIDTH, _LEFT, _TOP, _ROW, _GAP = 900.0, 150.0, 30.0, 17.0, 16.0
_LONGEST_NAME = 24  # characters


class Panel(NamedTuple):
    """One number of every trial.

    Attributes:
        title: With the unit.
        values: One a trial; None where it is not known.
        usual: Normal walks' range of each trial; None where no publication has one.
    """

    title: str
    values: Sequence[float | None]
    usual: Sequence[tuple[float, float] | None]


def trial_bars(names: Sequence[str], panels: Sequence[Panel]) -> Drawing:
    """The panels beside each other; grey: normal walks.

    Args:
        names: Of the trials.
        panels: One or more.
    """
    width = (_WIDTH - _LEFT) / len(panels)
    bottom = _TOP + _ROW * len(names)
    parts = [
        svg.text(_LEFT - 8, _TOP + _ROW * k + 12, _short(name), text_anchor="end")
        for k, name in enumerate(names)
    ]
    for k, panel in enumerate(panels):
        parts += _panel(panel, _LEFT + k * width, width - _GAP, bottom)
    title = "Trials against normal walks (grey)"
    return Drawing("trial_bars", title, svg.drawing(_WIDTH, bottom + 20, parts, title))


def _short(name: str) -> str:
    return name if len(name) <= _LONGEST_NAME else f"{name[: _LONGEST_NAME - 3]}..."


def _panel(panel: Panel, left: float, width: float, bottom: float) -> list[str]:
    ends = [x for x in panel.values if x is not None] + [pair[1] for pair in panel.usual if pair]
    top = 1.08 * max([*ends, 1e-6])
    parts = [svg.text(left, 14, panel.title, font_weight=600)]
    for x in ticks(0.0, top, 3):
        at = left + width * x / top
        parts.append(svg.line([[at, _TOP - 4], [at, bottom]], svg.FAINT, stroke_width=0.8))
        parts.append(svg.text(at, bottom + 13, f"{x:g}", text_anchor="middle", font_size=10, fill=svg.GREY))
    for k, (value, usual) in enumerate(zip(panel.values, panel.usual, strict=True)):
        y = _TOP + _ROW * k
        if usual:
            low, high = (left + width * max(x, 0.0) / top for x in usual)
            parts.append(svg.tag("rect", x=low, y=y + 1, width=high - low, height=_ROW - 2, fill="#c9d1d9"))
        if value is not None:
            inside = usual is None or usual[0] <= value <= usual[1]
            colour = "#2975c7" if inside else "#b3261e"
            long = width * max(value, 0.0) / top
            parts.append(svg.tag("rect", x=left, y=y + 5, width=long, height=_ROW - 10, fill=colour))
    return parts

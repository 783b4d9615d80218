"""Charts: curves, bands, limits and shaded spans over two axes, as SVG."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.arrays import Array
from exo_pin.report.draw import legend, svg
from exo_pin.report.draw.chart_axis import extent, label, ticks

_LEFT, _RIGHT, _TOP, _BOTTOM = 40.0, 14.0, 26.0, 34.0
_MOST_POINTS = 2000  # of one curve: five for every pixel


@dataclass(frozen=True, eq=False)
class Curve:
    """A line through `(x, y)`, both `(n,)`; NaN makes a gap. Without a label it is not in the legend."""

    x: ArrayLike
    y: ArrayLike
    colour: str
    label: str = ""
    dash: str | None = None
    width: float = 1.7
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Band:
    """The area between `low` and `high`, both `(n,)`, over `x`."""

    x: ArrayLike
    low: ArrayLike
    high: ArrayLike
    colour: str
    label: str = ""
    opacity: float = 0.22


class Span(NamedTuple):
    """A shaded part of the x axis; `lane` 0 or 1: a thin strip at the bottom, None: the whole height."""

    start: float
    end: float
    colour: str
    label: str = ""
    lane: int | None = None


class Moment(NamedTuple):
    """A dashed vertical line, e.g. an event."""

    x: float
    colour: str
    label: str = ""


class Level(NamedTuple):
    """A dashed horizontal line, e.g. a limit.

    `always_in_legend`: the legend names the line even where the axis does not reach it.
    """

    y: float
    colour: str = svg.GREY
    label: str = ""
    always_in_legend: bool = False


@dataclass(frozen=True, eq=False, kw_only=True)
class Chart:
    """The contents of a chart.

    Attributes:
        title: Heading; the y axis's unit belongs here.
        x_label: Under the x axis.
        curves: In the order of drawing.
        bands: Under the curves.
        spans: Under everything.
        levels: Horizontal lines; they do not widen the y axis.
        moments: Vertical lines.
        legend: Whether it is under the chart; `key` makes one for several charts.
        x_range: From, to; that of the curves if left out.
        y_range: Likewise.
        least: Smallest extent of the y axis, so that noise is not enlarged to the whole axis.
        equal: One unit is as long on both axes; the height follows.
        width: Of the picture [px].
        height: Of the picture without its legend [px].
    """

    title: str
    x_label: str = ""
    curves: tuple[Curve, ...] = ()
    bands: tuple[Band, ...] = ()
    spans: tuple[Span, ...] = ()
    levels: tuple[Level, ...] = ()
    moments: tuple[Moment, ...] = ()
    legend: bool = True
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    least: float = 0.0
    equal: bool = False
    width: float = 360.0
    height: float = 210.0


class _Frame(NamedTuple):
    """The plotting area: ranges, and where it lies [px]."""

    x: tuple[float, float]
    y: tuple[float, float]
    left: float
    top: float
    width: float
    height: float

    def points(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Points `(n, 2)` [px]."""
        return np.stack([self.across(np.asarray(x, float)), self.up(np.asarray(y, float))], axis=1)

    def across(self, x: Array | float) -> Array:
        share = (np.asarray(x) - self.x[0]) / (self.x[1] - self.x[0])
        return np.asarray(self.left + self.width * share)

    def up(self, y: Array | float) -> Array:
        share = (np.asarray(y) - self.y[0]) / (self.y[1] - self.y[0])
        return np.asarray(self.top + self.height * (1 - share))


def draw(chart: Chart) -> str:
    """The chart as one `<svg>` that scales to the width it is given."""
    frame = _frame(chart)
    top = frame.top + frame.height + _BOTTOM
    marks = _marks(chart, frame) if chart.legend else {}
    keys, rows = legend.rows(marks, frame.left, top, chart.width)
    height = top + legend.ROW_HEIGHT * rows
    clip = f"c{zlib.crc32(repr(frame).encode()):x}"  # equal areas share a name, which does no harm
    inner = [part for draw_part in _INNER for part in draw_part(chart, frame)]
    area = {"x": frame.left, "y": frame.top, "width": frame.width, "height": frame.height}
    parts = [
        svg.tag("clipPath", svg.tag("rect", **area), id=clip),
        svg.text(frame.left - 2, 15, chart.title, font_size=12.5, font_weight=600),
        *_axes(chart, frame),
        svg.tag("g", "".join(inner), clip_path=f"url(#{clip})"),
        *keys,
    ]
    return svg.drawing(chart.width, height, parts, chart.title)


def _frame(chart: Chart) -> _Frame:
    x = chart.x_range or extent([c.x for c in chart.curves] + [b.x for b in chart.bands], 0.0, pad=0.0)
    seen = [c.y for c in chart.curves] + [edge for b in chart.bands for edge in (b.low, b.high)]
    y = chart.y_range or extent(seen, chart.least)
    width = chart.width - _LEFT - _RIGHT
    height = chart.height - _TOP - _BOTTOM
    if chart.equal:
        height = width * (y[1] - y[0]) / (x[1] - x[0])
    return _Frame(x, y, _LEFT, _TOP, width, height)


def _axes(chart: Chart, frame: _Frame) -> list[str]:
    bottom, right = frame.top + frame.height, frame.left + frame.width
    count = max(3, min(6, int(frame.height / 28)))
    parts = []
    ys, xs = ticks(*frame.y, count), ticks(*frame.x, max(4, int(frame.width / 62)))
    for y in ys:
        at = float(frame.up(y))
        strong = abs(y) < 1e-12
        parts.append(
            svg.line([[frame.left, at], [right, at]], "#9aa4af" if strong else svg.FAINT, stroke_width=0.8)
        )
        parts.append(
            svg.text(frame.left - 5, at + 3.5, label(y, ys), text_anchor="end", font_size=10, fill=svg.GREY)
        )
    for x in xs:
        at = float(frame.across(x))
        parts.append(svg.line([[at, bottom], [at, bottom + 4]], "#9aa4af", stroke_width=0.8))
        parts.append(
            svg.text(at, bottom + 14, label(x, xs), text_anchor="middle", font_size=10, fill=svg.GREY)
        )
    parts.append(svg.line([[frame.left, bottom], [right, bottom]], "#9aa4af", stroke_width=0.8))
    middle = frame.left + frame.width / 2
    parts.append(
        svg.text(middle, bottom + 28, chart.x_label, text_anchor="middle", font_size=10.5, fill=svg.GREY)
    )
    return parts


def _spans(chart: Chart, frame: _Frame) -> list[str]:
    parts = []
    for span in chart.spans:
        a, b = (float(frame.across(np.clip(x, *frame.x))) for x in (span.start, span.end))
        top, tall = frame.top, frame.height
        if span.lane is not None:
            top, tall = frame.top + frame.height - 5 * (2 - span.lane), 4.0
        opacity = 0.08 if span.lane is None else 0.75
        parts.append(svg.tag("rect", x=a, y=top, width=b - a, height=tall, fill=span.colour, opacity=opacity))
    return parts


def _bands(chart: Chart, frame: _Frame) -> list[str]:
    parts = []
    for band in chart.bands:
        over, under = frame.points(band.x, band.high), frame.points(band.x, band.low)
        outline = svg.path(np.concatenate([over, under[::-1]]), closed=True)
        parts.append(svg.tag("path", d=outline, fill=band.colour, fill_opacity=band.opacity))
    return parts


def _levels(chart: Chart, frame: _Frame) -> list[str]:
    parts = []
    for level in chart.levels:
        if frame.y[0] <= level.y <= frame.y[1]:
            at, right = float(frame.up(level.y)), frame.left + frame.width
            ends = [[frame.left, at], [right, at]]
            parts.append(svg.line(ends, level.colour, stroke_dasharray="2 3", stroke_width=1.1))
    return parts


def _moments(chart: Chart, frame: _Frame) -> list[str]:
    return [
        svg.line(
            [[at, frame.top], [at, frame.top + frame.height]],
            moment.colour,
            stroke_dasharray="4 3",
            stroke_width=0.9,
        )
        for moment in chart.moments
        for at in [float(frame.across(moment.x))]
    ]


def _curves(chart: Chart, frame: _Frame) -> list[str]:
    return [
        svg.line(
            _thinned(frame.points(c.x, c.y)),
            c.colour,
            stroke_width=c.width,
            stroke_dasharray=c.dash,
            opacity=None if c.opacity == 1.0 else c.opacity,
        )
        for c in chart.curves
    ]


_INNER = (_spans, _bands, _levels, _moments, _curves)
"""What is drawn within the axes, from the back to the front."""


def key(charts: Sequence[Chart], width: float = 900.0) -> str:
    """One legend for several charts, as a picture of its own.

    Args:
        charts: Whose marks it explains.
        width: Of the picture [px].
    """
    marks: dict[str, str] = {}
    for chart in charts:
        marks |= _marks(chart, _frame(chart))
    parts, rows = legend.rows(marks, 2.0, 0.0, width)
    return svg.drawing(width, legend.ROW_HEIGHT * rows + 4, parts, "Key of the curves")


def _thinned(points: Array) -> Array:
    """Every k-th point, so that a long recording does not make a file of many megabytes."""
    return points[:: -(-len(points) // _MOST_POINTS) or 1]


def _marks(chart: Chart, frame: _Frame) -> dict[str, str]:
    """What the legend explains: words -> a small mark."""
    marks = {c.label: _dash(c.colour, c.dash, max(c.width, 1.6)) for c in chart.curves}
    marks |= {band.label: _swatch(band.colour, band.opacity) for band in chart.bands}
    seen = {level.label for level in chart.levels if frame.y[0] <= level.y <= frame.y[1]}
    for level in chart.levels:
        if level.label in seen:
            marks[level.label] = _dash(level.colour, "2 3", 1.6)
        elif level.always_in_legend:
            marks[f"{level.label}: off the axis"] = _dash(level.colour, "2 3", 1.6)
    marks |= {moment.label: _dash(moment.colour, "4 3", 1.2) for moment in chart.moments}
    marks |= {span.label: _swatch(span.colour, 0.12 if span.lane is None else 0.75) for span in chart.spans}
    marks.pop("", None)
    return marks


def _dash(colour: str, dash: str | None, width: float) -> str:
    return svg.line([[0, 0], [16, 0]], colour, stroke_width=width, stroke_dasharray=dash)


def _swatch(colour: str, opacity: float) -> str:
    return svg.tag("rect", x=0, y=-4, width=16, height=8, fill=colour, opacity=opacity)

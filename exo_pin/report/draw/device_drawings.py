"""Drawings of devices under one walk: ranking, stick figures, errors, joints, centre of mass."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exo_pin.anatomy import JOINTS, MOVEMENTS, SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.compare import Comparison, Loss, Walk
from exo_pin.compare.loss import axes
from exo_pin.kinematics.resting_stance import travel
from exo_pin.report.draw import palette, skeleton, svg, walk_charts
from exo_pin.report.draw.chart import Chart, Curve, draw
from exo_pin.report.draw.chart_axis import ticks
from exo_pin.report.draw.cycle_axis import cycle_axis
from exo_pin.report.draw.drawing import Drawing

COINCIDENT_NOTE = "Devices whose curves lie on each other are drawn once, under all their names."
_SAME = {"mm": 0.05, "deg": 0.05}  # curves closer than this are drawn as one
_SHADOW = "#bcc4cd"
_MOMENTS = 5  # every second of the ten that `skeleton.moments` finds
_APART = 0.85  # [m] between two poses of sticks


def ranking(compared: Comparison) -> Drawing:
    """Sole error of every device: a bar for the best motion, a stroke for the plain copy [mm]."""
    pairs = list(zip(compared.best, compared.projected, strict=True))
    width, left, right = 900.0, 150.0, 150.0
    most = max(1e3 * max(best.rms, copy.rms) for best, copy in pairs) or 1.0
    scale = (width - left - right) / most
    bottom, parts = 10.0 + 24 * len(pairs), []
    for x in ticks(0, most, 8):
        at = left + scale * x
        parts.append(svg.line([[at, 6], [at, bottom]], svg.FAINT, stroke_width=0.8))
        parts.append(svg.text(at, bottom + 14, f"{x:g}", text_anchor="middle", font_size=10, fill=svg.GREY))
    for k, (best, copy) in enumerate(pairs):
        y, long = 10 + 24 * k, 1e3 * best.rms
        words = f"{best.device.name} ({best.device.motors} motors)"
        parts.append(svg.text(left - 8, y + 13, words, text_anchor="end"))
        box = {"x": left, "y": y + 2, "width": max(scale * long, 0.8), "height": 14, "rx": 2}
        parts.append(svg.tag("rect", fill="#2975c7", opacity=0.85, **box))
        at = left + scale * 1e3 * copy.rms
        parts.append(svg.line([[at, y - 1], [at, y + 19]], "#d9822b", stroke_width=2.4))
        values = f"{long:.1f} (copy {1e3 * copy.rms:.1f})"
        parts.append(svg.text(width - 4, y + 13, values, text_anchor="end"))
    title = "Sole error, root mean square over the walk [mm]"
    parts.append(svg.text(left, bottom + 30, title, fill=svg.GREY))
    return Drawing("ranking", title, svg.drawing(width, bottom + 36, parts, title))


def sticks(loss: Loss) -> Drawing:
    """Five moments of a device's walk from the left, one from the front; the recorded walk in grey."""
    walk, width = loss.walk, 520.0
    rows = skeleton.moments(walk.gait)[0][::2]
    lines: list[tuple[Array, str, float]] = []
    for gait, shadow in ((walk.gait, True), (loss.motion.gait, False)):
        for side in reversed(SIDES):  # the left leg, nearer to the eye, is drawn last
            points = skeleton.chain(walk.robot, gait, side)[rows] - walk.base[rows, None, :3, 3]
            points = points @ axes(walk).T
            front = points[_MOMENTS // 2][:, [1, 2]] + [_APART * (_MOMENTS - 0.1), 0.0]
            moments = [p[:, [0, 2]] + [_APART * k, 0.0] for k, p in enumerate(points)]
            style = (_SHADOW, 5.0) if shadow else (svg.SIDE_COLOURS[side], 2.0)
            lines += [(moment, *style) for moment in (*moments, front)]
    everything = np.concatenate([points for points, *_ in lines])
    (low, bottom), (high, top) = everything.min(axis=0), everything.max(axis=0)
    scale = (width - 20) / (high - low)
    parts = [
        svg.line(
            np.stack([10 + scale * (p[:, 0] - low), 30 + scale * (top - p[:, 1])], axis=1),
            colour,
            stroke_width=thick,
            stroke_linecap="round",
        )
        for p, colour, thick in lines
    ]
    title = f"{loss.device.name}, {loss.device.motors} motors: {1e3 * loss.rms:.1f} mm"
    head = svg.text(10, 15, title, font_size=12.5, font_weight=600)
    height = 40 + scale * (top - bottom)
    return Drawing(f"sticks_{loss.device.name}", title, svg.drawing(width, height, [head, *parts], title))


def errors(compared: Comparison) -> tuple[Drawing, ...]:
    """Position and orientation error of each foot over its cycle, all devices."""
    kinds: tuple[tuple[str, str, float, Callable[[Loss], Array]], ...] = (
        ("position", "mm", 1e3, lambda loss: loss.position_error),
        ("orientation", "deg", float(np.degrees(1.0)), lambda loss: loss.rotation_error),
    )
    drawings = []
    for name, unit, scale, error in kinds:
        for k, side in enumerate(SIDES):
            series = {loss.device.name: scale * error(loss)[:, k] for loss in compared.best}
            title = f"{side.capitalize()} foot, error of {name} [{unit}]"
            drawings.append(_drawn(compared, side, f"{name}_{side}", title, series, unit, width=480))
    return tuple(drawings)


def joints(compared: Comparison, side: Side) -> tuple[Drawing, ...]:
    """A leg's joints in every device that moves them, before the recorded angles (black) [deg]."""
    drawings = []
    for movement in MOVEMENTS:
        column = JOINTS.index(f"{side}_{movement}")
        moving = [loss for loss in compared.best if f"{side}_{movement}" in loss.motion.robot.joints]
        series = {loss.device.name: np.degrees(loss.motion.gait.q[:, column]) for loss in moving}
        recorded = np.degrees(compared.walk.gait.q[:, column])
        movement_title = walk_charts.MOVEMENT_TITLES[movement]
        title = f"{side.capitalize()} {movement_title[0].lower()}{movement_title[1:]}"
        name = f"joint_{side}_{movement}"
        drawings.append(_drawn(compared, side, name, title, series, "deg", recorded=recorded, least=20.0))
    return tuple(drawings)


def centre_of_mass(compared: Comparison) -> tuple[Drawing, ...]:
    """Forward, left, up about the recorded walk's even travel, every device before it (black) [mm]."""
    along, even = axes(compared.walk), _travel(compared.walk)
    drawings = []
    for k, name in enumerate(("forward", "to the left", "up")):
        series = {loss.device.name: 1e3 * (loss.motion.com @ along[k] - even[:, k]) for loss in compared.best}
        recorded = 1e3 * (compared.walk.com @ along[k] - even[:, k])
        title = f"Centre of mass, {name} [mm]"
        name = f"com_{'xyz'[k]}"
        drawings.append(_drawn(compared, "left", name, title, series, "mm", recorded=recorded, least=10.0))
    return tuple(drawings)


def _travel(walk: Walk) -> Array:
    """The even travel of the recorded centre of mass (n, 3), along forward, left and up [m]."""
    return travel(walk.gait.time, walk.com @ axes(walk).T, periodic=walk.gait.periodic)


def _drawn(
    compared: Comparison,
    side: Side,
    name: str,
    title: str,
    series: dict[str, Array],
    unit: str,
    *,
    recorded: Array | None = None,
    least: float = 1.0,
    width: float = 360.0,
) -> Drawing:
    """Series of all devices over the cycle of a foot, the recorded one behind them."""
    axis = cycle_axis(compared.walk.gait, side)
    styles = palette.line_styles(loss.device.name for loss in compared.best)
    shown = {device: axis.series(values) for device, values in series.items()}
    curves = palette.curves(axis.x, shown, styles, same=_SAME[unit])
    if recorded is not None:
        curves = (Curve(axis.x, axis.series(recorded), svg.INK, "recorded", width=3.0), *curves)
    chart = Chart(title=title, x_label=axis.label, curves=curves, spans=axis.spans, least=least, width=width)
    return Drawing(name, title, draw(chart))

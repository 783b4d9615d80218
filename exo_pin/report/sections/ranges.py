"""Range of each joint that the walk uses, against its limits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.demand import range_demands
from exo_pin.gait import Gait
from exo_pin.report.document.blocks import Block, Figure, Section, Table
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart_axis import ticks
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot


def ranges(robot: Robot, gait: Gait) -> Section:
    """Bars and a table: angles, limits, margins."""
    rows, bars = [], []
    for name, demand in range_demands(robot, robot.from_gait(gait)).items():
        if name not in JOINTS:  # a prismatic joint or a toe, which the gait does not have
            continue
        a, b, lower, upper = np.degrees([demand.lowest, demand.highest, *demand.available]).tolist()
        bars.append((name, a, b, lower, upper))
        values = (a, b, b - a, lower, upper, np.degrees(demand.margin))
        numbers = [f"{round(float(x), 1) + 0.0:.1f}" for x in values]
        rows.append([name, *numbers, str(demand.samples_outside or "-")])
    columns = (
        "joint",
        "min deg",
        "max deg",
        "range deg",
        "lower limit deg",
        "upper limit deg",
        "margin deg",
        "frames outside",
    )
    blocks: tuple[Block, ...] = (
        Figure((range_bars(bars),), columns=1, screen=True),
        Table(columns, rows, "Ranges and limits [deg]; margin: to the nearer limit, negative outside"),
    )
    return Section("Ranges and limit margins", blocks)


def range_bars(rows: Sequence[tuple[str, float, float, float, float]]) -> Drawing:
    """Bars by joint: the used part of its range.

    Args:
        rows: Joint, smallest and largest angle, lower and upper limit [deg].
    """
    width, left = 900.0, 160.0
    low, high = min(r[3] for r in rows) - 5, max(r[4] for r in rows) + 5
    low, high = min(low, *(r[1] for r in rows)), max(high, *(r[2] for r in rows))
    scale = (width - left - 16) / (high - low)
    parts = []
    bottom = 10 + 19 * len(rows)
    for x in ticks(low, high, 9):
        at = left + scale * (x - low)
        parts.append(svg.line([[at, 8], [at, bottom]], svg.FAINT, stroke_width=0.8))
        parts.append(svg.text(at, bottom + 13, f"{x:.0f}", text_anchor="middle", font_size=10, fill=svg.GREY))
    for k, (joint, a, b, lower, upper) in enumerate(rows):
        y, colour = 10 + 19 * k, svg.SIDE_COLOURS.get(joint.split("_")[0], svg.GREY)
        parts.append(svg.text(left - 8, y + 12, joint.replace("_", " "), text_anchor="end"))
        room = {"x": left + scale * (lower - low), "y": y + 4, "width": scale * (upper - lower), "height": 9}
        parts.append(svg.tag("rect", fill="#c9d1d9", rx=2, **room))
        used = {"x": left + scale * (a - low), "y": y + 2, "width": max(scale * (b - a), 1.5), "height": 13}
        parts.append(svg.tag("rect", fill=colour, rx=3, **used))
    title = "Angles used (coloured) within the joints' ranges (grey) [deg]"
    parts.append(svg.text(left + (width - left) / 2, bottom + 28, title, text_anchor="middle", fill=svg.GREY))
    return Drawing("ranges", title, svg.drawing(width, bottom + 34, parts, title))

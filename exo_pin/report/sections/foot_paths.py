"""Paths of the feet, and when each is on the ground."""

from __future__ import annotations

from exo_pin.anatomy import CORNERS, SIDES
from exo_pin.arrays import Array
from exo_pin.gait import Gait, stance_times
from exo_pin.kinematics import poses
from exo_pin.kinematics.sole_points import heels_and_balls
from exo_pin.report.document.blocks import Figure, Paragraph, Section, Table
from exo_pin.report.draw import svg, walk_charts
from exo_pin.report.draw.chart import Chart, Curve, draw
from exo_pin.report.draw.chart_axis import ticks
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot


def paths(robot: Robot, gait: Gait, forward: str) -> Section:
    """Heels and balls from the side and over time, and ten poses.

    Args:
        robot: The device on a body.
        gait: The walk, going along x.
        forward: What that direction is, in words.
    """
    base = robot.base_of(gait)
    corners = poses(robot, robot.from_gait(gait), CORNERS, base=base)[..., :3, 3]
    drawings = foot_paths(gait, corners)
    placed = "where its file puts it" if gait.base is not None else "still, as the support holds it"
    caption = (
        f"Heel and ball: midway between the sole's corners. Forward is {forward}; the pelvis is {placed}; "
        "heights count from the world's ground; the soles of a body of another size may end elsewhere."
    )
    return Section("Paths of the feet", (Figure(drawings, caption, columns=2, screen=True),))


def contact(gait: Gait) -> Section:
    """Timeline and table of the events."""
    if not gait.events:
        return Section("Feet on the ground", (Paragraph("No events: contact is unknown."),))
    before = [None, *(event.time for event in gait.events)]
    rows = [
        [
            f"{event.side} {event.kind.replace('_', ' ')}",
            f"{event.time:.3f}",
            "-" if last is None else f"{event.time - last:.3f}",
            event.source or "not stated",
        ]
        for event, last in zip(gait.events, before, strict=False)
    ]
    figure = Figure((timeline(gait),), "Bars: from heel strike to toe-off.", columns=1, screen=True)
    return Section(
        "Feet on the ground", (figure, Table(("event", "time s", "since the one before s", "source"), rows))
    )


def foot_paths(gait: Gait, corners: Array) -> tuple[Drawing, ...]:
    """Heels and balls of the feet: from the side, and their height over time.

    Args:
        gait: Its time and events.
        corners: `(n, 8, 3)` of the sole corners in the world, as in `anatomy.CORNERS` [m].
    """
    points = 100 * heels_and_balls(corners)  # [cm]
    time, closed = walk_charts.over_time(gait, points)
    side, height = [], []
    for s, name in enumerate(SIDES):
        for part, dash in ((0, None), (1, "4 3")):
            label = f"{name} {('heel', 'ball')[part]}"
            xyz = closed[:, s, part]
            side.append(Curve(xyz[:, 0], xyz[:, 2], svg.SIDE_COLOURS[name], label, dash))
            height.append(Curve(time, xyz[:, 2], svg.SIDE_COLOURS[name], label, dash))
    charts = (
        Chart(
            title="From the side: height over forward [cm]",
            x_label="forward [cm]",
            curves=tuple(side),
            width=420,
        ),
        Chart(
            title="Height of heel and ball [cm]",
            x_label="time [s]",
            curves=tuple(height),
            spans=walk_charts.stance_spans(gait),
            width=420,
        ),
    )
    return tuple(Drawing(f"foot_{k}", chart.title, draw(chart)) for k, chart in enumerate(charts))


def timeline(gait: Gait) -> Drawing:
    """Which foot is on the ground when, with the events."""
    width, start, end = 900.0, float(gait.time[0]), float(gait.time[0]) + gait.duration

    def at(t: float) -> float:
        return 60 + (width - 80) * (t - start) / (end - start)

    parts = []
    for row, side in enumerate(SIDES):
        y, colour = 14 + 34 * row, svg.SIDE_COLOURS[side]
        parts.append(svg.text(52, y + 15, side, text_anchor="end", font_weight=600, fill=colour))
        parts.append(svg.tag("rect", x=60, y=y, width=width - 80, height=22, fill=colour, opacity=0.1))
        for a, b in ((start + a, start + b) for a, b in stance_times(gait, side)):
            box = {"x": at(a), "y": y, "width": at(b) - at(a), "height": 22, "rx": 3}
            parts.append(svg.tag("rect", fill=colour, **box))
            if at(b) - at(a) > 46:
                middle = (at(a) + at(b)) / 2
                words = f"{b - a:.2f} s"
                parts.append(svg.text(middle, y + 15, words, text_anchor="middle", fill="#fff"))
    for t in ticks(start, end, 8):
        parts.append(svg.line([[at(t), 78], [at(t), 83]], svg.GREY, stroke_width=0.8))
        parts.append(svg.text(at(t), 95, f"{t:.2f}", text_anchor="middle", font_size=10, fill=svg.GREY))
    parts.append(svg.text(60 + (width - 80) / 2, 110, "time [s]", text_anchor="middle", fill=svg.GREY))
    return Drawing("contact", "Feet on the ground", svg.drawing(width, 116, parts, "Feet on the ground"))

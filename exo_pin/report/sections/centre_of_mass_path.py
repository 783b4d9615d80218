"""The path of the centre of mass."""

from __future__ import annotations

import numpy as np

from exo_pin.arrays import Array
from exo_pin.gait import Gait
from exo_pin.kinematics import center_of_mass
from exo_pin.report.document.blocks import Figure, Section, Table
from exo_pin.report.draw import walk_charts
from exo_pin.report.draw.chart import Chart, Curve, draw
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot


def centre_of_mass(robot: Robot, gait: Gait) -> Section:
    """Charts about its mean, and a table of means and excursions."""
    base = robot.base_of(gait)
    position = center_of_mass(robot, robot.from_gait(gait), base=base).position
    rows = [
        [name, f"{mean:.3f}", f"{1e3 * extent:.1f}"]
        for name, mean, extent in zip(
            ("forward", "to the left", "up"), position.mean(axis=0), np.ptp(position, axis=0), strict=True
        )
    ]
    body = robot.body
    whose = (
        ""
        if body is None
        else f" of {body.total_mass:.1f} kg ({'with' if body.wearer else 'without'} wearer)"
    )
    caption = f"Centre of mass{whose}: device and wearer; head, arms and trunk are one part of the pelvis."
    table = Table(("direction", "mean m", "excursion mm"), rows, "In the world frame")
    return Section("Centre of mass", (Figure(charts(gait, position), caption, screen=True), table))


def charts(gait: Gait, position: Array) -> tuple[Drawing, ...]:
    """Forward, left and up `(n, 3)` [m] about their means, in millimetres."""
    time, closed = walk_charts.over_time(gait, 1e3 * (position - position.mean(axis=0)))
    drawings = []
    for axis, name in enumerate(("forward", "to the left", "up")):
        title = f"Centre of mass, {name} [mm]"
        chart = Chart(
            title=title,
            x_label="time [s]",
            curves=(Curve(time, closed[:, axis], "#2f7d5b"),),
            spans=walk_charts.stance_spans(gait),
            least=10.0,
            height=170,
        )
        drawings.append(Drawing(f"com_{'xyz'[axis]}", title, draw(chart)))
    return tuple(drawings)

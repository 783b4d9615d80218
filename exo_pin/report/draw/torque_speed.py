"""Torque-speed planes of a sized walk as SVG: the points of every joint below the limit of its drive."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import MOVEMENTS
from exo_pin.arrays import Array
from exo_pin.devices import movement_of
from exo_pin.report.draw import chart, svg
from exo_pin.report.draw.chart import Chart, Curve
from exo_pin.sizing import JointSizing, Sizing, motor_torque

_COLUMNS, _WIDTH, _HEIGHT, _TOP = 3, 360.0, 290.0, 34.0
_DASH = "6 3"
_ROOM = 1.08  # between the outermost point and the end of its axis


def torque_speed_svg(sizing: Sizing, title: str) -> str:
    """One plane for each movement: sizes of torque and speed at the joint, and the edge of its drive.

    With a motor the torque includes that of its rotor, and the edge is its speed-torque line at the given
    ratio, else at the best or nearest one. Points of braking may lie above it (`Motor.line_use`).

    Args:
        sizing: The walk.
        title: What the walk is called; the kind of its ground reaction is added.
    """
    drawn = []
    for movement in MOVEMENTS:
        joints = [joint for joint in sizing.joints if movement_of(joint.load.joint) == movement]
        if joints:
            drawn.append(chart.draw(_plane(movement, joints)))
    rows = -(-len(drawn) // _COLUMNS)
    heading = f"{title}, ground reaction {sizing.reaction}"
    parts = [svg.text(12, 22, heading, font_size=14, font_weight=600)]
    for k, picture in enumerate(drawn):
        row, column = divmod(k, _COLUMNS)
        parts.append(_placed(picture, column * _WIDTH, _TOP + row * _HEIGHT))
    return svg.drawing(_COLUMNS * _WIDTH, _TOP + rows * _HEIGHT, parts, heading)


def _placed(picture: str, x: float, y: float) -> str:
    """A picture as a part of another."""
    place = f'x="{x:g}" y="{y:g}" width="{_WIDTH:g}" height="{_HEIGHT:g}" preserveAspectRatio="xMinYMin" '
    return picture.replace("<svg ", f"<svg {place}", 1)


def _plane(movement: str, joints: list[JointSizing]) -> Chart:
    curves = []
    for joint in joints:
        side = joint.load.joint.partition("_")[0]
        colour = svg.SIDE_COLOURS[side]
        edge, words = _edge(joint)
        curves.append(Curve(np.abs(joint.load.speed), np.abs(_torque(joint)), colour, side))
        curves.append(Curve(edge[:, 0], edge[:, 1], colour, f"{side}: {words}", _DASH))
    ends = [_ROOM * max(float(np.max(getattr(curve, axis))) for curve in curves) for axis in "xy"]
    return Chart(
        title=f"{movement.replace('_', ' ')}: torque [N m]",
        x_label="speed [rad/s]",
        curves=tuple(curves),
        x_range=(0.0, ends[0]),
        y_range=(0.0, ends[1]),
    )


def _torque(joint: JointSizing) -> Array:
    """At the joint, with what turns the rotor."""
    use = joint.use
    if use is None or joint.motor is None:
        return joint.load.torque
    return use.ratio * motor_torque(joint.load, joint.motor, use.ratio)


def _edge(joint: JointSizing) -> tuple[Array, str]:
    """Corners `(k, 2)` of the limit as speed and torque, and what it is."""
    use = joint.use
    if use is None or joint.motor is None:
        corners = [(0.0, joint.effort), (joint.velocity, joint.effort), (joint.velocity, 0.0)]
        return np.array(corners), "record's rectangle"
    torque, speed = use.ratio * joint.motor.peak_torque, joint.motor.no_load_speed / use.ratio
    return np.array([(0.0, torque), (speed, 0.0)]), f"motor, {use.ratio:.1f}:1"

"""Line drawings of the exoskeleton: local frames, the whole model, and a walk as stick figures."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Index
from exo_pin.gait import Gait
from exo_pin.gait.strides import strides
from exo_pin.kinematics import poses, walking_speed
from exo_pin.report.draw import svg
from exo_pin.report.draw.chart import Chart, Curve, Level, draw
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot

_AXIS_COLOURS = {"x": "#d9822b", "y": "#2e8b57", "z": "#6a4fb3"}
_AZIMUTH, _ELEVATION = np.radians(38.0), np.radians(16.0)
_POSES = 10


def frames_drawing(robot: Robot) -> Drawing:
    """The 13 local frames and the world's at q = 0, seen from the front left."""
    project = _camera(robot, 430, 640)
    parts = [*_legs(robot, project, thin=True)]
    words = {"hip": "3 hip frames", "knee": "knee frame", "ankle": "2 ankle frames"}
    for side in SIDES:
        for name, movement in (
            ("hip", "hip_flexion"),
            ("knee", "knee_flexion"),
            ("ankle", "ankle_inversion"),
        ):
            T = poses(robot, robot.neutral, (f"{side}_{movement}",))[0]
            shift, anchor = (16, "start") if side == "left" else (-16, "end")
            parts += _triad(project, T, 0.085)
            parts.append(_label(project, T[:3, 3], f"{side}: {words[name]}", shift, -10, anchor))
    pelvis = poses(robot, robot.neutral, ("pelvis",))[0]
    parts += [*_triad(project, pelvis, 0.11), _label(project, pelvis[:3, 3], "body", 8, -62, "start")]
    parts += [*_triad(project, np.eye(4), 0.16), _label(project, np.zeros(3), "world W", -4, 36, "middle")]
    title = "Coordinate frames at q = 0"
    return Drawing("fig1_frames", title, svg.drawing(430, 640, parts, title))


def model_drawing(robot: Robot) -> Drawing:
    """The exoskeleton as a line drawing, for machines without a browser to render it."""
    project = _camera(robot, 520, 640)
    title = "The exoskeleton, line drawing"
    return Drawing("fig3_model", title, svg.drawing(520, 640, _legs(robot, project, thin=False), title))


def poses_chart(robot: Robot, gait: Gait, *, width: float = 900.0) -> tuple[Drawing, str]:
    """Ten poses of the first cycle (or of all) from the side, axes in cm, and how they were placed.

    Args:
        robot: The device on a body.
        gait: The walk.
        width: Of the picture [px].
    """
    rows, what = moments(gait)
    chains = {side: chain(robot, gait, side)[rows] for side in SIDES}
    lowest = np.min([chain[:, 3:, 2].min(axis=1) for chain in chains.values()], axis=0)
    advance, how = _advance(robot, gait, rows)
    curves = []
    for side in reversed(SIDES):  # the left leg, nearer to the eye, is drawn last
        for k, points in enumerate(chains[side]):
            x, z = 100 * (points[:, 0] + advance[k]), 100 * (points[:, 2] - lowest[k])
            curves.append(Curve(x[:2], z[:2], "#8a95a1", "trunk", width=2.2))
            curves.append(Curve(x[1:], z[1:], svg.SIDE_COLOURS[side], f"{side} leg", width=2.2))
    everything = np.concatenate([np.stack([np.asarray(c.x), np.asarray(c.y)], axis=1) for c in curves])
    (low, _), (high, top) = everything.min(axis=0), everything.max(axis=0)
    chart = Chart(
        title=f"Ten poses of {what}, from the left [cm]",
        x_label="forward [cm]",
        curves=tuple(curves),
        levels=(Level(0.0, svg.INK),),
        x_range=(low - 12, high + 12),
        y_range=(-8, top + 10),
        equal=True,
        width=width,
    )
    note = f"{how} Each pose stands on its lowest sole corner (the support carries the pelvis)."
    return Drawing("fig5_poses", chart.title, draw(chart)), note


def moments(gait: Gait) -> tuple[Index, str]:
    """Rows at 0, 10 .. 90 % of the first cycle of a foot, or of all without one; and which it is."""
    start, span, what = float(gait.time[0]), gait.duration, "a recording without a whole cycle"
    found = [] if gait.periodic else [each for side in SIDES for each in strides(gait, side) if not each.why]
    if gait.periodic:
        what = "one gait cycle"
    elif found:
        start, span, what = found[0].start, found[0].duration, "one gait cycle"
    times = start + span * np.arange(_POSES) / _POSES
    return np.asarray(np.abs(gait.time[:, None] - times).argmin(axis=0)), what


def _advance(robot: Robot, gait: Gait, rows: Index) -> tuple[Array, str]:
    """How far forward (10,) [m] each pose is moved, and why."""
    times: Array = gait.time[rows] - gait.time[rows[0]]
    apart: Array = 0.45 * np.arange(float(_POSES))
    speed = walking_speed(robot, gait)
    if math.isnan(speed):
        return apart, "The poses are 45 cm apart for the picture: the walk's speed is unknown."
    moved = 0.0 if gait.base is None else float(np.linalg.norm(gait.base[-1, :2, 3] - gait.base[0, :2, 3]))
    if moved / gait.duration > speed / 2:
        return np.zeros(_POSES), "The pelvis moves forward as recorded."
    how = f"The pelvis walks on the spot; the poses are moved forward by its speed, {speed:.2f} m/s."
    return np.asarray(speed * times), how


def chain(robot: Robot, gait: Gait, side: Side) -> Array:
    """Trunk top, hip, knee, ankle, heel, ball, ankle `(n, 7, 3)` in the world [m].

    Args:
        robot: The device on a body.
        gait: The walk, n samples.
        side: Which leg.
    """
    names = [f"{side}_hip_flexion", f"{side}_knee_flexion", f"{side}_ankle_inversion"]
    names += [f"{side}_{part}_{edge}" for part in ("heel", "ball") for edge in ("medial", "lateral")]
    base = robot.base_of(gait)
    T = poses(robot, robot.from_gait(gait), ("pelvis", *names), base=base)
    p = T[..., :3, 3]
    trunk = p[:, 0] + 0.3 * T[:, 0, :3, 2]
    heel, ball = p[:, 4:6].mean(axis=1), p[:, 6:8].mean(axis=1)
    return np.stack([trunk, p[:, 1], p[:, 2], p[:, 3], heel, ball, p[:, 3]], axis=1)


class _Camera:
    """From metres to pixels, seen from the front left and a little from above."""

    def __init__(self, centre: Array, scale: float, width: float, height: float) -> None:
        self.centre, self.scale, self.middle = centre, scale, np.array([width / 2, height / 2])

    def __call__(self, p: Array) -> Array:
        x, y, z = np.moveaxis(np.asarray(p) - self.centre, -1, 0)
        away = np.cos(_AZIMUTH) * x + np.sin(_AZIMUTH) * y
        across = -np.sin(_AZIMUTH) * x + np.cos(_AZIMUTH) * y
        up = np.cos(_ELEVATION) * z - np.sin(_ELEVATION) * away
        return np.asarray(self.middle + self.scale * np.stack([across, -up], axis=-1))


def _camera(robot: Robot, width: float, height: float) -> _Camera:
    tall = float(robot.placement[2, 3]) + 0.2
    return _Camera(np.array([0.0, 0.0, tall / 2 - 0.02]), (height - 70) / (tall + 0.05), width, height)


def _legs(robot: Robot, project: _Camera, *, thin: bool) -> Iterator[str]:
    """Ring, bars, joints and soles at q = 0."""
    T = poses(robot, robot.neutral, ("pelvis",))[0]
    half = robot.body.waist_width / 2 if robot.body is not None else 0.2
    angle = np.linspace(0, 2 * np.pi, 60)
    ring = T[:3, 3] + np.stack([0.75 * half * np.cos(angle), half * np.sin(angle), 0 * angle + 0.06], axis=1)
    yield svg.line(project(ring), "#8a95a1", stroke_width=3 if thin else 9)
    width = 3.0 if thin else 13.0
    for side in SIDES:
        names = [f"{side}_{m}" for m in ("hip_flexion", "knee_flexion", "ankle_inversion")]
        corners = [f"{side}_{c}" for c in ("heel_medial", "heel_lateral", "ball_lateral", "ball_medial")]
        p = poses(robot, robot.neutral, (*names, *corners))[:, :3, 3]
        colour, opacity = svg.SIDE_COLOURS[side], 0.55 if thin else 1.0
        yield svg.tag(
            "path", d=svg.path(project(p[3:]), closed=True), fill=colour, fill_opacity=0.25, stroke=colour
        )
        yield svg.line(project(p[:3]), colour, stroke_width=width, opacity=opacity, stroke_linecap="round")
        yield svg.line(project(np.stack([T[:3, 3], p[0]])), "#8a95a1", stroke_width=width / 2)
        for point in project(p[:3]):
            radius = 4.0 if thin else 11.0
            yield svg.tag(
                "circle", cx=point[0], cy=point[1], r=radius, fill="#fff", stroke=colour, stroke_width=2
            )


def _triad(project: _Camera, T: Array, length: float) -> Iterator[str]:
    for k, (name, colour) in enumerate(_AXIS_COLOURS.items()):
        tip = T[:3, 3] + length * T[:3, k]
        a, b = project(np.stack([T[:3, 3], tip]))
        yield svg.line([a, b], colour, stroke_width=2.2)
        along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-9)
        across = np.array([-along[1], along[0]])
        head = [b + 5 * along, b + 3 * across, b - 3 * across]
        yield svg.tag("path", d=svg.path(head, closed=True), fill=colour)
        x, y = b + 12 * along
        yield svg.text(x, y + 3.5, name, fill=colour, text_anchor="middle", font_size=11)


def _label(project: _Camera, p: Array, words: str, dx: float, dy: float, anchor: str) -> str:
    x, y = project(p) + np.array([dx, dy])
    return svg.text(
        x, y, words, text_anchor=anchor, font_size=12, paint_order="stroke", stroke="#fff", stroke_width=3
    )

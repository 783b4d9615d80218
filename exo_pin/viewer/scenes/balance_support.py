"""The balance support behind the treadmill: column, bars to the pelvis, and a boom with straps.

An illustration: what a device's stand looks like is in no record. The bars end at the device's own bracket.
"""

from __future__ import annotations

from exo_pin.ground import PlacedWalk
from exo_pin.robot import Robot
from exo_pin.viewer.drawing_commands import Command, Material, box, cylinder, draw, place
from exo_pin.viewer.meshes.solids import translation
from exo_pin.viewer.scenes import props
from exo_pin.viewer.scenes.actor import DrawnSupport
from exo_pin.viewer.scenes.scene import ROOT, Bar, Box, Group

_PATH = f"{ROOT}/balance_support"
_METAL = Material((0.36, 0.40, 0.45, 1.0), 0.45, 0.25)
_DARK = Material((0.14, 0.15, 0.17, 1.0), 0.7, 0.05)
_ROD = (0.014, _METAL)
_STRAP = (0.007, Material((0.16, 0.20, 0.28, 1.0), 0.9, 0.0))
"""Radius [m] and surface."""

_BEHIND = 0.14
"""The column stands so far behind the treadmill [m]."""

_APART = 0.16
"""Distance of the bars of a side from those of the other [m]."""

_LEVELS = {"upper": 0.23, "lower": 0.11}
"""The bars end so high above mid-hip, at the bracket on the waist ring [m]."""

_RING, _BRACKET = 0.40, 0.09
"""Depth of half the waist ring over its width, and how far the bracket reaches behind it [m]: as the URDF."""

_SHOULDERS = 0.32
"""The straps end so high above mid-hip over the length of the legs."""

_ABOVE = 0.16
"""The boom lies so high above the top of the figure [m]."""


def balance_support(robot: Robot, walk: PlacedWalk, top: float, *, unloads: bool) -> DrawnSupport | None:
    """The stand of a device that has one; None over ground, and for a device that goes with the person.

    Args:
        robot: The device.
        walk: The walk on its ground.
        top: How far the figure reaches above the hips [m].
        unloads: Whether it carries a part of the weight: by a boom with straps.
    """
    if robot.device is None or robot.device.pelvis == "free" or walk.support.overground:
        return None
    mill = props.Treadmill.under(walk)
    at, back = mill.center - mill.length / 2 - _BEHIND, -_RING * _waist(robot) - _BRACKET
    hips = float(walk.base[:, 2, 3].mean())
    high = hips + (top + _ABOVE if unloads else 0.42)
    commands = [*_column(at, high), *_foot(at)]
    bars = [
        (Bar(f"{_PATH}/{level}_{side}", (at, s * _APART / 2, hips + up), (back, s * _APART / 2, up)), _ROD)
        for level, up in _LEVELS.items()
        for side, s in (("left", 1), ("right", -1))
    ]
    if unloads:
        ahead, up = float(walk.base[:, 0, 3].mean()), _SHOULDERS * hips
        commands += _boom(at, ahead, high)
        bars += [
            (Bar(f"{_PATH}/strap_{side}", (ahead, s * 0.12, high), (0.0, s * 0.15, up)), _STRAP)
            for side, s in (("left", 1), ("right", -1))
        ]
    for bar, (radius, material) in bars:
        commands.append(draw(f"{bar.path}/bar", cylinder(radius, 1.0), material))
        commands.append(place(f"{bar.path}/bar", translation(0, 0, 0.5)))
    frame = Box((at, 0.0, high / 2), (0.3, 0.4, high))
    return DrawnSupport(
        tuple(commands), tuple(bar for bar, _ in bars), Group("Balance support", (_PATH,)), frame
    )


def _column(at: float, high: float) -> list[Command]:
    base = -props.DECK
    carriage = translation(at, 0, 0)
    return [
        draw(f"{_PATH}/column", box((0.09, 0.13, high - base)), _METAL),
        place(f"{_PATH}/column", translation(0, 0, (high + base) / 2) @ carriage),
        draw(f"{_PATH}/rail", box((0.02, 0.05, 0.8 * (high - base))), _DARK),
        place(f"{_PATH}/rail", translation(0.048, 0, (high + base) / 2) @ carriage),
    ]


def _foot(at: float) -> list[Command]:
    path = f"{_PATH}/foot"
    return [
        draw(path, box((0.34, 0.6, 0.05)), _DARK),
        place(path, translation(at - 0.04, 0, 0.026 - props.DECK)),
    ]


def _boom(at: float, ahead: float, high: float) -> list[Command]:
    long, path = ahead - at + 0.05, f"{_PATH}/boom"
    return [
        draw(path, box((long, 0.07, 0.06)), _METAL),
        place(path, translation((at + ahead + 0.05) / 2, 0, high)),
        draw(f"{_PATH}/spreader", box((0.03, 0.30, 0.03)), _DARK),
        place(f"{_PATH}/spreader", translation(ahead, 0, high - 0.045)),
    ]


def _waist(robot: Robot) -> float:
    """Width of the waist ring [m]."""
    return 0.36 if robot.body is None else robot.body.waist_width

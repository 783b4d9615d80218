"""The joint curves beside the picture: which plots there are, and the samples that they draw."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS, MOVEMENTS
from exo_pin.arrays import Array
from exo_pin.gait import Gait, Torques, time_series
from exo_pin.robot import Robot
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.viewer.scenes.scene import Plot, PlotGroup, PlotSide, Series

_FIRST = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
"""The plots at the top: the sagittal plane; the others follow in the robot's order."""

_NO_LIMIT = 1e6
"""Stands for an infinite limit, which JSON does not know."""

_SIDE = re.compile(r"(?<![a-z])(left|right|l|r)(?![a-z])|^([LR])(?=[A-Z])")
"""`left_knee`, `leg_left_4_joint`, `l_knee`, `LKneePitch`."""

_SIDES: dict[str, PlotSide] = {"l": "left", "r": "right"}


class Unit(NamedTuple):
    """How values are shown: times `factor`, with `digits` decimals, on an axis of at least `least`."""

    name: str
    factor: float
    digits: int
    least: float


DEGREES = Unit("°", 180 / math.pi, 1, 20.0)
_DEGREES_PER_SECOND = Unit("°/s", 180 / math.pi, 0, 60.0)
NEWTON_METRES = Unit("N m", 1.0, 0, 20.0)


@dataclass(frozen=True, eq=False)
class Tab:
    """One quantity of joints over time: a tab of plots.

    Attributes:
        title: Of the tab.
        name: Of its array in the scene.
        joints: The joint of each column.
        values: `(n, J)` samples on the scene's time; NaN is a gap.
        lower: `(J,)` lower limits, in the unit of the values; infinite: none.
        upper: `(J,)` upper limits.
        unit: How values are shown.
        reference: `(m, J)` dashed curves on a time of their own, or None.
        reference_time: `(m,)` from 0 [s].
        compared: `(n, J)` dotted curves of a second walk on the scene's time, or None.
        band: Lower and upper end `(n, J)` of the normal band on the scene's time, NaN where unknown, or None.
        dashes: What the dashed curves are, where they are not the walk's reference.
        units: By movement, where it has a unit of its own.
        signs: By movement, what a positive value means; "": the title says it. Left out: the movement's name.
    """

    title: str
    name: str
    joints: tuple[str, ...]
    values: Array
    lower: Array
    upper: Array
    unit: Unit
    reference: Array | None = None
    reference_time: Array | None = None
    compared: Array | None = None
    band: tuple[Array, Array] | None = None
    dashes: str = ""
    units: Mapping[str, Unit] = field(default_factory=dict)
    signs: Mapping[str, str] = field(default_factory=dict)

    @property
    def dashed(self) -> str:
        """Name of the dashed curves' array; empty: there are none."""
        return "" if self.reference is None else f"{self.name}_reference"

    @property
    def dotted(self) -> str:
        """Name of the dotted curves' array; empty: there are none."""
        return "" if self.compared is None else f"{self.name}_compared"

    @property
    def band_names(self) -> tuple[str, str]:
        """Names of the band's arrays; empty: there is none."""
        return ("", "") if self.band is None else (f"{self.name}_low", f"{self.name}_high")

    @property
    def arrays(self) -> dict[str, Array]:
        """Its samples by name."""
        rows = {self.name: self.values}
        if self.reference is not None and self.reference_time is not None:
            rows |= {self.dashed: self.reference, f"{self.dashed}_time": self.reference_time}
        if self.compared is not None:
            rows[self.dotted] = self.compared
        if self.band is not None:
            rows |= dict(zip(self.band_names, self.band, strict=True))
        return rows


def of_gait(
    robot: Robot, gait: Gait, reference: Gait | None = None, torques: Torques | None = None
) -> tuple[Tab, ...]:
    """Angles, velocities and (when given) torques of a walk, in the clinical order of `JOINTS`.

    Args:
        robot: Its limits are drawn. Joints that it locks stand still and have none.
        gait: The walk that is shown.
        reference: The walk of the dashed curves.
        torques: On the walk's own clock.

    Raises:
        GaitError: The torques belong to another time.
    """
    if not set(JOINTS) <= set(robot.joints):
        gait = robot.to_gait(robot.from_gait(gait), gait)
    joints = robot.joints
    lower = in_joint_order(joints, robot.lower, missing=-np.inf)
    upper, speed, effort = (
        in_joint_order(joints, limits, missing=np.inf)
        for limits in (robot.upper, robot.velocity, robot.effort)
    )
    angles, speeds, time = None, None, None
    if reference is not None:
        angles, speeds, time = reference.q, reference.dq, reference.time - reference.time[0]
    tabs = (
        Tab("Angles", "angles", JOINTS, gait.q, lower, upper, DEGREES, angles, time),
        Tab("Velocities", "speeds", JOINTS, gait.dq, -speed, speed, _DEGREES_PER_SECOND, speeds, time),
    )
    if torques is None:
        return tabs
    known = [JOINTS.index(joint) for joint in torques.joints]
    tau, limit = torques.at(gait.time)[:, known], effort[known]
    return (*tabs, Tab("Torques", "torques", torques.joints, tau, -limit, limit, NEWTON_METRES))


def of_robot(robot: Robot, time: Array, q: Array, joints: Sequence[str] | None = None) -> tuple[Tab, ...]:
    """Angles and velocities of any robot, under its joints' own names.

    Args:
        robot: Its joints and limits are drawn.
        time: `(n,)` strictly increasing [s].
        q: `(n, nq)` configurations.
        joints: Which of its joints; all revolute ones if left out (prismatic ones are never drawn).

    Raises:
        UnknownNameError: The robot has no such joint.
    """
    names = [name for name in joints or robot.joints if _is_revolute(robot, name)]
    own = [robot.column(name) + len(robot.joints) - robot.nq for name in names]
    angles = robot.angles(q)[:, own]
    speeds, speed = time_series.derivative(time, angles, 1, None), robot.velocity[own]
    lower, upper = robot.lower[own], robot.upper[own]
    return (
        Tab("Angles", "angles", tuple(names), angles, lower, upper, DEGREES),
        Tab("Velocities", "speeds", tuple(names), speeds, -speed, speed, _DEGREES_PER_SECOND),
    )


def with_second_walk(tabs: Iterable[Tab], second: Iterable[Tab]) -> tuple[Tab, ...]:
    """Tabs with the curves of a second walk dotted in those that both have."""
    values = {tab.name: tab.values for tab in second}
    return tuple(replace(tab, compared=values.get(tab.name)) for tab in tabs)


def groups(tabs: Iterable[Tab]) -> tuple[PlotGroup, ...]:
    """The tabs as the page reads them: one plot for left and right of a joint."""
    return tuple(
        PlotGroup(tab.title, tab.name, tab.dashed, tab.dotted, _plots(tab), tab.dashes, *tab.band_names)
        for tab in tabs
    )


def arrays(tabs: Iterable[Tab]) -> dict[str, Array]:
    """The samples of all tabs by name."""
    return {name: rows for tab in tabs for name, rows in tab.arrays.items()}


def notes(torques: Torques | None) -> list[str]:
    """Where the torques come from and what their sign means."""
    if torques is None:
        return []
    source = f" ({torques.source})" if torques.source else ""
    return [
        f"Torques{source}: positive drives the joint the way its name says; the limits are the actuators'."
    ]


def pairs(joints: Sequence[str]) -> dict[str, dict[PlotSide, int]]:
    """Movement -> side -> column: joints whose names differ in the side alone belong together.

    A joint of neither side has the side `"middle"`. The sagittal plane comes first, then the given order.
    """
    found: dict[str, dict[PlotSide, int]] = {}
    for column, joint in enumerate(joints):
        match = _SIDE.search(joint)
        side = "middle" if match is None else _SIDES[match[0][0].lower()]
        movement = joint if match is None else (joint[: match.start()] + joint[match.end() :]).strip("_")
        found.setdefault(movement.replace("__", "_"), {})[side] = column
    return {name: found[name] for name in (*_FIRST, *found) if name in found}


def _is_revolute(robot: Robot, joint: str) -> bool:
    """Whether a joint's motion subspace (linear part first) has an angular part."""
    robot.column(joint)  # refuses an unknown one
    subspace = robot.model.joints[robot.model.getJointId(joint)].createData().S
    return bool(np.any(subspace[3:]))


def _plots(tab: Tab) -> tuple[Plot, ...]:
    plots = []
    lower, upper = (np.clip(limit, -_NO_LIMIT, _NO_LIMIT).tolist() for limit in (tab.lower, tab.upper))
    for movement, sides in pairs(tab.joints).items():
        title = movement.removesuffix("_joint").replace("_", " ")
        sign = tab.signs.get(movement, title.rpartition(" ")[2] if movement in MOVEMENTS else "")
        series = tuple(Series(side, k, lower[k], upper[k]) for side, k in sides.items())
        unit = tab.units.get(movement, tab.unit)
        shown = unit.factor, unit.name, unit.digits, unit.least
        plots.append(Plot(title[:1].upper() + title[1:], series, *shown, sign))
    return tuple(plots)

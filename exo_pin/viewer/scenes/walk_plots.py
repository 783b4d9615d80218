"""Curves of a whole walk beside its joints' angles: pelvis, forces, torques, power, motors' load, error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from exo_pin.anatomy import JOINTS, MOVEMENTS
from exo_pin.arrays import Array
from exo_pin.ground import PlacedWalk
from exo_pin.robot import Robot
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.viewer.scenes.joint_plots import DEGREES, NEWTON_METRES, Tab, Unit, pairs
from exo_pin.viewer.scenes.kinetics import Kinetics

_NEWTONS = Unit("N", 1.0, 0, 100.0)
_WATTS = Unit("W", 1.0, 0, 20.0)
_MILLIMETRES = Unit("mm", 1e3, 0, 20.0)
_TURNS = ("forward", "left side up", "left side forward")  # what positive angles of the pelvis mean
_WAYS = ((2, "height", ""), (1, "sideways", "to the left"), (0, "fore_and_aft", "forward"))
_PERCENT = Unit("%", 100.0, 0, 20.0)


def pelvis(walk: PlacedWalk) -> Tab:
    """Attitude of the pelvis, and its place and that of the centre of mass about their means.

    Args:
        walk: The walk on its ground, heading along x.
    """
    columns = _attitude(walk.base[:, :3, :3])
    units, signs = dict.fromkeys(columns, DEGREES), dict(zip(columns, _TURNS, strict=True))
    paths = {"pelvis": walk.base[:, :3, 3]} | ({} if walk.com is None else {"centre_of_mass": walk.com})
    for name, path in paths.items():
        for axis, way, sign in _WAYS:
            if not (walk.support.overground and axis == 0):  # a walk through the room would be a ramp
                column = f"{name}_{way}"
                columns[column] = path[:, axis] - path[:, axis].mean()
                units[column], signs[column] = _MILLIMETRES, sign
    return _tab("Pelvis", "pelvis", columns, units, signs)


def of_kinetics(robot: Robot, kinetics: Kinetics) -> tuple[Tab, ...]:
    """Forces, torques and power; of a simulated walk load and error as well.

    Args:
        robot: Its limits of torque are drawn.
        kinetics: On the samples of the walk.
    """
    forces, effort = kinetics.loads(), kinetics.effort
    limit = in_joint_order(robot.joints, robot.effort, missing=np.inf)
    sides = {name.removeprefix("left_"): "to the left" for name in forces if "sideways" in name}
    loads = _tab("Forces", "forces", forces, dict.fromkeys(forces, _NEWTONS), sides)
    torques = _joints("Torques", "torques", kinetics.torque, NEWTON_METRES, limit)
    power = _joints("Power", "power", kinetics.power, _WATTS, signs=dict.fromkeys(MOVEMENTS, "gives"))
    if effort is None:
        return loads, torques, power
    if effort.person.any():
        start = kinetics.time - kinetics.time[0]
        torques = replace(
            torques, reference=effort.person, reference_time=start, dashes="torque of the person"
        )
    error = _joints("Error", "error", effort.error, DEGREES._replace(digits=2, least=2.0))
    load = _joints("Load", "load", effort.load, _PERCENT, np.ones(len(JOINTS)), dict.fromkeys(MOVEMENTS, ""))
    return loads, torques, load, power, error


def notes(kinetics: Kinetics | None) -> list[str]:
    """Where forces, torques and powers come from, and what their signs mean."""
    if kinetics is None:
        return []
    words = f"Forces and torques: {kinetics.source}. A torque is positive the way its joint is named, "
    words += "a power where the joint gives energy. "
    if kinetics.origin == "planned":
        words += "The ground reaction is planned with the walk: it was not measured."
    if kinetics.origin == "predicted":
        words += "The ground reaction is predicted from the motion, an assumption: it was not measured."
    if kinetics.origin == "measured":
        words += "Where a foot stands on no plate, forces and torques are not known and not drawn."
    return [words.strip()]


def _tab(
    title: str, name: str, columns: Mapping[str, Array], units: Mapping[str, Unit], signs: Mapping[str, str]
) -> Tab:
    """A tab of columns by name, each with a unit of its own, without limits."""
    names, none = tuple(columns), np.full(len(columns), np.inf)
    of_movement = {movement: units[names[next(iter(of.values()))]] for movement, of in pairs(names).items()}
    values = np.stack(list(columns.values()), axis=1)
    first = units[names[0]]
    return Tab(title, name, names, values, -none, none, first, units=of_movement, signs=signs)


def _joints(
    title: str,
    name: str,
    values: Array,
    unit: Unit,
    limit: Array | None = None,
    signs: Mapping[str, str] | None = None,
) -> Tab:
    """A tab of the joints whose values are known somewhere, with limits `(12,)` of their size."""
    known = [k for k in range(len(JOINTS)) if np.isfinite(values[:, k]).any()]
    most = (np.full(len(JOINTS), np.inf) if limit is None else limit)[known]
    names = tuple(JOINTS[k] for k in known)
    return Tab(title, name, names, values[:, known], -most, most, unit, signs=signs or {})


def _attitude(R: Array) -> dict[str, Array]:
    """Angles of pelvises `(n, 3, 3)` [rad]: forward about y, left side up about x, left forward about -z.

    As in `exo_pin.gait.normative_gait`, whose pelvis is R_y(tilt) R_x(obliquity) R_z(-rotation).
    """
    return {
        "pelvis_tilt": np.arctan2(R[:, 0, 2], R[:, 2, 2]),
        "pelvis_obliquity": np.arcsin(np.clip(-R[:, 1, 2], -1.0, 1.0)),
        "pelvis_rotation": -np.arctan2(R[:, 1, 0], R[:, 1, 1]),
    }

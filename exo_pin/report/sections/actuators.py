"""Velocities, accelerations and (when given) torques against what the actuators have."""

from __future__ import annotations

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.feasible import ACCELERATION
from exo_pin.gait import Gait, Torques
from exo_pin.kinematics import JointRates
from exo_pin.report.document.blocks import Block, Figure, Paragraph, Section, Table
from exo_pin.report.draw import walk_charts
from exo_pin.robot import Robot


def rates(robot: Robot, gait: Gait, found: JointRates) -> Section:
    """Charts and peaks of velocity and acceleration."""
    rows = []
    for k, name in enumerate(robot.joints):
        if name not in JOINTS:  # a slide or a toe, which the walk knows nothing of
            continue
        speed, change = (float(np.abs(x[:, k]).max()) for x in (found.dq, found.ddq))
        has = float(robot.velocity[k])
        numbers = (f"{speed:.2f}", f"{np.degrees(speed):.0f}", f"{has:.2f}", f"{100 * speed / has:.0f}")
        rows.append(
            [name, *numbers, f"{change:.1f}", f"{ACCELERATION:g}", f"{100 * change / ACCELERATION:.0f}"]
        )
    columns = (
        "joint",
        "peak speed rad/s",
        "deg/s",
        "actuator rad/s",
        "used %",
        "peak acceleration rad/s²",
        "limit rad/s²",
        "used %",
    )
    note = (
        f"{found.how} Speeds are limited by the actuators; {ACCELERATION:g} rad/s² for every joint is a "
        "design choice of exo_pin, since no source gives an acceleration for these devices."
    )
    names = robot.joints
    speeds = dict(zip(names, robot.velocity.tolist(), strict=True))
    hardest = dict.fromkeys(names, ACCELERATION)
    blocks: tuple[Block, ...] = (
        Figure(
            walk_charts.by_movement(
                gait, found.dq, names, "velocity", "rad/s", limits=speeds, limit="actuator"
            )
        ),
        Figure(
            walk_charts.by_movement(
                gait, found.ddq, names, "acceleration", "rad/s²", limits=hardest, limit="limit"
            )
        ),
        Table(columns, rows, "Peak rates against the actuators"),
        Paragraph(note, "note"),
    )
    return Section("Velocities and accelerations", blocks)


def torques(robot: Robot, gait: Gait, given: Torques) -> Section:
    """Charts and peaks of the given torques; nothing is computed from the walk.

    Raises:
        GaitError: The torques belong to another time.
    """
    names = given.joints
    tau = given.at(gait.time)[:, [JOINTS.index(name) for name in names]]
    effort = dict(zip(robot.joints, robot.effort.tolist(), strict=True))
    mass = robot.body.mass if robot.body is not None else np.nan
    rows = [
        _peaks(name, column, effort.get(name, np.nan), mass)
        for name, column in zip(names, tau.T, strict=True)
    ]
    columns = (
        "joint",
        "lowest N m",
        "highest N m",
        "peak N m/kg",
        "actuator N m",
        "used %",
        "samples beyond",
    )
    inside = int(np.isfinite(tau).any(axis=1).sum())
    note = (
        f"Given, not computed here: {given.source or 'source not stated'}; {inside} of {len(gait)} samples "
        "have torques, linear between those of the file. Positive drives the joint the way its name says "
        "(muscles' or motors' torque). Per kg of the person. Used: by an actuator that does it alone."
    )
    charts = walk_charts.by_movement(
        gait, tau, names, "torque", "N m", limits=effort, limit="actuator", least=10.0
    )
    table = Table(columns, rows, "Torques against the actuators")
    return Section("Torques", (Figure(charts), table, Paragraph(note, "note")))


def _peaks(name: str, tau: np.ndarray, has: float, mass: float) -> list[str]:
    seen = tau[np.isfinite(tau)]
    most = float(np.abs(seen).max())
    beyond = int((np.abs(seen) > has).sum())
    limit = (
        ("-", "-", "-")
        if np.isnan(has)
        else (f"{has:.0f}", f"{100 * most / has:.0f}", str(beyond) if beyond else "-")
    )
    return [name, f"{seen.min():.1f}", f"{seen.max():.1f}", f"{most / mass:.2f}", *limit]

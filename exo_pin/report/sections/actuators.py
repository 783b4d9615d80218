"""Velocities, accelerations and (where given) torques against the limits of the actuators."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.demand import ACCELERATION_LIMIT, PeakDemand, peak_demands
from exo_pin.gait import Gait, Torques
from exo_pin.kinematics import JointRates
from exo_pin.report.document.blocks import Block, Figure, Paragraph, Section, Table
from exo_pin.report.draw import walk_charts
from exo_pin.robot import Robot


def rates(robot: Robot, gait: Gait, found: JointRates) -> Section:
    """Charts and peaks of velocity and acceleration.

    Args:
        robot: The device on a body.
        gait: The walk.
        found: Velocities and accelerations of its joints.
    """
    names = robot.joints
    speeds = peak_demands(names, found.dq, robot.velocity)
    accelerations = peak_demands(names, found.ddq, ACCELERATION_LIMIT)
    rows = [
        [name, *_speed(speeds[name]), *_acceleration(accelerations[name])]
        for name in names
        if name in JOINTS  # the gait has neither prismatic joints nor toes
    ]
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
        f"{found.how} Speeds are limited by the actuators; {ACCELERATION_LIMIT:g} rad/s² for every joint is "
        "a design choice of exo_pin, since no source gives an acceleration for these devices."
    )
    speed_limits, acceleration_limits = _limits(speeds), _limits(accelerations)
    blocks: tuple[Block, ...] = (
        Figure(
            walk_charts.by_movement(
                gait, found.dq, names, "velocity", "rad/s", limits=speed_limits, limit="actuator"
            ),
            screen=True,
        ),
        Figure(
            walk_charts.by_movement(
                gait, found.ddq, names, "acceleration", "rad/s²", limits=acceleration_limits, limit="limit"
            ),
            screen=True,
        ),
        Table(columns, rows, "Peak rates against the actuators"),
        Paragraph(note, "note"),
    )
    return Section("Velocities and accelerations", blocks)


def torques(robot: Robot, gait: Gait, given: Torques) -> Section:
    """Charts and peaks of torques, with their source.

    Args:
        robot: The device on a body.
        gait: The walk.
        given: Its joint torques.

    Raises:
        GaitError: The torques belong to another time.
    """
    names = given.joints
    tau = given.at(gait.time)[:, [JOINTS.index(name) for name in names]]
    effort = dict(zip(robot.joints, robot.effort.tolist(), strict=True))
    demands = peak_demands(names, tau, [effort.get(name, math.inf) for name in names])
    mass = robot.body.mass if robot.body is not None else math.nan
    rows = [
        [name, *_torque(demand, mass), *(_effort(demand) if name in effort else ("-", "-", "-"))]
        for name, demand in demands.items()
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
        f"Source: {given.source or 'not stated'}; {inside} of {len(gait)} samples have torques, "
        "linear between the source's. Positive drives the joint the way its name says "
        "(muscles' or motors' torque). Per kg of the person. Used: by an actuator that does it alone."
    )
    charts = walk_charts.by_movement(
        gait, tau, names, "torque", "N m", limits=effort, limit="actuator", least=10.0
    )
    table = Table(columns, rows, "Torques against the actuators")
    return Section("Torques", (Figure(charts), table, Paragraph(note, "note")))


def _limits(demands: Mapping[str, PeakDemand]) -> dict[str, float]:
    return {joint: demand.available for joint, demand in demands.items()}


def _speed(demand: PeakDemand) -> tuple[str, ...]:
    """Peak [rad/s] and [deg/s], limit [rad/s], and share of it [%]."""
    peak, limit = demand.peak, demand.available
    return f"{peak:.2f}", f"{np.degrees(peak):.0f}", f"{limit:.2f}", f"{100 * demand.use:.0f}"


def _acceleration(demand: PeakDemand) -> tuple[str, ...]:
    """Peak and limit [rad/s^2], and share of it [%]."""
    return f"{demand.peak:.1f}", f"{demand.available:g}", f"{100 * demand.use:.0f}"


def _torque(demand: PeakDemand, mass: float) -> tuple[str, ...]:
    """Lowest and highest torque [N m], and the peak over the person's mass [N m/kg]."""
    known = demand.required[np.isfinite(demand.required)]
    return f"{known.min():.1f}", f"{known.max():.1f}", f"{demand.peak / mass:.2f}"


def _effort(demand: PeakDemand) -> tuple[str, ...]:
    """Effort limit [N m], share of it [%], and number of samples beyond it."""
    return f"{demand.available:.0f}", f"{100 * demand.use:.0f}", str(int(demand.exceeded.sum()) or "-")

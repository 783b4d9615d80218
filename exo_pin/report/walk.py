"""One walk on one device, for an engineer or a clinician: every number with its unit, every choice stated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from exo_pin import crosscheck
from exo_pin.anatomy import CORNERS, JOINTS, MOVEMENTS, joint
from exo_pin.gait import Gait
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.report import checks, facts, panels, skeleton
from exo_pin.report.blocks import Block, Document, Figure, Player, Section, Table, Tiles, Words
from exo_pin.report.cycle import legs
from exo_pin.report.motion import Motion, motion
from exo_pin.robot import Robot


@dataclass(frozen=True, kw_only=True)
class About:
    """What the report says about its making; any characters.

    Attributes:
        title: Heading.
        who: Whose walk, or who made the report.
        what: The file or the walk's name.
        when: The moment of the run.
        choices: What was chosen, by name, e.g. the preset of a file.
    """

    title: str = "Gait report"
    who: str = ""
    what: str = ""
    when: str = ""
    choices: Mapping[str, str] = field(default_factory=dict)


def walk(
    robot: Robot,
    gait: Gait,
    *,
    about: About | None = None,
    player: str = "",
    normal: str | None = "free",
    cutoff: float | None = 6.0,
) -> Document:
    """The report of a walk.

    Args:
        robot: The device on a body.
        gait: The walk, with its events (without them there is no cycle and no contact).
        about: Who, what, when.
        player: A whole HTML page to embed; empty: none.
        normal: Speed of the normative band behind the joint curves; None: no band.
        cutoff: Low-pass of velocities and accelerations of recordings [Hz]; None: no filter. Periodic walks
            are differentiated by their Fourier series and never filtered.

    Raises:
        DescriptionError: The robot was not made for a body.
    """
    about = about or About()
    verdict = crosscheck.check(robot, gait)
    rates = motion(robot, gait, cutoff)
    sections = [
        _summary(gait, about, verdict),
        facts.body(robot),
        facts.device(robot),
        *([_played(player, about.title)] if player else []),
        _curves(robot, gait, normal),
        _ranges(robot, gait),
        _rates(robot, gait, rates),
        _feet(robot, gait),
        _mass(robot, gait),
        facts.contact(gait),
        facts.numbers(robot, gait),
        checks.inverse(gait, verdict),
        checks.agreement(verdict),
        facts.choices(robot, gait, about.choices, rates.how, normal),
    ]
    under = [f"{name}: {words}" for name, words in (("walk", about.what), ("who", about.who)) if words]
    return Document(about.title, "; ".join([*under, *([about.when] if about.when else [])]), tuple(sections))


def _summary(gait: Gait, about: About, verdict: crosscheck.Check) -> Section:
    ik = verdict.facts()["ik"]
    outside = [name for name, (_, _, frames) in verdict.limits.items() if frames]
    tiles = (
        ("verdict of all checks", "all is well" if verdict.ok else "no: see below", verdict.ok),
        ("joints outside their limits", str(len(outside)), not outside),
        ("frames whose feet were reached", f"{ik['converged']} of {ik['frames']}", verdict.ik_ok),
        ("largest disagreement of four models", f"{max(verdict.fk.values()):.0e}", verdict.fk_ok),
        ("length of the walk", f"{gait.duration:.3f} s", None),
        ("samples", str(len(gait)), None),
    )
    words = f"{about.what or 'The walk'}: {gait.source or 'source not stated'}."
    kind = "One cycle that repeats." if gait.periodic else "A recording that does not repeat."
    return Section("Summary", (Tiles(tiles), Words(f"{words} {kind}")))


def _played(player: str, title: str) -> Section:
    words = "Drag to turn, space to play; it works without a network."
    return Section("The walk", (Player(player, f"Player: {title}"), Words(words, "note screen")))


def _curves(robot: Robot, gait: Gait, normal: str | None) -> Section:
    found = legs(gait)
    if not found:
        words = (
            "The walk has no heel strikes of both feet, so it cannot be placed in a gait cycle: no curves."
        )
        return Section("Joint angles over the gait cycle", (Words(words),))
    limits = {
        movement: (float(robot.lower[k]), float(robot.upper[k]))
        for movement in MOVEMENTS
        if (name := joint("left", movement)) in robot.joints
        for k in [robot.joints.index(name)]
    }
    drawings = panels.joints(found, speed=normal, limits=limits)
    band = "" if normal is None else " Grey band: " + panels.BAND_SOURCE.format(speed=normal)
    caption = "; ".join(leg.note for leg in found) + ". Angles of the walk as given, not filtered." + band
    return Section("Joint angles over the gait cycle", (Figure(drawings, caption),))


def _ranges(robot: Robot, gait: Gait) -> Section:
    rows, bars = [], []
    for k, (name, (low, high, frames)) in enumerate(crosscheck.limits(robot, gait).items()):
        if name not in JOINTS:  # a slide or a toe, which the walk knows nothing of
            continue
        a, b, lower, upper = np.degrees([low, high, robot.lower[k], robot.upper[k]])
        bars.append((name, a, b, lower, upper))
        margin = min(a - lower, upper - b)
        numbers = [f"{round(x, 1) + 0.0:.1f}" for x in (a, b, b - a, lower, upper, margin)]
        rows.append([name, *numbers, str(frames) if frames else "-"])
    columns = (
        "joint",
        "min deg",
        "max deg",
        "range deg",
        "lower limit",
        "upper limit",
        "margin deg",
        "frames outside",
    )
    blocks: tuple[Block, ...] = (
        Figure((panels.range_bars(bars),), columns=1),
        Table(columns, rows, "Ranges and limits [deg]; margin: to the nearer limit, negative outside"),
    )
    return Section("Ranges and limit margins", blocks)


def _rates(robot: Robot, gait: Gait, rates: Motion) -> Section:
    rows = []
    for k, name in enumerate(robot.joints):
        if name not in JOINTS:
            continue
        speed, change = (float(np.abs(x[:, k]).max()) for x in (rates.dq, rates.ddq))
        has = float(robot.velocity[k])
        rows.append(
            [
                name,
                f"{speed:.2f}",
                f"{np.degrees(speed):.0f}",
                f"{has:.2f}",
                f"{100 * speed / has:.0f}",
                f"{change:.1f}",
                f"{robot.effort[k]:.0f}",
            ]
        )
    columns = (
        "joint",
        "peak speed rad/s",
        "deg/s",
        "actuator rad/s",
        "used %",
        "peak acceleration rad/s^2",
        "actuator N m",
    )
    note = (
        f"{rates.how} The torque is what the actuator has; what the walk needs is not computed here, and the "
        "model gives no limit of acceleration."
    )
    names = robot.joints
    blocks: tuple[Block, ...] = (
        Figure(panels.rates(gait, rates.dq, names, "velocity", "rad/s")),
        Figure(panels.rates(gait, rates.ddq, names, "acceleration", "rad/s²")),
        Table(columns, rows, "Peak rates against the actuators"),
        Words(note, "note"),
    )
    return Section("Velocities and accelerations", blocks)


def _feet(robot: Robot, gait: Gait) -> Section:
    base = robot.base_of(gait)
    corners = poses(robot, robot.from_gait(gait), CORNERS, base=base)[..., :3, 3]
    drawings = panels.foot_paths(gait, corners)
    placed = "where its file puts it" if gait.base is not None else "still, as the support holds it"
    stick, note = skeleton.poses_chart(robot, gait)
    caption = (
        f"Heel and ball: midway between the sole's corners. World frame, the pelvis {placed}; heights count "
        "from the world's ground, where soles of a body of another size need not end."
    )
    return Section(
        "Paths of the feet", (Figure(drawings, caption, columns=2), Figure((stick,), note, columns=1))
    )


def _mass(robot: Robot, gait: Gait) -> Section:
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
    return Section("Centre of mass", (Figure(panels.centre_of_mass(gait, position), caption), table))

"""The scene compiler: the exoskeleton's walk or another robot's becomes a `Scene`, which the page shows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import degrees, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.arrays import Array
from exo_pin.gait import Gait, Torques, side_with_more_strides, walk_estimate
from exo_pin.gait.heading import heading, turned
from exo_pin.ground import PlacedWalk
from exo_pin.retarget import Retargeted
from exo_pin.robot import Robot
from exo_pin.viewer.scenes import joint_plots, props
from exo_pin.viewer.scenes.actor import GHOST, Actor
from exo_pin.viewer.scenes.decimation import decimated
from exo_pin.viewer.scenes.exoskeleton import stage_exoskeleton
from exo_pin.viewer.scenes.humanoid import stage_robot
from exo_pin.viewer.scenes.kinetics import Kinetics
from exo_pin.viewer.scenes.leg_phases import cycles_of
from exo_pin.viewer.scenes.scene import ROOT, Beside, Facts, Group, Marks, PhaseCycles, Scene
from exo_pin.viewer.scenes.staging import SceneOptions, Staging
from exo_pin.viewer.scenes.world import ASIDE, SECOND, boxes, world

_ASKEW = radians(15)
"""A walk that heads less far from x than this is left as recorded: the cameras still show its sides."""


def exoskeleton_scene(
    robot: Robot,
    gait: Gait,
    options: SceneOptions | None = None,
    *,
    reference: Gait | None = None,
    reference_title: str = "source",
    torques: Torques | None = None,
    kinetics: Kinetics | None = None,
    wearer: bool = True,
) -> Scene:
    """The exoskeleton's walk as a scene.

    Args:
        robot: The exoskeleton, any device, with the frames of `FEET`.
        gait: The walk.
        options: Title, support, second walk, notes and speed.
        reference: Curves to draw dashed beside the walk's, e.g. the source's.
        reference_title: What the dashed curves are.
        torques: Joint torques on the walk's clock, for a further tab of plots.
        kinetics: Forces, torques and powers on the walk's clock, in its world: arrows, arcs and more tabs.
        wearer: Whether to draw the person, if the robot was made for one and the figure is installed.

    Raises:
        UnknownNameError: The robot lacks a joint or frame of a walker, or there is no such support.
        GaitError: The torques belong to another time, the forces to another clock.
    """
    options = options or SceneOptions(title="12-DoF exoskeleton gait")
    shorter = decimated(gait)
    if kinetics is not None:
        kinetics = kinetics.on(gait.time).at(shorter.rows)
    recorded = shorter.gait
    gait, faced = _facing(recorded)
    if kinetics is not None:
        kinetics = kinetics.turned(_rotation(recorded, gait)[:3, :3])
    if reference is not None:
        reference = decimated(reference).gait
    faced += [shorter.note] if shorter.note else []
    staging = stage_exoskeleton(
        robot,
        gait,
        options,
        reference=reference,
        reference_title=reference_title,
        torques=torques,
        kinetics=kinetics,
        wearer=wearer,
    )
    return _compiled(staging, options, faced)


def robot_scene(walk: Retargeted, options: SceneOptions | None = None) -> Scene:
    """A walk on another robot as a scene.

    The robot has its own meshes, thinned, where its package has them. The curves are its leg joints' own;
    the dashed ones copy the person's angles joint by joint.

    Args:
        walk: The retargeted walk.
        options: Title (the robot's own if empty), support, second walk, notes and speed.

    Raises:
        UnknownNameError: There is no such support.
    """
    options = options or SceneOptions()
    gait, faced = _facing(walk.gait)
    if faced:
        walk = replace(walk, gait=gait, base=_rotation(walk.gait, gait) @ walk.base)
    staging = stage_robot(walk, options)
    title = options.title or f"{walk.target.title or walk.target.name} gait"
    return _compiled(staging, replace(options, title=title), faced)


def phase_cycles(gait: Gait) -> PhaseCycles:
    """The gait cycles in which the page counts phase: those of the foot that has more, left if equal.

    A periodic walk is one cycle, seen around its end; without heel strikes it begins at its first sample.
    Spans of a recording that are no strides (a pause, a turn) are no cycles. A recording without a whole one
    has those of an estimated stride (`exo_pin.gait.half_strides`).
    """
    side = side_with_more_strides(gait)
    found = cycles_of(gait, side)
    if gait.periodic and not found:
        return PhaseCycles("", ((0.0, gait.duration),))
    estimate = None if found else walk_estimate(gait)
    if estimate is None:
        return PhaseCycles(side if found else "", found)
    start, end = float(gait.time[0]), float(gait.time[-1])
    spans = tuple((a - start, b - start) for a, b in estimate.cycles(start, end))
    return PhaseCycles(estimate.side, spans, str(estimate))


def _facing(gait: Gait) -> tuple[Gait, list[str]]:
    """The walk turned to where the cameras' left and front are, if its laboratory's axes are others."""
    angle = heading(gait)
    if angle is None or abs(angle) < _ASKEW:
        return gait, []
    how = f"Turned about the vertical by {-degrees(angle):.0f} degrees, so that it goes along the room's x."
    return turned(gait, -angle), [how]


def _rotation(gait: Gait, faced: Gait) -> Array:
    """The rotation (4, 4) that a walk was turned by."""
    T = np.eye(4)
    if gait.base is not None and faced.base is not None:
        T[:3, :3] = faced.base[0, :3, :3] @ gait.base[0, :3, :3].T
    return T


def _compiled(staging: Staging, options: SceneOptions, faced: Iterable[str]) -> Scene:
    """The scene of a staging: the world around it, and the page's header."""
    gait, walk, actors = staging.gait, staging.walk, staging.actors
    forces, stand = staging.forces, staging.stand
    drawings, marks = world(gait, walk, staging.mounts, ghost=options.compare is not None)
    cycles = phase_cycles(gait)
    phase = [f"The phase is an estimate: {cycles.estimate}."] if cycles.estimate else []
    said = (*gait.remarks, *options.notes, *_source(gait), *phase)
    notes = (*said, *_support_notes(walk), *faced, *staging.notes)
    facts = Facts(
        title=options.title,
        subtitle=_subtitle(staging),
        notes=tuple(dict.fromkeys(notes)),
        duration=gait.duration,
        start=float(gait.time[0]),
        periodic=gait.periodic,
        cycles=cycles,
        stance=walk.stance,
        contact="contact (estimated)" if walk.estimated else "foot contact",
        reference=staging.reference,
        compared=staging.compared,
        chains=tuple(actor.chain for actor in actors),
        handles=staging.handles,
        plots=joint_plots.groups(staging.tabs),
        groups=(
            *_groups(actors, marks, com=walk.com is not None),
            *(() if stand is None else (stand.group,)),
            *(() if forces is None else forces.groups),
        ),
        marks=marks,
        beside=_beside(walk, options),
        bars=() if stand is None else stand.bars,
        forces=None if forces is None else forces.marks,
        keys=(*staging.keys, *(() if forces is None else forces.keys)),
        boxes=boxes(walk, staging.top) | ({} if stand is None else {"stand": stand.frame}),
        follow=walk.support.overground,
        speed=options.speed,
        twins=tuple(pair for actor in actors for pair in actor.twins),
        painted=tuple(pair for actor in actors for pair in actor.painted),
        paint=GHOST.command(),
        shadowless=tuple(f"{ROOT}/{name}" for name in ("traces", "marks", "floor", "ghost")),
        lights=props.PLAIN_LIGHTS,
    )
    drawings += () if stand is None else stand.commands
    commands = (*drawings, *(command for actor in actors for command in actor.commands))
    curves = joint_plots.arrays(staging.tabs) | ({} if forces is None else dict(forces.arrays))
    return Scene(facts, commands, _arrays(walk, actors, curves), staging.robot)


def _beside(walk: PlacedWalk, options: SceneOptions) -> Beside | None:
    """Where the second walk goes if it is shown beside the first."""
    if options.compare is None:
        return None
    return Beside(("ghost", "ghost_wearer"), ASIDE, "" if walk.support.overground else SECOND, options.beside)


def _subtitle(staging: Staging) -> str:
    """Who walks in what, for how long."""
    robot, gait = staging.robot, staging.gait
    device = "" if robot.device is None else (robot.device.title or robot.device.name).partition(" (")[0]
    body = robot.body
    person = f"{body.stature:.2f} m, {body.mass:.0f} kg" if body is not None and body.wearer else ""
    kind = "cycle" if gait.periodic else "recording"
    return " · ".join(filter(None, (person, device, f"{gait.duration:.2f} s {kind}")))


def _source(gait: Gait) -> list[str]:
    return [gait.source] if gait.source else []


def _support_notes(walk: PlacedWalk) -> list[str]:
    notes = [walk.support.note]
    if walk.estimated:
        notes.append("The gait has no contact events: contact is estimated from the lowest sole corners.")
    return notes


def _groups(actors: Iterable[Actor], marks: Marks, *, com: bool) -> tuple[Group, ...]:
    soles = tuple(path.rsplit("/", 1)[0] for path in marks.contact.values())
    groups = [
        *(actor.group for actor in actors),
        Group("Foot contact", soles),
        Group("Foot paths", (f"{ROOT}/traces",)),
        *([Group("Centre of mass", (f"{ROOT}/marks",))] if com else []),
    ]
    return tuple(groups if marks.belt is None else [*groups, Group("Treadmill", (f"{ROOT}/treadmill",))])


def _arrays(
    walk: PlacedWalk, actors: Iterable[Actor], curves: Mapping[str, Array]
) -> dict[str, NDArray[np.floating[Any]]]:
    arrays = {"time": walk.time, **curves}
    if walk.com is not None:
        arrays["com"] = walk.com
    for actor in actors:
        arrays |= actor.arrays
    return {name: _narrow(name, rows) for name, rows in arrays.items()}


def _narrow(name: str, rows: Array) -> NDArray[np.floating[Any]]:
    """Times stay float64: a long recording counts milliseconds behind thousands of seconds."""
    data: NDArray[np.floating[Any]] = rows.astype(np.float64 if name.endswith("time") else np.float32)
    data.flags.writeable = False
    return data

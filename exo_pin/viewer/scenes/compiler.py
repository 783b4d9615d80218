"""The scene compiler: a robot and a gait become a `Scene`, which any transport can show."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import degrees, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exo_pin.anatomy import FEET
from exo_pin.arrays import Array
from exo_pin.gait import Gait, Torques
from exo_pin.gait.heading import heading, turned
from exo_pin.ground.placement import Placement
from exo_pin.retarget import Retargeted, retarget
from exo_pin.robot import Robot
from exo_pin.viewer.scenes import joint_plots, props
from exo_pin.viewer.scenes.actor import Actor
from exo_pin.viewer.scenes.humanoid import humanoid
from exo_pin.viewer.scenes.phase_cycles import cycles
from exo_pin.viewer.scenes.play import Play
from exo_pin.viewer.scenes.scene import Facts, Group, Marks, Scene
from exo_pin.viewer.scenes.walker import walker
from exo_pin.viewer.scenes.world import ROOT, boxes, world

_ASKEW = radians(15)  # a smaller heading is left as recorded: the cameras forgive it


def scene(
    robot: Robot,
    gait: Gait,
    *,
    reference: Gait | None = None,
    reference_title: str = "source",
    compare: Gait | None = None,
    compare_title: str = "compared",
    torques: Torques | None = None,
    title: str = "12-DoF exoskeleton gait",
    support: str = "carried",
    wearer: bool = True,
    notes: Iterable[str] = (),
    speed: float = 1.0,
) -> Scene:
    """Everything that the viewer shows of a walk, as one value.

    Args:
        robot: The exoskeleton, or any robot with two legs (from `load_urdf`), to which the walk is retargeted
            then; reference, torques and wearer are the exoskeleton's alone, and `retargeted` shows a walk of
            somebody else's than the default body.
        gait: The motion to show, e.g. what inverse kinematics recovered.
        reference: Curves to draw dashed beside it, e.g. the source's.
        reference_title: What the dashed curves are.
        compare: A second walk, shown as a ghost, its curves dotted.
        compare_title: What the ghost is.
        torques: Joint torques on the walk's clock, for a further tab of plots.
        title: Heading of the page.
        support: `"carried"`: the balance support moves the pelvis so that the standing foot stays on the
            ground; `"still"`: it holds the pelvis as in the paper.
        wearer: Whether to draw the person, if the robot was made for one.
        notes: Sentences to print under the plots.
        speed: Playback speed at first; 1 is as it happened.

    Raises:
        UnknownNameError: The robot lacks a joint or frame of a walker, or there is no such support.
        GaitError: The torques belong to another time.
        ExoPinError: The wearer's figure is not installed.
    """
    if not set(FEET) <= set(robot.frames):
        walk = retarget(gait, robot)
        return retargeted(
            walk,
            compare=compare,
            compare_title=compare_title,
            title=title,
            support=support,
            notes=notes,
            speed=speed,
        )
    gait, faced = _facing(gait)
    play = walker(
        robot,
        gait,
        reference=reference,
        reference_title=reference_title,
        compare=compare,
        compare_title=compare_title,
        torques=torques,
        support=support,
        wearer=wearer,
    )
    return _compiled(replace(play, notes=(*faced, *play.notes)), title, notes, speed)


def retargeted(
    walk: Retargeted,
    *,
    compare: Gait | None = None,
    compare_title: str = "compared",
    title: str = "",
    support: str = "carried",
    notes: Iterable[str] = (),
    speed: float = 1.0,
) -> Scene:
    """Everything that the viewer shows of a walk on another robot; arguments as in `scene`.

    The robot wears its own meshes, thinned, where its package has them; the curves are its leg joints' own,
    dashed as the walk's angles ask for them joint by joint.

    Raises:
        UnknownNameError: There is no such support.
    """
    gait, faced = _facing(walk.gait)
    if faced:
        walk = replace(walk, gait=gait, base=_turn(walk.gait, gait) @ walk.base)
    play = humanoid(walk, support, compare, compare_title)
    notes = (*notes, *faced)
    return _compiled(play, title or f"{walk.target.title or walk.target.name} gait", notes, speed)


def _facing(gait: Gait) -> tuple[Gait, list[str]]:
    """The walk turned to where the cameras' left and front are, if its laboratory's axes are others."""
    angle = heading(gait)
    if angle is None or abs(angle) < _ASKEW:
        return gait, []
    how = f"Turned about the vertical by {-degrees(angle):.0f} degrees, so that it goes along the room's x."
    return turned(gait, -angle), [how]


def _turn(gait: Gait, faced: Gait) -> Array:
    """The rotation (4, 4) that a walk was turned by."""
    T = np.eye(4)
    if gait.base is not None and faced.base is not None:
        T[:3, :3] = faced.base[0, :3, :3] @ gait.base[0, :3, :3].T
    return T


def _compiled(play: Play, title: str, notes: Iterable[str], speed: float) -> Scene:
    """The scene of a play: the world around it, and all that the page is told."""
    gait, shown, actors = play.gait, play.shown, play.actors
    drawings, marks = world(gait, shown, play.mounts)
    facts = Facts(
        title=title,
        subtitle=_subtitle(gait),
        notes=tuple(dict.fromkeys((*notes, *_ground(shown), *play.notes))),
        duration=gait.duration,
        start=float(gait.time[0]),
        periodic=gait.periodic,
        cycles=cycles(gait),
        stance=shown.stance,
        contact="contact (estimated)" if shown.estimated else "foot contact",
        reference=play.reference,
        compared=play.compared,
        chains=tuple(actor.chain for actor in actors),
        grips=play.grips,
        plots=joint_plots.groups(play.tabs),
        groups=_groups(actors, marks),
        marks=marks,
        boxes=boxes(shown, play.top),
        follow=shown.support.overground,
        speed=speed,
        twins=tuple(pair for actor in actors for pair in actor.twins),
        shadowless=tuple(f"{ROOT}/{name}" for name in ("traces", "marks", "floor", "ghost")),
        lights=props.PLAIN_LIGHTS,
    )
    commands = (*drawings, *(command for actor in actors for command in actor.commands))
    return Scene(facts, commands, _arrays(shown, actors, joint_plots.arrays(play.tabs)), play.robot)


def _subtitle(gait: Gait) -> str:
    kind = "cycle" if gait.periodic else "recording"
    return ", ".join(filter(None, (gait.source, f"{gait.duration:.2f} s {kind}")))


def _ground(shown: Placement) -> list[str]:
    notes = [shown.support.note]
    if shown.estimated:
        notes.append("The gait has no contact events: contact is estimated from the lowest sole corners.")
    return notes


def _groups(actors: Iterable[Actor], marks: Marks) -> tuple[Group, ...]:
    soles = tuple(path.rsplit("/", 1)[0] for path in marks.contact.values())
    groups = [
        *(actor.group for actor in actors),
        Group("Foot contact", soles),
        Group("Foot paths", (f"{ROOT}/traces",)),
        Group("Centre of mass", (f"{ROOT}/marks",)),
    ]
    return tuple(groups if marks.belt is None else [*groups, Group("Treadmill", (f"{ROOT}/treadmill",))])


def _arrays(
    shown: Placement, actors: Iterable[Actor], lines: dict[str, Array]
) -> dict[str, NDArray[np.floating[Any]]]:
    arrays = {"time": shown.time, "com": shown.com, **lines}
    for actor in actors:
        arrays |= actor.arrays
    return {name: _narrow(name, rows) for name, rows in arrays.items()}


def _narrow(name: str, rows: Array) -> NDArray[np.floating[Any]]:
    """Times stay float64: a long recording counts milliseconds behind thousands of seconds."""
    data: NDArray[np.floating[Any]] = rows.astype(np.float64 if name.endswith("time") else np.float32)
    data.flags.writeable = False
    return data

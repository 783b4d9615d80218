"""The exoskeleton on the stage with its ghost and its wearer: curves of its joints, feet to be dragged."""

from __future__ import annotations

from collections.abc import Iterable

from exo_pin.anatomy import FEET, SIDES
from exo_pin.devices import TOES
from exo_pin.gait import Gait, Torques
from exo_pin.ground.placement import motion
from exo_pin.robot import Robot
from exo_pin.viewer.scenes import joint_plots
from exo_pin.viewer.scenes.actor import Actor, aligned, exoskeleton, ghost, in_step
from exo_pin.viewer.scenes.link_nodes import Linkage, linkage
from exo_pin.viewer.scenes.play import Play
from exo_pin.viewer.scenes.scene import Grip
from exo_pin.viewer.scenes.wearer import wearer as person
from exo_pin.viewer.scenes.world import ROOT, mounts

_BACKPACK = 0.34  # ends this far above the hips [m]


def walker(
    robot: Robot,
    gait: Gait,
    *,
    reference: Gait | None,
    reference_title: str,
    compare: Gait | None,
    compare_title: str,
    torques: Torques | None,
    support: str,
    wearer: bool,
) -> Play:
    """The exoskeleton's walk as it is to be shown; arguments and errors as in `viewer.scene`."""
    shown = motion(robot, gait, support)
    exo = linkage(robot.urdf, f"{ROOT}/exo")
    actors = [exoskeleton(robot, shown, exo)]
    tabs, said = joint_plots.of_gait(robot, gait, reference, torques), []
    if compare is not None:
        second = aligned(gait, compare)
        actors.append(ghost(robot, second, support, f"{ROOT}/ghost", compare_title))
        tabs = joint_plots.beside(tabs, joint_plots.of_gait(robot, second))
        said.append(in_step(gait, compare))
    top = _BACKPACK
    if wearer and robot.body is not None and robot.body.wearer:
        actors.append(person(robot.body, exo.links, f"{ROOT}/wearer", gait, shown.base))
        top = robot.body.stature - robot.body.leg_length
    return Play(
        robot=robot,
        gait=gait,
        shown=shown,
        actors=tuple(actors),
        mounts=mounts(robot, shown, exo),
        grips=tuple(Grip(foot, side) for foot, side in zip(FEET, SIDES, strict=True) if foot in exo.links),
        tabs=tabs,
        reference="" if reference is None else reference_title,
        compared="" if compare is None else compare_title,
        top=top,
        notes=(*said, *_notes(exo, actors), *joint_plots.notes(torques)),
    )


def _notes(exo: Linkage, actors: Iterable[Actor]) -> list[str]:
    notes = []
    if exo.skipped:
        notes.append(f"{exo.skipped} visuals of the URDF are meshes and are not drawn.")
    if any(turn.name in TOES for turn in exo.turns):
        notes.append("A gait has no toe angles: the toes bend as far as the ground demands.")
    if any(actor.chain.name == "wearer" for actor in actors):
        notes.append(
            "The wearer's trunk and arms are illustration; hips, knees and ankles are the exoskeleton's."
        )
    return notes

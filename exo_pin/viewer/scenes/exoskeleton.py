"""The exoskeleton's figures: itself, its ghost and its wearer, with its joint curves and foot handles."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from exo_pin.anatomy import CORNERS, FEET, SIDES, Body
from exo_pin.anatomy.names import Side, SupportStyle
from exo_pin.arrays import Array
from exo_pin.devices import TOES
from exo_pin.gait import Gait, Torques
from exo_pin.ground import PlacedWalk, aligned, alignment_note, place_walk, toe_angles
from exo_pin.robot import Robot
from exo_pin.viewer.scenes import joint_plots, person_figure, walk_plots
from exo_pin.viewer.scenes.actor import Actor, Mount, chain_samples
from exo_pin.viewer.scenes.balance_support import balance_support
from exo_pin.viewer.scenes.children_band import children_band
from exo_pin.viewer.scenes.force_marks import shown_forces
from exo_pin.viewer.scenes.kinetics import Kinetics
from exo_pin.viewer.scenes.link_nodes import Linkage, linkage
from exo_pin.viewer.scenes.scene import ROOT, Chain, Group, Handle, Key
from exo_pin.viewer.scenes.staging import SceneOptions, Staging
from exo_pin.viewer.scenes.wearer import wearer as wearer_figure

_GHOST_COLOR = "#5c4d8c"

_BACKPACK = 0.34
"""The device ends this far above the hips [m]."""


def stage_exoskeleton(
    robot: Robot,
    gait: Gait,
    options: SceneOptions,
    *,
    reference: Gait | None,
    reference_title: str,
    torques: Torques | None,
    kinetics: Kinetics | None,
    wearer: bool,
) -> Staging:
    """The exoskeleton's walk with its figures and curves; errors as in `exoskeleton_scene`.

    Args:
        robot: The exoskeleton, any device.
        gait: The walk, heading along x.
        options: What the scene shows besides.
        reference: Curves to draw dashed, or None.
        reference_title: What the dashed curves are.
        torques: Joint torques on the walk's clock, or None.
        kinetics: Forces, torques and powers in the walk's world and on its samples, or None.
        wearer: Whether to draw the person, if the robot was made for one.
    """
    walk = place_walk(robot, gait, options.support)
    tree = linkage(robot.urdf, f"{ROOT}/exo")
    chain = Chain("exo", tree.root, tree.links, tree.joints, "q", "base")
    samples = chain_samples(chain, _angles(robot, walk, tree), walk.base)
    actors, keys = [Actor(tree.commands, chain, samples, Group("Exoskeleton", tree.visuals))], list[Key]()
    tabs, notes = _tabs(robot, walk, gait, reference, torques, kinetics), []
    second = None if options.compare is None else _second(robot, gait, options.compare, options.support)
    if second is not None:
        actors.append(_ghost(robot, second.walk, tree, options.compare_title))
        tabs = joint_plots.with_second_walk(tabs, _tabs(robot, second.walk, second.gait))
        keys.append(Key(f"ghost: {options.compare_title}", _GHOST_COLOR))
        notes.append(second.note)
    band = children_band(robot, gait)
    if band is not None:
        tabs, notes = tuple(map(band.behind, tabs)), [*notes, band.note]
    top = _BACKPACK
    worn = wearer and robot.body is not None and robot.body.wearer
    if worn and not person_figure.installed():
        notes.append(f"{person_figure.MISSING[0].upper()}{person_figure.MISSING[1:]}.")
    elif worn and robot.body is not None:
        person = wearer_figure(robot.body, tree.links, f"{ROOT}/wearer", gait, walk.base)
        actors.append(person)
        if second is not None and options.beside:
            actors.append(_ghosts_wearer(robot.body, actors, person, second))
        top = robot.body.stature - robot.body.leg_length
    return Staging(
        robot=robot,
        gait=gait,
        walk=walk,
        actors=tuple(actors),
        mounts=tuple(_mount(robot, walk, tree, side) for side in SIDES),
        handles=tuple(
            Handle(foot, side) for foot, side in zip(FEET, SIDES, strict=True) if foot in tree.links
        ),
        tabs=tabs,
        reference="" if reference is None else reference_title,
        compared="" if options.compare is None else options.compare_title,
        top=top,
        notes=(*notes, *_notes(tree, actors), *joint_plots.notes(torques), *walk_plots.notes(kinetics)),
        stand=balance_support(robot, walk, top, unloads=kinetics is not None and kinetics.unloading > 0.0),
        forces=None if kinetics is None else shown_forces(kinetics, walk, tree),
        keys=tuple(keys),
    )


def _tabs(
    robot: Robot,
    walk: PlacedWalk,
    gait: Gait,
    reference: Gait | None = None,
    torques: Torques | None = None,
    kinetics: Kinetics | None = None,
) -> tuple[joint_plots.Tab, ...]:
    """Angles and velocities first, then the pelvis; forces, torques and powers where they are known."""
    angles, speeds, *file = joint_plots.of_gait(robot, gait, reference, torques)
    forces = () if kinetics is None else walk_plots.of_kinetics(robot, kinetics)
    return angles, speeds, walk_plots.pelvis(walk), *file, *forces


@dataclass(frozen=True, eq=False)
class _Second:
    """A second walk on the clock of the first: itself, on its ground, and how it was laid over the first."""

    gait: Gait
    walk: PlacedWalk
    note: str


def _second(robot: Robot, gait: Gait, other: Gait, support: SupportStyle) -> _Second:
    second = aligned(gait, other)
    return _Second(second, place_walk(robot, second, support), alignment_note(gait, other))


def _ghosts_wearer(body: Body, actors: Iterable[Actor], person: Actor, second: _Second) -> Actor:
    """The person in the second walk, where it goes beside the first."""
    (ghost,) = [actor for actor in actors if actor.chain.name == "ghost"]
    links, path = ghost.chain.links, f"{ROOT}/ghost_wearer"
    made = wearer_figure(body, links, path, second.gait, second.walk.base, like=person)
    return replace(made, group=Group("The ghost's wearer", made.group.paths))


def _ghost(robot: Robot, walk: PlacedWalk, tree: Linkage, title: str) -> Actor:
    """A second walk of the same exoskeleton, on the clock of the first: its drawings in another paint."""

    def own(path: str) -> str:
        return f"{ROOT}/ghost{path.removeprefix(tree.root)}"

    links = {name: own(path) for name, path in tree.links.items()}
    joints = tuple(replace(joint, path=own(joint.path)) for joint in tree.joints)
    chain = Chain("ghost", own(tree.root), links, joints, "ghost_q", "ghost_base")
    return Actor(
        commands=tuple(c | {"path": own(c["path"])} for c in tree.commands if c["type"] == "set_transform"),
        chain=chain,
        arrays=chain_samples(chain, _angles(robot, walk, tree), walk.base),
        group=Group(f"Ghost: {title}", tuple(map(own, tree.visuals))),
        painted=tuple((own(c["path"]), c["path"]) for c in tree.commands if c["type"] == "set_object"),
    )


def _angles(robot: Robot, walk: PlacedWalk, tree: Linkage) -> dict[str, Array]:
    """Joint -> `(n,)` angles: the walk's own, and the toes' where the device has some [rad]."""
    angles = dict(zip(robot.joints, walk.q.T, strict=True))
    limits = {joint.name: joint.limits for joint in tree.joints if joint.name in TOES}
    if robot.body is not None and limits:
        for toe, q in toe_angles(robot.body, walk).items():
            _, upper = limits[toe] or (0.0, 0.0)
            angles[toe] = np.minimum(q, upper)
    return angles


def _mount(robot: Robot, walk: PlacedWalk, tree: Linkage, side: Side) -> Mount:
    """The sole of a foot, from its corners as the foot's frame sees them."""
    foot = SIDES.index(side)
    mine = [k for k, name in enumerate(CORNERS) if name.startswith(side)]
    T = walk.feet[0, foot]
    corners = (walk.corners[0, mine] - T[:3, 3]) @ T[:3, :3]  # in the foot's own axes
    heel, front = float(corners[:, 0].min()), float(corners[:, 0].max())
    if robot.body is not None:  # the corners end at the ball of the foot, the plate at the toes
        front = heel + robot.body.leg(side).foot_length
    size = front - heel + 0.007, float(np.ptp(corners[:, 1])) + 0.009
    return Mount(tree.links[FEET[foot]], np.eye(4), size, ((heel + front) / 2, 0.0, 0.006))


def _notes(tree: Linkage, actors: Iterable[Actor]) -> list[str]:
    notes = []
    if tree.skipped:
        notes.append(f"{tree.skipped} visuals of the URDF are meshes and are not drawn.")
    if any(joint.name in TOES for joint in tree.joints):
        notes.append("A gait has no toe angles: the toes bend as far as the ground demands.")
    if any(actor.chain.name == "wearer" for actor in actors):
        notes.append(
            "The wearer's trunk and arms are illustration; hips, knees and ankles are the exoskeleton's."
        )
    return notes

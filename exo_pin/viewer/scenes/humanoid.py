"""Any robot with two legs on the stage: its own meshes, its feet on the ground, its leg joints' curves."""

from __future__ import annotations

import re
from dataclasses import replace
from difflib import SequenceMatcher

import numpy as np

from exo_pin.gait import Gait
from exo_pin.ground.placement import Placement, moved, stood
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.retarget import Biped, Retargeted, retarget
from exo_pin.viewer.drawing_commands import Material
from exo_pin.viewer.meshes.urdf_meshes import Meshes
from exo_pin.viewer.scenes import joint_plots
from exo_pin.viewer.scenes.actor import GHOST, Actor, aligned, in_step, samples
from exo_pin.viewer.scenes.appearance import bare, dressed, highest, plate
from exo_pin.viewer.scenes.link_nodes import Linkage
from exo_pin.viewer.scenes.play import Play
from exo_pin.viewer.scenes.scene import Chain, Grip, Group
from exo_pin.viewer.scenes.soles import Sole, soles
from exo_pin.viewer.scenes.world import ROOT, Mount

HEADROOM = 0.06
"""The picture reaches so far above the robot's highest point [m]."""

DIP = 0.005
"""Tips of feet that are less deep in the ground than this need no words [m]."""


def humanoid(
    result: Retargeted, support: str = "carried", compare: Gait | None = None, compare_title: str = "compared"
) -> Play:
    """A retargeted walk as it is to be shown.

    Args:
        result: The walk on the robot.
        support: How the root is carried, as in `viewer.scene`.
        compare: A second walk, shown as a ghost.
        compare_title: What the ghost is.

    Raises:
        UnknownNameError: There is no such support.
    """
    biped = result.biped
    color = biped.target.paint
    paint = None if color is None else Material(color, 0.6, 0.0)
    tree, meshes = dressed(biped, f"{ROOT}/exo", paint)
    feet = soles(biped, tree.shapes)
    shown = _motion(result, feet, support)
    actors = [_actor(result, shown, tree, feet)]
    tabs, notes = _tabs(result), _notes(result, meshes, tree)
    if compare is not None:
        second = retarget(aligned(result.gait, compare), biped, result.body)
        actors.append(_ghost(second, feet, support, compare_title))
        tabs = joint_plots.beside(tabs, _tabs(second))
        notes.append(in_step(result.gait, compare))
    return Play(
        robot=biped.robot,
        gait=result.gait,
        shown=shown,
        actors=tuple(actors),
        mounts=tuple(_mount(tree, sole) for sole in feet),
        grips=tuple(Grip(leg.foot, leg.side) for leg in biped.legs if leg.reaches_any_pose),
        tabs=tabs,
        reference="joint by joint",
        compared="" if compare is None else compare_title,
        top=highest(biped, tree) + HEADROOM,
        notes=(*notes, *_dips(shown, feet)),
    )


def _motion(result: Retargeted, feet: tuple[Sole, Sole], support: str) -> Placement:
    biped = result.biped
    T = poses(biped.robot, result.q, [sole.link for sole in feet]) @ np.array([sole.T for sole in feet])
    corners = np.tile(np.eye(4), (len(T), 2, 4, 1, 1))
    for k, sole in enumerate(feet):
        corners[:, k, :, :3, 3] = sole.corners @ np.swapaxes(T[:, k, :3, :3], -1, -2) + T[:, k, None, :3, 3]
    seen = np.concatenate([T, corners.reshape(len(T), 8, 4, 4)], axis=1)
    com = center_of_mass(biped.robot, result.q).position
    return stood(result.gait, biped.robot.angles(result.q), result.base, seen, com, support, "The pelvis")


def _actor(result: Retargeted, shown: Placement, tree: Linkage, feet: tuple[Sole, Sole]) -> Actor:
    """The robot; only its legs' joints have sliders."""
    sides = {joint: leg.side for leg in result.biped.legs for joint in leg.joints}
    turns = tuple(
        replace(turn, side=sides[turn.name]) if turn.name in sides else replace(turn, limits=None)
        for turn in tree.turns
    )
    chain = Chain("exo", tree.root, tree.links, turns, "q", "base")
    plates = [sole for sole in feet if sole.link not in tree.shapes and bare(result.biped, sole, tree)]
    commands = (*tree.commands, *(command for sole in plates for command in plate(tree, sole)))
    looks = (*tree.looks, *(f"{tree.links[sole.link]}/plate" for sole in plates))
    title = result.target.title or result.target.name
    return Actor(commands, chain, samples(result.robot, shown, tree, ""), Group(title, looks))


def _ghost(result: Retargeted, feet: tuple[Sole, Sole], support: str, title: str) -> Actor:
    shown = _motion(result, feet, support)
    tree, _ = dressed(result.biped, f"{ROOT}/ghost", GHOST)
    chain = Chain("ghost", tree.root, tree.links, tree.turns, "ghost_q", "ghost_base")
    arrays = samples(result.robot, shown, tree, "ghost_")
    return Actor(tree.commands, chain, arrays, Group(f"Ghost: {title}", tree.looks))


def _mount(tree: Linkage, sole: Sole) -> Mount:
    length, width = sole.size
    x, y = sole.middle
    return Mount(tree.links[sole.link], sole.T, (length + 0.007, width + 0.009), (x, y, 0.006))


def _tabs(result: Retargeted) -> tuple[joint_plots.Tab, ...]:
    """The leg joints' own curves, in the robot's own signs; dashed: joint by joint."""
    time, joints = result.time - result.time[0], result.joints
    labels = _labels(result.biped)
    solved = joint_plots.of_robot(result.robot, time, result.q, joints)
    copied = joint_plots.of_robot(result.robot, time, result.copied, joints)
    return tuple(
        replace(tab, joints=labels, reference=other.values, reference_time=time)
        for tab, other in zip(solved, copied, strict=True)
    )


def _labels(biped: Biped) -> tuple[str, ...]:
    """What the plots call the joints: side, what left and right names share, and what it is in a person."""
    left, right = biped.legs
    shared = [_shared(*pair) for pair in zip(left.joints, right.joints, strict=True)]
    return tuple(
        f"{leg.side}_{name} ({movement.replace('_', ' ')})"
        for leg in (left, right)
        for name, movement in zip(shared, leg.movements, strict=True)
    )


def _shared(left: str, right: str) -> str:
    """`leg_4` of `leg_left_4_joint` and `leg_right_4_joint`: the name without its side."""
    one, other = (re.sub(r"(?i)left|right", "", name).removesuffix("_joint") for name in (left, right))
    blocks = SequenceMatcher(None, one, other, autojunk=False).get_matching_blocks()
    return re.sub(r"[_\W]+", "_", "_".join(one[b.a : b.a + b.size] for b in blocks)).strip("_")


def _notes(result: Retargeted, meshes: Meshes, tree: Linkage) -> list[str]:
    target, biped = result.target, result.biped
    place = 1e3 * result.errors.largest_position
    turn = np.degrees(result.errors.largest_rotation)
    legs = f"{biped.joints_per_leg} joints per leg, hip {biped.hip_order}"
    lean = (
        f"the trunk is upright, the hips take over {np.degrees(result.lean):.1f} degrees of the pelvis's lean"
    )
    notes = [
        f"{target.title or target.name}: {legs}; the feet's paths are {np.mean(result.scale):.2f} times the "
        f"person's, missed by {place:.2f} mm and {turn:.1f} degrees at most; {lean}. "
        "Dashed: the person's angles joint by joint.",
        target.remarks,
        f"Its looks: {target.licence}, thinned." if target.licence and meshes.triangles else "",
    ]
    if tree.skipped:
        name, why = next(iter(meshes.missing.items()), ("a visual", "of no known kind"))
        notes.append(f"{tree.skipped} visuals of the URDF are not drawn ({name}: {why}).")
    return [note for note in notes if note]


def _dips(shown: Placement, feet: tuple[Sole, Sole]) -> list[str]:
    """How deep the tips of rigid feet get below the ground, where a person's toes would bend."""
    low = 0.0
    for k, sole in enumerate(feet):
        tip = np.array([sole.tip, *sole.middle[1:], 0.0])
        low = min(low, float(moved(shown.feet[:, k], tip)[:, 2].min()))
    if low > -DIP:
        return []
    return [
        "The rigid feet have no toes: where a person's would bend, their tips are up to "
        f"{-1e3 * low:.0f} mm below the ground."
    ]

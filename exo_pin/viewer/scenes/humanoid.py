"""Another robot with two legs: its meshes, its feet on the ground, its leg joints' curves."""

from __future__ import annotations

import re
from dataclasses import replace
from difflib import SequenceMatcher
from math import degrees

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import shortened
from exo_pin.ground import PlacedWalk, aligned, alignment_note, place, transformed
from exo_pin.kinematics import center_of_mass, poses
from exo_pin.kinematics.center_of_mass import has_mass
from exo_pin.retarget import Biped, Retargeted, retarget
from exo_pin.viewer.drawing_commands import Material
from exo_pin.viewer.meshes.urdf_meshes import Meshes, ThinnedFiles
from exo_pin.viewer.scenes import joint_plots
from exo_pin.viewer.scenes.actor import GHOST, Actor, Mount, chain_samples
from exo_pin.viewer.scenes.appearance import (
    foot_plate,
    highest_point,
    needs_plate,
    plate_path,
    robot_linkage,
)
from exo_pin.viewer.scenes.link_nodes import Linkage
from exo_pin.viewer.scenes.scene import ROOT, Chain, Group, Handle
from exo_pin.viewer.scenes.soles import Sole, soles
from exo_pin.viewer.scenes.staging import SceneOptions, Staging

_HEADROOM = 0.06
"""The picture reaches so far above the robot's highest point [m]."""

_SHALLOW = 0.005
"""Tips of feet that are less deep in the ground than this are not mentioned [m]."""


def stage_robot(result: Retargeted, options: SceneOptions) -> Staging:
    """A retargeted walk with the robot's figure and curves.

    Args:
        result: The walk on the robot, heading along x.
        options: What the scene shows besides.

    Raises:
        UnknownNameError: There is no such support.
    """
    biped, files = result.biped, ThinnedFiles()
    color = biped.target.paint
    paint = None if color is None else Material(color, 0.6, 0.0)
    tree, meshes = robot_linkage(biped, f"{ROOT}/exo", paint, files)
    feet = soles(biped, tree.shapes)
    walk = _placed(result, feet, options)
    actors = [_actor(result, walk, tree, feet)]
    tabs, notes = _tabs(result), _notes(result, meshes, tree)
    if options.compare is not None:
        second = retarget(aligned(result.gait, options.compare), biped, result.body)
        ghost, _ = robot_linkage(biped, f"{ROOT}/ghost", GHOST, files)
        actors.append(_ghost(second, _placed(second, feet, options), ghost, options.compare_title))
        tabs = joint_plots.with_second_walk(tabs, _tabs(second))
        notes.append(alignment_note(result.gait, options.compare))
    return Staging(
        robot=biped.robot,
        gait=result.gait,
        walk=walk,
        actors=tuple(actors),
        mounts=tuple(_mount(tree, sole) for sole in feet),
        handles=tuple(
            Handle(leg.foot, leg.side)
            for leg in biped.legs
            if leg.reaches_any_pose and biped.robot.leg(leg.foot) is not None  # no waist would move with it
        ),
        tabs=tabs,
        reference="joint by joint",
        compared="" if options.compare is None else options.compare_title,
        top=highest_point(biped, tree) + _HEADROOM,
        notes=(*notes, *_buried_tips(walk, feet)),
    )


def _placed(result: Retargeted, feet: tuple[Sole, Sole], options: SceneOptions) -> PlacedWalk:
    biped = result.biped
    T = poses(biped.robot, result.q, [sole.link for sole in feet]) @ np.array([sole.T for sole in feet])
    corners = np.tile(np.eye(4), (len(T), 2, 4, 1, 1))
    for k, sole in enumerate(feet):
        corners[:, k, :, :3, 3] = sole.corners @ np.swapaxes(T[:, k, :3, :3], -1, -2) + T[:, k, None, :3, 3]
    T_root = np.concatenate([T, corners.reshape(len(T), 8, 4, 4)], axis=1)
    com = center_of_mass(biped.robot, result.q).position if has_mass(biped.robot) else None
    q = biped.robot.angles(result.q)
    return place(result.gait, q, result.base, T_root, com, options.support, "The pelvis")


def _actor(result: Retargeted, walk: PlacedWalk, tree: Linkage, feet: tuple[Sole, Sole]) -> Actor:
    """The robot; only its legs' joints have sliders."""
    sides = {joint: leg.side for leg in result.biped.legs for joint in leg.joints}
    joints = tuple(
        replace(joint, side=sides[joint.name]) if joint.name in sides else replace(joint, limits=None)
        for joint in tree.joints
    )
    chain = Chain("exo", tree.root, tree.links, joints, "q", "base")
    plated = [sole for sole in feet if needs_plate(result.biped, tree, sole)]
    commands = (*tree.commands, *(command for sole in plated for command in foot_plate(tree, sole)))
    visuals = (*tree.visuals, *(plate_path(tree, sole) for sole in plated))
    title = result.target.title or result.target.name
    return Actor(commands, chain, _samples(result, walk, chain), Group(title, visuals))


def _ghost(result: Retargeted, walk: PlacedWalk, tree: Linkage, title: str) -> Actor:
    chain = Chain("ghost", tree.root, tree.links, tree.joints, "ghost_q", "ghost_base")
    return Actor(tree.commands, chain, _samples(result, walk, chain), Group(f"Ghost: {title}", tree.visuals))


def _samples(result: Retargeted, walk: PlacedWalk, chain: Chain) -> dict[str, Array]:
    return chain_samples(chain, dict(zip(result.robot.joints, walk.q.T, strict=True)), walk.base)


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
    target, biped, errors = result.target, result.biped, result.errors
    legs = f"{biped.joints_per_leg} joints per leg, hip {biped.hip_order}"
    lean = f"the trunk is upright, the hips take over {degrees(result.lean):.1f} degrees of the pelvis's lean"
    notes = [
        f"{target.title or target.name}: {legs}; the feet's paths are {np.mean(result.scale):.2f} times the "
        f"person's, missed by {1e3 * errors.largest_position:.2f} mm and "
        f"{degrees(errors.largest_rotation):.1f} degrees at most; {lean}. "
        "Dashed: the person's angles joint by joint.",
        target.remarks,
        *(f"{note[:1].upper()}{note[1:]}." for note in result.notes),
        "" if has_mass(biped.robot) else "Its URDF states no masses: its centre of mass is not known.",
        f"Its meshes: {target.licence}, thinned." if target.licence and meshes.triangles else "",
    ]
    if tree.skipped:
        name, why = next(iter(meshes.missing.items()), ("a visual", "of no known kind"))
        notes.append(f"{tree.skipped} visuals of the URDF are not drawn ({shortened(name, 60)}: {why}).")
    return [note for note in notes if note]


def _buried_tips(walk: PlacedWalk, feet: tuple[Sole, Sole]) -> list[str]:
    """How deep the tips of rigid feet get below the ground, where a person's toes would bend."""
    low = 0.0
    for k, sole in enumerate(feet):
        tip = np.array([sole.tip, *sole.middle[1:], 0.0])
        low = min(low, float(transformed(walk.feet[:, k], tip)[:, 2].min()))
    if low > -_SHALLOW:
        return []
    return [
        "The rigid feet have no toes: where a person's would bend, their tips are up to "
        f"{-1e3 * low:.0f} mm below the ground."
    ]

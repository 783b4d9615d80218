"""A robot's appearance: its links with the meshes of its package, or capsules and foot plates instead."""

from __future__ import annotations

import numpy as np

from exo_pin.ground import transformed
from exo_pin.kinematics import poses
from exo_pin.retarget import Biped
from exo_pin.viewer.drawing_commands import Command, Material, draw, mesh, place
from exo_pin.viewer.meshes import solids
from exo_pin.viewer.meshes.solids import translation
from exo_pin.viewer.meshes.urdf_meshes import Meshes, ThinnedFiles
from exo_pin.viewer.scenes.link_nodes import GREY, Linkage, linkage
from exo_pin.viewer.scenes.soles import Sole

_PLATE_THICKNESS = 0.02
"""Of the foot plate that is drawn where a robot's foot has no visual [m]."""


def robot_linkage(
    biped: Biped, root: str, paint: Material | None, files: ThinnedFiles
) -> tuple[Linkage, Meshes]:
    """The robot's links with their visuals.

    Where COLLADA files have y up, some tools turn them to z up and some do not, and robots are made for one
    or the other. Of both, the one is taken whose meshes cover the joints of their links better.

    Args:
        biped: The robot with its legs.
        root: Path of its root link's node.
        paint: Material for everything instead of the robot's own, or None.
        files: Mesh files that were read before, to be read only once.

    Returns:
        The links as nodes, and which of their meshes were found.
    """
    tried = []
    for turned in (False, True):
        meshes = Meshes(biped.robot.path, height(biped), files, turned=turned)
        tree = linkage(biped.robot.urdf, root, paint=paint, meshes=meshes)
        if not meshes.y_up:
            return tree, meshes
        tried.append((_joints_outside(biped, tree), turned, tree, meshes))
    *_, tree, meshes = min(tried, key=lambda one: one[:2])
    return tree, meshes


def _joints_outside(biped: Biped, tree: Linkage) -> float:
    """How far the joints that hang on links lie outside of the boxes around their visuals, in sum [m]."""
    robot, apart = biped.robot, 0.0
    for joint in robot.joints:
        index = robot.model.frames[robot.frame(joint)].parentFrame
        link = str(robot.model.frames[index].name)
        if link in tree.shapes:
            T_link, T_joint = poses(robot, biped.stand, (link, joint))
            point = transformed(np.linalg.inv(T_link), T_joint[:3, 3])
            corners = tree.shapes[link].vertices
            outside = np.maximum(corners.min(axis=0) - point, point - corners.max(axis=0))
            apart += float(np.maximum(outside, 0.0).sum())
    return apart


def needs_plate(biped: Biped, tree: Linkage, sole: Sole) -> bool:
    """Whether a foot and all that is fixed to it have no visual.

    Args:
        biped: The robot with its legs.
        tree: Its links as nodes.
        sole: The foot's sole.
    """
    if sole.link in tree.shapes:
        return False
    model = biped.robot.model
    joint = model.frames[biped.robot.frame(sole.link)].parentJoint
    return not any(frame.parentJoint == joint and frame.name in tree.shapes for frame in model.frames)


def plate_path(tree: Linkage, sole: Sole) -> str:
    """Node of a foot's plate."""
    return f"{tree.links[sole.link]}/plate"


def foot_plate(tree: Linkage, sole: Sole) -> list[Command]:
    """A plate in place of a foot's visual."""
    length, width = sole.size
    solid = solids.box((length, width, _PLATE_THICKNESS))
    x, y = sole.middle
    path = plate_path(tree, sole)
    return [
        draw(path, mesh(solid.vertices, solid.faces, solid.normals), Material(GREY, 0.6, 0.1)),
        place(path, sole.T @ translation(x, y, _PLATE_THICKNESS / 2)),
    ]


def height(biped: Biped) -> float:
    """From the lowest to the highest joint, standing [m]; at least twice the legs."""
    robot = biped.robot
    T = poses(robot, biped.stand, robot.joints)
    return max(float(np.ptp((T[:, :3, 3] @ biped.rotation)[:, 2])), 2 * biped.legs[0].reach)


def highest_point(biped: Biped, tree: Linkage) -> float:
    """The highest point of the robot's visuals above its root, standing [m]."""
    links = list(tree.shapes)
    if not links:
        return 0.0
    T = poses(biped.robot, biped.stand, links)
    up = biped.rotation[:, 2]
    rows = zip(links, T, strict=True)
    return max(float((transformed(pose, tree.shapes[link].vertices) @ up).max()) for link, pose in rows)

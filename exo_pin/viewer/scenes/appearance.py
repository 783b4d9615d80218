"""A robot's looks: its links with the meshes of its package, or capsules and foot plates in their place."""

from __future__ import annotations

import numpy as np

from exo_pin.ground.placement import moved
from exo_pin.kinematics import poses
from exo_pin.retarget import Biped
from exo_pin.viewer.drawing_commands import Command, Material, draw, mesh, place, translation
from exo_pin.viewer.meshes import solids
from exo_pin.viewer.meshes.urdf_meshes import Meshes
from exo_pin.viewer.scenes.link_nodes import GREY, Linkage, linkage
from exo_pin.viewer.scenes.soles import Sole

PLATE = 0.02
"""Thickness of the foot plate that is drawn where a robot has no feet to show [m]."""


def dressed(biped: Biped, root: str, paint: Material | None) -> tuple[Linkage, Meshes]:
    """The robot's links with their looks.

    Where COLLADA files say that y is up, some tools turn them and some do not, and robots are made for the
    ones or the others: what is taken is where the meshes cover the joints of their links better.
    """
    tried = []
    for turned in (False, True):
        meshes = Meshes(biped.robot.path, height(biped), turned=turned)
        tree = linkage(biped.robot.urdf, root, paint=paint, meshes=meshes)
        if not meshes.y_up:
            return tree, meshes
        tried.append((_apart(biped, tree), turned, tree, meshes))
    *_, tree, meshes = min(tried, key=lambda one: one[:2])
    return tree, meshes


def _apart(biped: Biped, tree: Linkage) -> float:
    """How far the joints that hang on links lie outside of the boxes around their looks, in sum [m]."""
    robot, apart = biped.robot, 0.0
    for joint in robot.joints:
        index = robot.model.frames[robot.frame(joint)].parentFrame
        link = str(robot.model.frames[index].name)
        if link in tree.shapes:
            T_link, T_joint = poses(robot, biped.stand, (link, joint))
            place = moved(np.linalg.inv(T_link), T_joint[:3, 3])
            corners = tree.shapes[link].vertices
            outside = np.maximum(corners.min(axis=0) - place, place - corners.max(axis=0))
            apart += float(np.maximum(outside, 0.0).sum())
    return apart


def bare(biped: Biped, sole: Sole, tree: Linkage) -> bool:
    """Whether nothing is drawn of a foot, with its fixed parts."""
    model = biped.robot.model
    joint = model.frames[biped.robot.frame(sole.link)].parentJoint
    return not any(frame.parentJoint == joint and frame.name in tree.shapes for frame in model.frames)


def plate(tree: Linkage, sole: Sole) -> list[Command]:
    """A plate for a foot that has no looks."""
    length, width = sole.size
    solid = solids.box((length, width, PLATE))
    x, y = sole.middle
    path = f"{tree.links[sole.link]}/plate"
    return [
        draw(path, mesh(solid.vertices, solid.faces, solid.normals), Material(GREY, 0.6, 0.1)),
        place(path, sole.T @ translation(x, y, PLATE / 2)),
    ]


def height(biped: Biped) -> float:
    """From the lowest to the highest joint, standing [m]; at least twice the legs."""
    robot = biped.robot
    T = poses(robot, biped.stand, robot.joints)
    return max(float(np.ptp((T[:, :3, 3] @ biped.rotation)[:, 2])), 2 * biped.legs[0].reach)


def highest(biped: Biped, tree: Linkage) -> float:
    """The highest point of the robot above its root, standing [m]."""
    links = list(tree.shapes)
    if not links:
        return 0.0
    T = poses(biped.robot, biped.stand, links)
    up = biped.rotation[:, 2]
    rows = zip(links, T, strict=True)
    return max(float((moved(pose, tree.shapes[link].vertices) @ up).max()) for link, pose in rows)

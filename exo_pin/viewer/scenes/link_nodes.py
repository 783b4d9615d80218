"""A robot's links as nested nodes, read from its URDF text.

A joint becomes two nodes: the placement of the child in its parent, fixed, and inside it `turn`, which the
page rotates. The child's visuals and its own joints hang in `turn`, so the page does forward kinematics by
rotating the joint nodes and nothing else.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal, Protocol

import numpy as np

from exo_pin.errors import DescriptionError
from exo_pin.robot import urdf_elements, urdf_tree
from exo_pin.viewer.drawing_commands import Command, Material, draw, mesh, place
from exo_pin.viewer.meshes import solids, urdf_shapes
from exo_pin.viewer.meshes.solids import Color, Solid
from exo_pin.viewer.scenes.scene import JointNode

_FINISHES = {
    "aluminium": (0.32, 0.55),
    "graphite": (0.42, 0.25),
    "shell": (0.35, 0.05),
    "cuff": (0.85, 0.0),
    "rubber": (0.95, 0.0),
    "signal": (0.40, 0.0),
}
"""Roughness and metalness of the URDF's materials by name (design choice); the colours stay the URDF's."""

_PLAIN = (0.42, 0.10)
"""Roughness and metalness of every other material."""

GREY = (0.7, 0.7, 0.7, 1.0)
"""Colour where the URDF names none."""

_CAPSULE = Material((0.62, 0.67, 0.74, 1.0), 0.5, 0.1)
"""Surface of the capsules that stand for links without a drawable visual."""

_SHORTEST_CAPSULE = 0.03
"""A joint nearer to its link's origin than this gets no capsule [m]."""

_SLENDERNESS = 0.13
"""Radius of a capsule over its length ..."""

_THICKEST_CAPSULE = 0.045
"""... and at most this [m]."""

_BOTH_SIDES = (("side", 2),)
"""Faces of meshes from elsewhere may be turned the wrong way round: three.js draws both sides."""

_MOVING: dict[str, Literal["revolute", "prismatic"]] = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
}
"""The URDF's types of joints that move."""


class MeshSource(Protocol):
    """Reads the mesh files of a URDF."""

    def solids(self, name: str, scale: tuple[float, float, float]) -> list[tuple[Solid, Color | None]]:
        """The parts of a mesh by its file name in the URDF, each with its colour if it has one."""


@dataclass(frozen=True)
class Linkage:
    """A URDF as nested nodes.

    Attributes:
        root: Path of the root link's node; its pose is the base's pose.
        links: Link name -> path of the node that has the link's pose.
        joints: The moving joints, in the URDF's order.
        visuals: Nodes that hold the drawings, one a link.
        commands: What draws it.
        skipped: Number of visuals that are neither primitives nor meshes that were found: not drawn.
        shapes: Link name -> all its visuals as one solid, in the link's axes.
    """

    root: str
    links: dict[str, str]
    joints: tuple[JointNode, ...]
    visuals: tuple[str, ...]
    commands: tuple[Command, ...]
    skipped: int
    shapes: dict[str, Solid]


def linkage(
    urdf: str, root: str, *, paint: Material | None = None, meshes: MeshSource | None = None
) -> Linkage:
    """Nest the links of a URDF below a path.

    Args:
        urdf: The URDF's text.
        root: Path of the node for the root link, e.g. `"/exo_pin/exo"`.
        paint: Material for everything instead of the URDF's own.
        meshes: Reads mesh files; None: they are not drawn. With it, a link whose visuals cannot be drawn gets
            capsules, and so does every link of a URDF without any visual.

    Raises:
        DescriptionError: The text is not a URDF with one root link, or a number in it cannot be read.
    """
    try:
        return _Nesting(urdf_tree.parsed(urdf), paint, meshes).below(root)
    except (ValueError, RecursionError) as error:
        raise DescriptionError("the URDF cannot be drawn: a number in it cannot be read") from error


class _Nesting:
    """Walks the tree of links once and collects nodes, joints and drawings."""

    def __init__(self, robot: ET.Element, paint: Material | None, meshes: MeshSource | None) -> None:
        self.robot, self.paint, self.meshes = robot, paint, meshes
        self.bare = meshes is not None and robot.find("link/visual") is None
        self.colors = {
            m.get("name", ""): c
            for m in robot.findall("material")
            if (c := urdf_elements.rgba(m)) is not None
        }
        self.children: dict[str, list[ET.Element]] = defaultdict(list)
        for joint in robot.findall("joint"):
            self.children[urdf_elements.end(joint, "parent")].append(joint)
        self.elements = {link.get("name", ""): link for link in robot.findall("link")}
        self.links: dict[str, str] = {}
        self.joints: list[JointNode] = []
        self.visuals: list[str] = []
        self.commands: list[Command] = []
        self.skipped = 0
        self.shapes: dict[str, Solid] = {}

    def below(self, path: str) -> Linkage:
        moved = {urdf_elements.end(joint, "child") for joint in self.robot.findall("joint")}
        roots = [name for name in self.elements if name not in moved]
        if len(roots) != 1:
            raise DescriptionError(f"the URDF must have one root link, not {len(roots)}: {', '.join(roots)}")
        self.link(roots[0], path)
        parts = tuple(self.joints), tuple(self.visuals), tuple(self.commands)
        return Linkage(path, self.links, *parts, self.skipped, self.shapes)

    def link(self, name: str, path: str) -> None:
        self.links[name] = path
        self.draw(name, f"{path}/look")
        for joint in self.children[name]:
            self.joint(joint, path)

    def draw(self, name: str, path: str) -> None:
        """Draw the visuals of a link: one mesh per material."""
        solids_of: dict[Material, list[Solid]] = defaultdict(list)
        visuals = self.elements[name].findall("visual")
        for visual in visuals:
            found = list(self.visual(visual))
            self.skipped += not found
            for solid, material in found:
                solids_of[material].append(solid.placed(urdf_elements.pose(visual.find("origin"))))
        if self.meshes is not None and not solids_of and (visuals or self.bare):
            solids_of[self.paint or _CAPSULE].extend(self.capsules(name))
        drawn = {material: parts for material, parts in solids_of.items() if parts}
        if drawn:
            self.visuals.append(path)
            self.shapes[name] = solids.joined(part for parts in drawn.values() for part in parts)
        for k, (material, parts) in enumerate(drawn.items()):
            whole = solids.joined(parts)
            shape = mesh(whole.vertices, whole.faces, whole.normals)
            self.commands.append(draw(f"{path}/{k}", shape, material))

    def visual(self, visual: ET.Element) -> Iterator[tuple[Solid, Material]]:
        """What can be drawn of a visual: a primitive, or the parts of a mesh."""
        geometry = visual.find("geometry")
        solid = urdf_shapes.solid(geometry)
        if solid is not None:
            yield solid, self.material(visual)
        found = None if geometry is None else geometry.find("mesh")
        if self.meshes is None or found is None:
            return
        x, y, z = urdf_elements.numbers(found.get("scale") or "1 1 1")
        for part, color in self.meshes.solids(found.get("filename", ""), (x, y, z)):
            yield part, replace(self.material(visual, color), more=_BOTH_SIDES)

    def capsules(self, name: str) -> Iterator[Solid]:
        """Capsules from a link's origin to the joints that hang on it."""
        for joint in self.children[name]:
            end = urdf_elements.pose(joint.find("origin"))[:3, 3]
            length = float(np.linalg.norm(end))
            if length > _SHORTEST_CAPSULE:
                yield solids.capsule(end, min(_SLENDERNESS * length, _THICKEST_CAPSULE))

    def joint(self, joint: ET.Element, path: str) -> None:
        child, name = urdf_elements.end(joint, "child"), joint.get("name", "")
        placed = f"{path}/{urdf_shapes.node(child)}"
        self.commands.append(place(placed, urdf_elements.pose(joint.find("origin"))))
        kind = _MOVING.get(joint.get("type", ""))
        if kind is None:
            self.link(child, placed)
            return
        turn = f"{placed}/turn"
        axis = joint.find("axis")
        direction = np.array(
            urdf_elements.numbers(axis.get("xyz", "1 0 0")) if axis is not None else [1.0, 0.0, 0.0]
        )
        length = float(np.linalg.norm(direction))
        if not length > 0:
            raise DescriptionError(f"joint {name!r} of the URDF has no axis")
        x, y, z = (direction / length).tolist()
        self.joints.append(JointNode(name, turn, (x, y, z), kind, urdf_elements.limits(joint)))
        self.link(child, turn)

    def material(self, visual: ET.Element, color: Color | None = None) -> Material:
        """A mesh's own colour, else what the URDF says."""
        if self.paint is not None:
            return self.paint
        element = visual.find("material")
        name = "" if element is None else element.get("name", "")
        own = None if element is None else urdf_elements.rgba(element)
        roughness, metalness = _FINISHES.get(name, _PLAIN)
        return Material(color or own or self.colors.get(name) or GREY, roughness, metalness)

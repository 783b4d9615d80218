"""The exoskeleton's links as nested nodes, read from the robot's own URDF text.

A joint becomes two nodes: the placement of the child in its parent, fixed, and inside it `turn`, which the
page rotates. The child's pictures and its own joints hang in `turn`, so the page does forward kinematics by
turning the joint nodes and nothing else.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from exo_pin.anatomy.names import Side
from exo_pin.errors import DescriptionError
from exo_pin.viewer.drawing_commands import Command, Material, draw, mesh, place
from exo_pin.viewer.meshes import solids, urdf_elements
from exo_pin.viewer.meshes.solids import Solid
from exo_pin.viewer.meshes.urdf_meshes import Meshes

FINISHES = {
    "aluminium": (0.32, 0.55),
    "graphite": (0.42, 0.25),
    "shell": (0.35, 0.05),
    "cuff": (0.85, 0.0),
    "rubber": (0.95, 0.0),
    "signal": (0.40, 0.0),
}
"""Roughness and metalness of the URDF's materials by name (design choice); the colours stay the URDF's."""

PLAIN = (0.42, 0.10)
"""Roughness and metalness of every other material."""

GREY = (0.7, 0.7, 0.7, 1.0)
"""Colour where the URDF names none."""

BONE = Material((0.62, 0.67, 0.74, 1.0), 0.5, 0.1)
"""Look of the capsules that stand for what cannot be drawn."""

SHORTEST_BONE, SLENDER, THICKEST = 0.03, 0.13, 0.045  # [m], thickness over length, [m]

BOTH_SIDES = (("side", 2),)
"""Faces of meshes from elsewhere may be turned the wrong way round: three.js draws both sides."""

MOVING = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


@dataclass(frozen=True)
class Turn:
    """A moving joint in the page.

    Attributes:
        name: The joint's name.
        path: The node that turns (or slides).
        axis: Unit axis in the joint's frame.
        kind: `"revolute"` or `"prismatic"`.
        limits: Lower and upper limit [rad, m] for a slider in the page, or None: no slider.
        side: `"left"` or `"right"`, for the slider's colour; empty: what the joint's name begins with.
    """

    name: str
    path: str
    axis: tuple[float, float, float]
    kind: str
    limits: tuple[float, float] | None = None
    side: Side = ""


@dataclass(frozen=True)
class Linkage:
    """A URDF as nested nodes.

    Attributes:
        root: Path of the root link's node; its pose is the base's pose.
        links: Link name -> path of the node that has the link's pose.
        turns: The moving joints, in the URDF's order.
        looks: Nodes that hold the pictures, one a link.
        commands: What draws it.
        skipped: Number of visuals that are neither primitives nor meshes that were found: not drawn.
        shapes: Link name -> all its pictures as one solid, in the link's axes.
    """

    root: str
    links: dict[str, str]
    turns: tuple[Turn, ...]
    looks: tuple[str, ...]
    commands: tuple[Command, ...]
    skipped: int
    shapes: dict[str, Solid]


def linkage(urdf: str, root: str, *, paint: Material | None = None, meshes: Meshes | None = None) -> Linkage:
    """Nest the links of a URDF below a path.

    Args:
        urdf: The URDF's text.
        root: Path of the node for the root link, e.g. `"/exo_pin/exo"`.
        paint: Material for everything instead of the URDF's own.
        meshes: Where mesh files are read; None: they are not drawn. Links of which nothing can be drawn get
            capsules then, unless other links have their looks and this one never had any.

    Raises:
        DescriptionError: The text is no URDF with one root link, or a number in it is none.
    """
    try:
        return _Nesting(ET.fromstring(urdf), paint, meshes).below(root)
    except (ET.ParseError, ValueError, RecursionError) as error:
        raise DescriptionError(f"the URDF cannot be drawn: {error}") from error


class _Nesting:
    """Walks the tree of links once and collects nodes, joints and pictures."""

    def __init__(self, robot: ET.Element, paint: Material | None, meshes: Meshes | None) -> None:
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
        self.turns: list[Turn] = []
        self.looks: list[str] = []
        self.commands: list[Command] = []
        self.skipped = 0
        self.shapes: dict[str, Solid] = {}

    def below(self, path: str) -> Linkage:
        moved = {urdf_elements.end(joint, "child") for joint in self.robot.findall("joint")}
        roots = [name for name in self.elements if name not in moved]
        if len(roots) != 1:
            raise DescriptionError(f"the URDF must have one root link, not {len(roots)}: {', '.join(roots)}")
        self.link(roots[0], path)
        parts = tuple(self.turns), tuple(self.looks), tuple(self.commands)
        return Linkage(path, self.links, *parts, self.skipped, self.shapes)

    def link(self, name: str, path: str) -> None:
        self.links[name] = path
        self.pictures(name, f"{path}/look")
        for joint in self.children[name]:
            self.joint(joint, path)

    def pictures(self, name: str, path: str) -> None:
        """One mesh per material."""
        looks: dict[Material, list[Solid]] = defaultdict(list)
        visuals = self.elements[name].findall("visual")
        for visual in visuals:
            found = list(self.visual(visual))
            self.skipped += not found
            for solid, material in found:
                looks[material].append(solid.placed(urdf_elements.pose(visual.find("origin"))))
        if self.meshes is not None and not looks and (visuals or self.bare):
            looks[self.paint or BONE].extend(self.bones(name))
        looks = {material: parts for material, parts in looks.items() if parts}
        if looks:
            self.looks.append(path)
            self.shapes[name] = solids.joined(part for parts in looks.values() for part in parts)
        for k, (material, parts) in enumerate(looks.items()):
            whole = solids.joined(parts)
            shape = mesh(whole.vertices, whole.faces, whole.normals)
            self.commands.append(draw(f"{path}/{k}", shape, material))

    def visual(self, visual: ET.Element) -> Iterator[tuple[Solid, Material]]:
        """What can be drawn of a visual: a primitive, or the parts of a mesh."""
        geometry = visual.find("geometry")
        solid = urdf_elements.solid(geometry)
        if solid is not None:
            yield solid, self.material(visual)
        found = None if geometry is None else geometry.find("mesh")
        if self.meshes is None or found is None:
            return
        x, y, z = urdf_elements.numbers(found.get("scale") or "1 1 1")
        for part, color in self.meshes.solids(found.get("filename", ""), (x, y, z)):
            yield part, replace(self.material(visual, color), more=BOTH_SIDES)

    def bones(self, name: str) -> Iterator[Solid]:
        """Capsules from a link's origin to the joints that hang on it."""
        for joint in self.children[name]:
            end = urdf_elements.pose(joint.find("origin"))[:3, 3]
            length = float(np.linalg.norm(end))
            if length > SHORTEST_BONE:
                yield solids.capsule(end, min(SLENDER * length, THICKEST))

    def joint(self, joint: ET.Element, path: str) -> None:
        child, name = urdf_elements.end(joint, "child"), joint.get("name", "")
        held = f"{path}/{urdf_elements.node(child)}"
        self.commands.append(place(held, urdf_elements.pose(joint.find("origin"))))
        kind = MOVING.get(joint.get("type", ""))
        if kind is None:
            self.link(child, held)
            return
        turn = f"{held}/turn"
        axis = joint.find("axis")
        direction = np.array(
            urdf_elements.numbers(axis.get("xyz", "1 0 0")) if axis is not None else [1.0, 0.0, 0.0]
        )
        length = float(np.linalg.norm(direction))
        if not length > 0:
            raise DescriptionError(f"joint {name!r} of the URDF has no axis")
        x, y, z = (direction / length).tolist()
        self.turns.append(Turn(name, turn, (x, y, z), kind, urdf_elements.limits(joint)))
        self.link(child, turn)

    def material(self, visual: ET.Element, color: solids.Color | None = None) -> Material:
        """A mesh's own colour, else what the URDF says."""
        if self.paint is not None:
            return self.paint
        element = visual.find("material")
        name = "" if element is None else element.get("name", "")
        own = None if element is None else urdf_elements.rgba(element)
        roughness, metalness = FINISHES.get(name, PLAIN)
        return Material(color or own or self.colors.get(name) or GREY, roughness, metalness)

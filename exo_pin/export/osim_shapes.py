"""Plain shapes of a URDF's links as OpenSim draws them."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

from exo_pin.arrays import Array
from exo_pin.export.osim_elements import add_pose_frame, add_text, triple
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM, body_fixed_xyz
from exo_pin.robot import urdf_elements


def add_shapes(body: Element, link: Element, moved: Array) -> None:
    """Boxes, cylinders and spheres of a link, each in its own frame; meshes are left out.

    Args:
        body: Of the .osim file.
        link: Of the URDF.
        moved: `(3,)` where the link's URDF origin lies in its body, OpenSim axes [m].
    """
    components = Element("components")
    for k, visual in enumerate(link.findall("visual")):
        shape = _shape(visual.find("geometry"))
        if shape is None:
            continue
        T = urdf_elements.pose(visual.find("origin"))
        R = FROM_OPENSIM.T @ T[:3, :3] @ FROM_OPENSIM  # both frames turned: a cylinder's axis is now y
        place = FROM_OPENSIM.T @ T[:3, 3] + moved
        frame = add_pose_frame(components, f"{body.get('name')}_shape_{k}", "..", place, body_fixed_xyz(R))
        SubElement(frame, "attached_geometry").append(shape)
    if len(components):
        body.append(components)


def _shape(geometry: Element | None) -> Element | None:
    """OpenSim's shape of a URDF's, whose x, y, z are OpenSim's x, -z, y."""
    for tag, build in (("box", _brick), ("cylinder", _cylinder), ("sphere", _sphere)):
        found = None if geometry is None else geometry.find(tag)
        if found is not None:
            shape = build(found)
            add_text(shape, "socket_frame", "..")
            return shape
    return None


def _brick(box: Element) -> Element:
    x, y, z = urdf_elements.numbers(box.get("size", "0 0 0"))
    shape = Element("Brick", name="box")
    add_text(shape, "half_lengths", triple([x / 2, z / 2, y / 2]))
    return shape


def _cylinder(cylinder: Element) -> Element:
    shape = Element("Cylinder", name="cylinder")
    add_text(shape, "radius", cylinder.get("radius", "0"))
    add_text(shape, "half_height", repr(float(cylinder.get("length", "0")) / 2))
    return shape


def _sphere(sphere: Element) -> Element:
    shape = Element("Sphere", name="sphere")
    add_text(shape, "radius", sphere.get("radius", "0"))
    return shape

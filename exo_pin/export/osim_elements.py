"""Pieces of an .osim file: texts, triples of numbers, frames."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement

from exo_pin.arrays import Array


def add_text(element: Element, tag: str, text: str) -> None:
    """A child element that holds a text."""
    SubElement(element, tag).text = text


def triple(values: Iterable[float]) -> str:
    """Numbers as OpenSim reads them, in full digits."""
    return " ".join(repr(float(x) + 0.0) for x in values)


def add_pose_frame(element: Element, name: str, parent: str, place: Array, angles: Array) -> Element:
    """A frame that stands still in another.

    Args:
        element: What it becomes a child of.
        name: Of the frame.
        parent: Path of the component in which it stands still.
        place: `(3,)` its origin there [m].
        angles: `(3,)` body-fixed x, y, z [rad].
    """
    frame = SubElement(element, "PhysicalOffsetFrame", name=name)
    add_text(frame, "socket_parent", parent)
    add_text(frame, "translation", triple(place))
    add_text(frame, "orientation", triple(angles))
    return frame

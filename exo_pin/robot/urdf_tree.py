"""A URDF as a tree that is safe to build: its XML within limits, every joint between two links, one root."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from exo_pin.errors import DescriptionError, FormatError
from exo_pin.safe.xml_reader import XmlLimits, parse_xml

LIMITS = XmlLimits(mebibytes=32, elements=100_000)
"""Of a URDF's XML; a humanoid with hands has some 2000 elements."""

MOST = {"link": 1000, "joint": 1000, "link/visual": 3000, "link/collision": 3000}
"""Elements that are accepted at most; a humanoid with hands has a hundred links."""

DEEPEST = 150
"""Joints from the root to a link: Pinocchio and the viewer follow them by recursion."""

_LONGEST_NAME = 200
_SHOWN = 40


def parsed(text: str) -> ET.Element:
    """The `<robot>` of a URDF's text.

    Raises:
        DescriptionError: It is no XML, too large, or of another kind.
    """
    start = text.lstrip()  # blank lines above the XML declaration are common, though not allowed
    try:
        root = parse_xml(start, Path("URDF"), LIMITS)
    except FormatError as error:
        above = text[: len(text) - len(start)].count("\n")
        place = "" if error.line is None else f"line {error.line + above}: "
        raise DescriptionError(f"{place}{error.why}") from None
    if root.tag != "robot":
        raise DescriptionError(f"no URDF: its root element is <{shown(root.tag)}>, not <robot>")
    return root


def judge(root: ET.Element) -> None:
    """Refuse what is no tree of links and joints, or too large to be one of a robot.

    Raises:
        DescriptionError: The message names the link or joint.
    """
    for path, most in MOST.items():
        count = len(root.findall(path))
        if count > most:
            raise DescriptionError(f"{count} <{path.split('/')[-1]}> elements; at most {most} are accepted")
    links, joints = (_names(root, tag) for tag in ("link", "joint"))
    if not links:
        raise DescriptionError("no <link> in this URDF")
    parent_of: dict[str, str] = {}
    for name, joint in zip(joints, root.findall("joint"), strict=True):
        parent, child = (_end(name, joint, which, links) for which in ("parent", "child"))
        if child in parent_of:
            raise DescriptionError(f"joint {name!r}: link {child!r} hangs on another joint already")
        parent_of[child] = parent
    _judge_depth(links, parent_of)


def shown(text: object) -> str:
    """A text of the file as it may stand in a message."""
    plain = "".join(mark if mark.isprintable() else " " for mark in str(text))
    return plain if len(plain) <= _SHOWN else f"{plain[: _SHOWN - 4]} ..."


def _names(root: ET.Element, tag: str) -> dict[str, None]:
    names = [element.get("name") or "" for element in root.findall(tag)]
    for name in names:
        if not name or len(name) > _LONGEST_NAME or not name.isprintable():
            raise DescriptionError(
                f"{tag} {shown(name)!r}: a name of 1 to {_LONGEST_NAME} printable characters is accepted"
            )
    twice = next((name for name, count in Counter(names).items() if count > 1), None)
    if twice is not None:
        raise DescriptionError(f"{tag} {shown(twice)!r} occurs more than once")
    return dict.fromkeys(names)


def _end(name: str, joint: ET.Element, which: str, links: Iterable[str]) -> str:
    """The parent or child link of a joint."""
    element = joint.find(which)
    link = None if element is None else element.get("link")
    if link is None:
        raise DescriptionError(f"joint {shown(name)!r} names no {which} link")
    if link not in links:
        raise DescriptionError(f"joint {shown(name)!r}: there is no link {shown(link)!r}, its {which}")
    return link


def _judge_depth(links: Iterable[str], parent_of: dict[str, str]) -> None:
    """One root, no circles, no chain that is too long; takes links x DEEPEST steps at most."""
    roots = [name for name in links if name not in parent_of]
    for name in links:
        link, depth = name, 0
        while link in parent_of and depth <= DEEPEST:
            link, depth = parent_of[link], depth + 1
        if depth > DEEPEST:
            why = f"hangs on itself, or on a chain of more than {DEEPEST} joints"
            raise DescriptionError(f"link {shown(name)!r} {why}; a tree of shorter chains is accepted")
    if len(roots) > 1:
        some = ", ".join(map(shown, roots[:3]))
        raise DescriptionError(f"{len(roots)} links hang on no joint ({some}); one root link is accepted")

"""XML of untrusted files: no entities, nothing from other files, limits of size, depth and elements."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple, NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from exo_pin.errors import FormatError
from exo_pin.files import control_character, read_bytes

_DEEPEST = 100
"""Elements within elements; a model has a dozen."""


class XmlLimits(NamedTuple):
    """How much is read.

    Attributes:
        mebibytes: Of the file.
        elements: Of all, kept or not.
        skipped: Names of elements that are not kept, nor what is in them.
    """

    mebibytes: int = 32
    elements: int = 200_000
    skipped: frozenset[str] = frozenset()


MODEL_LIMITS = XmlLimits()
"""Of a model: OpenSim's largest published ones have some 5 MiB and 20 000 elements."""


def load_xml(path: Path, limits: XmlLimits = MODEL_LIMITS) -> Element:
    """The root element of an XML file; a document type that only names a file is ignored.

    Args:
        path: The file.
        limits: Of its size and elements.

    Raises:
        FormatError: It is no XML, too large or too deep, or its document type defines something: entities can
            stand for gigabytes or for other files.
    """
    return parse_xml(read_bytes(path), path, limits)


def parse_xml(data: bytes | str, path: Path, limits: XmlLimits = MODEL_LIMITS) -> Element:
    """The root element of XML that is in memory already.

    Args:
        data: The content of a file, or a text.
        path: The file, for messages.
        limits: Of its size and elements.

    Raises:
        FormatError: As in `load_xml`.
    """
    if len(data) > limits.mebibytes * 2**20:
        raise FormatError(path, f"larger than {limits.mebibytes} MiB of XML")
    reader = _Reader(path, limits)
    try:
        reader.parser.Parse(data, True)
        return reader.tree.close()
    except expat.ExpatError as error:
        raise FormatError(path, f"no XML: {expat.ErrorString(error.code)}", line=error.lineno) from error
    except (AssertionError, LookupError, ValueError) as error:  # no element; an encoding that nobody knows
        raise FormatError(path, "no XML: no element, or an unknown encoding; UTF-8 is accepted") from error


class _Reader:
    """Builds the tree while it counts."""

    def __init__(self, path: Path, limits: XmlLimits) -> None:
        self.path, self.limits, self.depth, self.count, self.skipping = path, limits, 0, 0, 0
        self.tree, self.parser = TreeBuilder(), expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.data
        self.parser.StartDoctypeDeclHandler = self.doctype
        self.parser.SkippedEntityHandler = self.entity
        self.parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        """An element opens."""
        self.depth, self.count = self.depth + 1, self.count + 1
        self.refuse_control((tag, *attributes, *attributes.values()))
        if self.depth > _DEEPEST or self.count > self.limits.elements:
            self.refuse(f"more than {_DEEPEST} levels or {self.limits.elements} elements")
        if self.skipping or tag in self.limits.skipped:
            self.skipping += 1
        else:
            self.tree.start(tag, dict(attributes))

    def data(self, text: str) -> None:
        """Text of an element."""
        self.refuse_control((text,))
        if not self.skipping:
            self.tree.data(text)

    def end(self, tag: str) -> None:
        """An element closes."""
        self.depth -= 1
        if self.skipping:
            self.skipping -= 1
        else:
            self.tree.end(tag)

    def doctype(self, name: str, system: str | None, public: str | None, has_subset: int) -> None:
        """A document type may name a file, which is not read; what it defines itself could be entities.

        Args:
            name: Of the root element.
            system: The file that it names.
            public: Its public name.
            has_subset: Whether it defines anything itself.
        """
        if has_subset:
            self.refuse(
                "has a document type with definitions (<!DOCTYPE [...]>), which are not read; remove it"
            )

    def entity(self, name: str, is_parameter: bool) -> None:
        """An entity that another file would define."""
        self.refuse(f"uses the entity {name[:40]!r} of its document type, which is not read")

    def refuse_control(self, texts: Iterable[str]) -> None:
        """Characters that a terminal would obey: those that XML 1.0 allows."""
        found = control_character("".join(texts))
        if found:
            self.refuse(f"holds the control character {found}; remove it")

    def refuse(self, why: str) -> NoReturn:
        """Stop reading."""
        raise FormatError(self.path, why, line=self.parser.CurrentLineNumber)

"""XML of untrusted files: no document type (so no entities), limits of size, depth and elements."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from exo_pin.errors import FormatError
from exo_pin.files import read_bytes

_LARGEST = 32 * 2**20
"""Bytes; OpenSim's largest published models have some 5 MiB."""

_DEEPEST = 100
"""Elements within elements; a model has a dozen."""

_MOST = 200_000
"""Elements: bounds memory and time; a full model has some 20 000."""


def load_xml(path: Path) -> Element:
    """The root element of an XML file.

    Raises:
        FormatError: It is no XML, too large or too deep, or has a document type, whose entities can stand for
            gigabytes or for other files.
    """
    data = read_bytes(path)
    if len(data) > _LARGEST:
        raise FormatError(path, f"larger than {_LARGEST // 2**20} MiB of XML")
    reader = _Reader(path)
    try:
        reader.parser.Parse(data, True)
        return reader.tree.close()
    except expat.ExpatError as error:
        raise FormatError(path, f"no XML: {expat.ErrorString(error.code)}", line=error.lineno) from error
    except (AssertionError, LookupError, ValueError) as error:  # no element; an encoding that nobody knows
        raise FormatError(path, f"no XML: {str(error)[:200]}") from error


class _Reader:
    """Builds the tree while it counts."""

    def __init__(self, path: Path) -> None:
        self.path, self.depth, self.count = path, 0, 0
        self.tree, self.parser = TreeBuilder(), expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.tree.data
        self.parser.StartDoctypeDeclHandler = self.doctype

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        """An element opens."""
        self.depth, self.count = self.depth + 1, self.count + 1
        if self.depth > _DEEPEST or self.count > _MOST:
            self.refuse(f"more than {_DEEPEST} levels or {_MOST} elements")
        self.tree.start(tag, dict(attributes))

    def end(self, tag: str) -> None:
        """An element closes."""
        self.depth -= 1
        self.tree.end(tag)

    def doctype(self, *_: object) -> None:
        """A document type could define entities."""
        self.refuse("has a document type (<!DOCTYPE>), which is not read; remove it")

    def refuse(self, why: str) -> NoReturn:
        """Stop reading."""
        raise FormatError(self.path, why, line=self.parser.CurrentLineNumber)

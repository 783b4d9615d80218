"""What a page consists of: sections of paragraphs, tables and figures, as values without formatting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from exo_pin.report.draw.drawing import Drawing

Rows = Sequence[Sequence[str]]
ParagraphKind = Literal["", "note", "note screen"]


@dataclass(frozen=True)
class Paragraph:
    """A paragraph; `kind` is `"note"` for small print, `"note screen"` for what paper does not need."""

    text: str
    kind: ParagraphKind = ""


@dataclass(frozen=True)
class Table:
    """A table; the first column is text, the others are numbers or short words.

    `prose`: all columns are sentences, set left and wrapped.
    """

    columns: Sequence[str]
    rows: Rows
    caption: str = ""
    prose: bool = False


@dataclass(frozen=True)
class Figure:
    """Drawings side by side under one caption; `columns` at most (3: small, 2, 1: full width).

    A single drawing that is not of full width has what follows beside it. `screen`: left out on paper.
    """

    drawings: tuple[Drawing, ...]
    caption: str = ""
    columns: int = 3
    screen: bool = False


@dataclass(frozen=True)
class Tiles:
    """Key numbers in large print: what, value, and whether it is good (None: neither)."""

    items: tuple[tuple[str, str, bool | None], ...]


@dataclass(frozen=True)
class Player:
    """A whole HTML page in a frame of its own; on paper a PNG, unless that is empty."""

    html: str
    title: str
    still: bytes = b""


@dataclass(frozen=True)
class Columns:
    """Blocks side by side; one under the other on a phone."""

    left: tuple[Paragraph | Table | Figure | Tiles, ...]
    right: tuple[Paragraph | Table | Figure | Tiles, ...]


Block = Paragraph | Table | Figure | Tiles | Player | Columns
SectionKind = Literal["", "sheet", "appendix", "screen"]


@dataclass(frozen=True)
class Section:
    """A heading and the blocks under it.

    `kind`: on paper a `"sheet"` begins a new page, `"appendix"` is small print in two columns, and
    `"screen"` is left out.
    """

    title: str
    blocks: tuple[Block, ...]
    kind: SectionKind = ""


@dataclass(frozen=True)
class Document:
    """A page: title, a line under it, sections; `foot` stands at the foot of every printed page."""

    title: str
    subtitle: str
    sections: tuple[Section, ...]
    foot: str = ""

    @property
    def drawings(self) -> tuple[Drawing, ...]:
        """Every drawing in it, in order."""
        found: list[Drawing] = []
        for block in (block for section in self.sections for block in section.blocks):
            parts = (*block.left, *block.right) if isinstance(block, Columns) else (block,)
            found += [d for part in parts if isinstance(part, Figure) for d in part.drawings]
        return tuple(found)

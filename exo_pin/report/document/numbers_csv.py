"""Every number of a document in one CSV table: tables cell by cell, and tiles."""

from __future__ import annotations

from collections.abc import Iterator

from exo_pin.report.document.blocks import Block, Columns, Document, Section, Table, Tiles
from exo_pin.safe import spreadsheet_cells

_HEAD = ("section", "row", "column", "value")


def csv_of(document: Document) -> str:
    """The document's tables and tiles as text: section, row, column and value."""
    rows = [(section.title, *row) for section in document.sections for row in _rows(section)]
    return spreadsheet_cells.table([_HEAD, *rows])


def _rows(section: Section) -> Iterator[tuple[str, str, str]]:
    for block in section.blocks:
        parts = (*block.left, *block.right) if isinstance(block, Columns) else (block,)
        for part in parts:
            yield from _cells(part)


def _cells(block: Block) -> Iterator[tuple[str, str, str]]:
    """Row, column and value of each cell that is not empty."""
    if isinstance(block, Tiles):
        yield from ((what, "", value) for what, value, _ in block.items)
    elif isinstance(block, Table):
        for first, *others in block.rows:
            for name, value in zip(block.columns[1:], others, strict=True):
                if value:
                    yield first, name, value

"""A document as Markdown; its drawings are separate files beside it."""

from __future__ import annotations

from collections.abc import Iterable

from exo_pin.report.document.blocks import Block, Columns, Document, Figure, Paragraph, Section, Table, Tiles


def markdown(document: Document) -> str:
    """The document as Markdown text, without players."""
    parts = [f"# {_plain(document.title)}", _plain(document.subtitle)]
    parts += [_section(section) for section in document.sections]
    return "\n\n".join(parts) + "\n"


def _section(section: Section) -> str:
    parts = [f"## {_plain(section.title)}", *map(_block, section.blocks)]
    return "\n\n".join(part for part in parts if part)


def _block(block: Block) -> str:
    if isinstance(block, Paragraph):
        return _plain(block.text)
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Figure):
        pictures = [f"![{_plain(d.title)}]({d.file})" for d in block.drawings]
        return "\n".join(pictures) + (f"\n\n*{_plain(block.caption)}*" if block.caption else "")
    if isinstance(block, Columns):
        return "\n\n".join(map(_block, (*block.left, *block.right)))
    if isinstance(block, Tiles):
        return "\n".join(f"- {_plain(what)}: **{_plain(value)}**" for what, value, _ in block.items)
    return ""


def _table(table: Table) -> str:
    ends = [":--" if table.prose or not k else "--:" for k in range(len(table.columns))]
    lines = [_row(_cells(table.columns)), _row(ends), *(_row(_cells(row)) for row in table.rows)]
    return (f"**{_plain(table.caption)}**\n\n" if table.caption else "") + "\n".join(lines)


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cells(texts: Iterable[str]) -> list[str]:
    return [_plain(text).replace("|", "\\|") for text in texts]


def _plain(words: str) -> str:
    """Text that Markdown and the HTML inside it leave alone."""
    escaped = words.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    for sign in "\\`*[]":
        escaped = escaped.replace(sign, f"\\{sign}")
    return " ".join(escaped.replace("_", "\\_").split())

"""A document as one self-contained HTML page, which loads nothing; for screen, phone and paper."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Iterator
from html import escape, unescape
from importlib import resources
from itertools import groupby
from typing import Any

from exo_pin.report.document.blocks import (
    Block,
    Columns,
    Document,
    Figure,
    Paragraph,
    Player,
    Section,
    Table,
    Tiles,
)

_POLICY = (
    "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data: blob:; "
    "media-src blob:; frame-src 'self'; connect-src 'none'; base-uri 'none'; form-action 'none'"
)
"""The page loads nothing from elsewhere. The only scripts are the embedded player's, by their hashes."""

_HASH = re.compile(r"'sha256-[A-Za-z0-9+/=]+'")


def html(document: Document) -> str:
    """The whole page; every name and number in it is escaped.

    Args:
        document: What to show.
    """
    title = escape(document.title)
    body = "\n".join(_parts(document))
    style = (resources.files("exo_pin.report.document") / "page.css").read_text("utf-8")
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{escape(_policy(document))}">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<link rel="icon" href="data:,">\n<title>{title}</title>\n'
        f"<style>{style}{_foot(document)}</style></head>\n"
        f'<body>\n<h1>{title}</h1>\n<p class="under">{escape(document.subtitle)}</p>\n'
        f"{body}\n</body></html>\n"
    )


def _policy(document: Document) -> str:
    """The page's Content-Security-Policy, which also binds the frames in it: it allows their own scripts."""
    players = [
        block for section in document.sections for block in section.blocks if isinstance(block, Player)
    ]
    hashes = {
        found for player in players for found in _HASH.findall(unescape(player.html.partition("<title")[0]))
    }
    return _POLICY.format(scripts=" ".join(sorted(hashes)) or "'none'")


def _parts(document: Document) -> Iterator[str]:
    """The sections; those of the appendix in one box, which has columns on paper."""
    for appendix, sections in groupby(document.sections, lambda section: section.kind == "appendix"):
        text = "\n".join(map(_section, sections))
        yield f'<div class="appendix">\n{text}\n</div>' if appendix else text


def _foot(document: Document) -> str:
    """The style of the foot of printed pages: whose they are, and their numbers."""
    if not document.foot:
        return ""
    words = "".join(x if x.isascii() and x.isalnum() else f"\\{ord(x):x} " for x in document.foot)
    return (
        f'@page {{ @bottom-left {{ content: "{words}"; font: 8pt sans-serif; color: #5d6875 }} '
        '@bottom-right { content: counter(page) " / " counter(pages); font: 8pt sans-serif; '
        "color: #5d6875 } }"
    )


def _columns(block: Columns) -> str:
    sides = ("\n".join(_BLOCKS[type(part)](part) for part in side) for side in (block.left, block.right))
    return f'<div class="columns">{"".join(f"<div>{side}</div>" for side in sides)}</div>'


def _section(section: Section) -> str:
    seen = all(isinstance(block, Figure) and block.screen for block in section.blocks)
    word = "screen" if seen else section.kind.removeprefix("appendix")
    kind = f' class="{word}"' if word else ""
    parts = [f"<section{kind}><h2>{escape(section.title)}</h2>"]
    parts += [_BLOCKS[type(block)](block) for block in section.blocks]
    return "\n".join([*parts, "</section>"])


def _paragraph(block: Paragraph) -> str:
    kind = f' class="{block.kind}"' if block.kind else ""
    return f"<p{kind}>{escape(block.text)}</p>"


def _table(block: Table) -> str:
    head = "".join(f'<th scope="col">{escape(name)}</th>' for name in block.columns)
    named = [
        f' data-name="{escape(name)}"' if block.prose and k else "" for k, name in enumerate(block.columns)
    ]
    rows = "\n".join(
        "<tr>"
        + "".join(f"<td{name}>{escape(cell)}</td>" for name, cell in zip(named, row, strict=True))
        + "</tr>"
        for row in block.rows
    )
    caption = f"<caption>{escape(block.caption)}</caption>" if block.caption else ""
    kind = ' class="prose"' if block.prose else ""
    return (
        f'<div class="wide"><table{kind}>{caption}<thead><tr>{head}</tr></thead>\n'
        f"<tbody>{rows}</tbody></table></div>"
    )


def _figure(block: Figure) -> str:
    pictures = []
    for drawing in block.drawings:
        data = base64.b64encode(drawing.png).decode()
        image = f'<img alt="{escape(drawing.title)}" src="data:image/png;base64,{data}">'
        pictures.append(f"<div>{drawing.svg or image}</div>")
    caption = f"<figcaption>{escape(block.caption)}</figcaption>" if block.caption else ""
    grid = "\n".join(pictures)
    alone = len(block.drawings) == 1
    kind = "grid full" if block.columns == 1 else "grid"
    half = alone and block.columns > 1
    columns = 1 if half else block.columns
    kinds = " ".join(name for name, is_one in (("half", half), ("screen", block.screen)) if is_one)
    opened = f'<figure class="{kinds}">' if kinds else "<figure>"
    return f'{opened}<div class="{kind}" style="--columns: {columns}">{grid}</div>{caption}</figure>'


def _tiles(block: Tiles) -> str:
    classes = {True: "tile good", False: "tile bad", None: "tile"}
    tiles = [
        f'<div class="{classes[good]}"><b>{escape(value)}</b><span>{escape(what)}</span></div>'
        for what, value, good in block.items
    ]
    return f'<div class="tiles">{"".join(tiles)}</div>'


def _player(block: Player) -> str:
    """The player may run its own scripts and save pictures, but it is cut off from this page."""
    paper = '<p class="paper note">The player is in the file, not on paper.</p>'
    if block.still:
        data = base64.b64encode(block.still).decode()
        paper = f'<img class="paper" alt="{escape(block.title)}" src="data:image/png;base64,{data}">'
    return (
        f'<iframe title="{escape(block.title)}" sandbox="allow-scripts allow-downloads" loading="eager" '
        f'srcdoc="{escape(block.html)}"></iframe>\n{paper}'
    )


_BLOCKS: dict[type[Block], Callable[[Any], str]] = {
    Paragraph: _paragraph,
    Table: _table,
    Figure: _figure,
    Tiles: _tiles,
    Player: _player,
    Columns: _columns,
}

"""What commands print: tables for people, JSON for machines, progress on long work."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from exo_pin.errors import FormatError

BLOCK = 2000
"""Samples between two steps of a progress bar."""


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], *, note: str = "") -> None:
    """Print a table; the first column is text, the others are numbers."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    drawn = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", caption=note or None)
    drawn.caption_justify = "left"
    for k, name in enumerate(columns):
        drawn.add_column(name, justify="right" if k else "left")
    for row in rows:
        drawn.add_row(*row)
    Console(highlight=False).print(drawn)


def as_json(facts: Any) -> None:
    """Print one JSON object."""
    print(json.dumps(facts, indent=2))


def blocks(n: int, label: str) -> Iterator[slice]:
    """Slices that cover n samples; a progress bar on stderr shows where the work is."""
    parts = [slice(start, min(start + BLOCK, n)) for start in range(0, n, BLOCK)]
    if len(parts) < 3 or not sys.stderr.isatty():
        yield from parts
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(parts, description=label, console=Console(stderr=True), transient=True)


def write(path: Path, text: str) -> None:
    """Write a text file whole or not at all.

    Raises:
        FormatError: It cannot be written.
    """
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        draft.write_text(text, encoding="utf-8")
        draft.replace(path)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise FormatError(path, f"cannot be written: {error.strerror or error}") from None

"""Printing: tables for people, JSON for programs, progress of long work."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TypeVar

from exo_pin.cli.plain_output import unfiltered

Item = TypeVar("Item")

_SAMPLES_A_STEP = 2000
"""Samples between two steps of a progress bar."""

_NARROW = 60
"""Characters of a window below which a table that does not fit becomes a list."""

_ANY_WIDTH = 10_000  # characters: wider than any table

_NUMERIC = set("0123456789-+") | {""}  # how the cells of a column of numbers begin


def table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table; columns of numbers are aligned to the right and only their headings are broken.

    Where a window cannot hold the numbers, lines exceed its width: a number cut short would be wrong. In a
    narrow window the rows become a list.

    Args:
        title: Above the table.
        columns: Headings, with units.
        rows: Cells, as many as there are columns.
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table

    drawn = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for k, name in enumerate(columns):
        numbers = all(row[k][:1] in _NUMERIC for row in rows)
        if k and numbers:
            head = name.replace(" ", "\n")
            drawn.add_column(head, justify="right", no_wrap=True, min_width=_widest(head, rows, k))
        else:
            drawn.add_column(name, no_wrap=not k, min_width=_widest(name, rows, k, words=k > 0))
    for row in rows:
        drawn.add_row(*map(plain, row))
    print(title)
    console = Console(highlight=False)
    least = console.measure(drawn, options=console.options.update(max_width=_ANY_WIDTH)).minimum
    if least > console.width < _NARROW:
        _records(columns, rows, console.width)
        return
    wide = Console(highlight=False, width=max(console.width, least))
    with wide.capture() as text:  # rich itself would end the program with exit code 1 at a closed pipe
        wide.print(drawn, crop=False)
    print(text.get(), end="", file=unfiltered(sys.stdout))  # with our own colours


def _records(columns: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> None:
    """The rows one under the other, each cell with its heading, for a window too narrow for a table."""
    for first, *cells in rows:
        print(plain(first))
        for name, cell in zip(columns[1:], cells, strict=True):
            words = plain(cell).split(" ") if cell[:1] not in _NUMERIC else [plain(cell)]
            for line in _filled([f"{name}:", *words] if name else words, width) if cell else ():
                print(line)


def _filled(words: Sequence[str], width: int) -> Iterator[str]:
    """Lines of whole words, the later ones further in; a longer word has a line of its own."""
    line = " "
    for word in words:
        if len(line) + 1 + len(word) > width and line.strip():
            yield line
            line = "   "
        line += f" {word}"
    yield line


def _widest(heading: str, rows: Sequence[Sequence[str]], k: int, *, words: bool = False) -> int:
    """Characters that column k needs for its longest cell, or for its longest word."""
    cells = heading.split("\n") + [row[k] for row in rows]
    return max(map(len, " ".join(cells).split() if words else cells), default=0)


def fixed(value: float, digits: int = 1) -> str:
    """A number with `digits` decimals, and no minus before a zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def plain(text: str) -> str:
    """The text of a file on one line, without control characters, which a terminal would obey."""
    return "".join(mark if mark.isprintable() else " " for mark in text)


def as_json(facts: Any) -> None:
    """Print one JSON object."""
    print(json.dumps(facts, indent=2))


def blocks(n: int, label: str) -> Iterator[slice]:
    """Slices that cover n samples; a progress bar on stderr shows where the work is."""
    parts = [slice(start, min(start + _SAMPLES_A_STEP, n)) for start in range(0, n, _SAMPLES_A_STEP)]
    return progress(parts, label) if len(parts) > 2 else iter(parts)


@contextmanager
def busy(label: str) -> Iterator[None]:
    """A moving mark on stderr during long work, if that is a terminal."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(f"{label} ..."):
        yield


def progress(items: Iterable[Item], label: str, total: int | None = None) -> Iterator[Item]:
    """The items, with a progress bar on stderr if that is a terminal.

    Args:
        items: To be worked on, one after the other.
        label: Beside the bar.
        total: How many items there are, where they have no length.
    """
    if not sys.stderr.isatty():
        yield from items
        return
    from rich.console import Console
    from rich.progress import track

    yield from track(items, description=label, total=total, console=Console(stderr=True), transient=True)

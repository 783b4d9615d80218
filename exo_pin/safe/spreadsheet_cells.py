"""Texts as cells of a CSV table for spreadsheets, which would calculate those that begin like formulas."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from exo_pin.safe import plain_numbers

_FORMULA = ("=", "+", "-", "@")


def marked(text: str) -> str:
    """The text, with a `'` in front where a spreadsheet would calculate it; numbers stay as they are."""
    if not text.lstrip("'").startswith(_FORMULA):
        return text
    try:
        plain_numbers.number(text)
    except ValueError:
        return f"'{text}"
    return text


def unmarked(cell: str) -> str:
    """The text of a cell that `marked` has made."""
    return cell[1:] if cell.startswith("'") and cell.lstrip("'").startswith(_FORMULA) else cell


def table(rows: Iterable[Iterable[str]]) -> str:
    """Rows of texts as CSV, marked, and quoted where they hold commas."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(map(marked, row) for row in rows)
    return file.getvalue()

"""Parts of the documentation that scripts write: the text between `<!-- name -->` and `<!-- end -->`."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent / "docs"


def replaced(text: str, parts: Mapping[str, str]) -> str:
    """The page with its named parts replaced; each name stands in the page exactly once."""
    for name, part in parts.items():
        block = f"<!-- {name} -->\n{part.strip()}\n<!-- end -->"
        start, end = f"<!-- {name} -->\n", "<!-- end -->"
        assert text.count(start) == 1, name
        before, _, rest = text.partition(start)
        text = before + block + rest.partition(end)[2]
    return text


def rewrite(page: str, parts: Mapping[str, str]) -> None:
    """Replace the named parts of a page of docs/."""
    path = DOCS / page
    path.write_text(replaced(path.read_text(encoding="utf-8"), parts), encoding="utf-8")


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A Markdown table of rows under headings."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def usage(text: str | None) -> None:
    """Print what a script does and end, where it is called with -h or --help: nothing is written then."""
    if {"-h", "--help"} & set(sys.argv[1:]):
        print((text or "").strip())
        sys.exit(0)

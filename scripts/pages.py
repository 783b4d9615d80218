"""Parts of the docs that a script writes: what stands between `<!-- name -->` and `<!-- end -->`."""

import re
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent / "docs"


def rewrite(page, parts):
    """Replace the named parts of a page of docs/ by these texts; each stands there exactly once."""
    path = DOCS / page
    text = path.read_text(encoding="utf-8")
    for name, part in parts.items():
        block = f"<!-- {name} -->\n{part.strip()}\n<!-- end -->"
        pattern = rf"<!-- {re.escape(name)} -->\n.*?<!-- end -->"
        text, found = re.subn(pattern, lambda _, b=block: b, text, flags=re.DOTALL)
        assert found == 1, name
    path.write_text(text, encoding="utf-8")

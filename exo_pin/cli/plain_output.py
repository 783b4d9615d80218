"""Standard output and error without the control characters of files: a terminal would obey them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO, cast

from exo_pin.files import without_control


class _Plain:
    """A text stream that replaces control characters; rich's progress bars write to the stream itself."""

    def __init__(self, stream: TextIO) -> None:
        self.unfiltered = self.rich_proxied_file = stream

    def write(self, text: str) -> int:
        """Write the text, each control character as U+FFFD."""
        self.unfiltered.write(without_control(text))
        return len(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.unfiltered, name)


@contextmanager
def plain_output() -> Iterator[None]:
    """Filter what is printed meanwhile."""
    kept = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = (cast(TextIO, stream and _Plain(stream)) for stream in kept)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = kept


def unfiltered(stream: TextIO) -> TextIO:
    """The stream below, for tables, whose texts are clean already."""
    return cast(TextIO, getattr(stream, "unfiltered", stream))

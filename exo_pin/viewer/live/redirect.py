"""The system's browser, opened by a private file: the token is in no process's arguments."""

from __future__ import annotations

import html
import os
import threading
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from exo_pin import scratch

_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>exo_pin</title>
<meta http-equiv="refresh" content="0; url={url}"></head>
<body><a href="{url}">exo_pin</a></body></html>
"""


@contextmanager
def opened(url: str) -> Iterator[None]:
    """Open the system's browser at an address; the file that leads there lives as long as this context.

    Args:
        url: Address of the page.

    Raises:
        OSError: The file cannot be written.
    """
    with scratch.folder(_readable()) as folder:
        file = folder / "open.html"
        with open(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as page:
            page.write(_PAGE.format(url=html.escape(url)))
        threading.Thread(target=webbrowser.open, args=(file.as_uri(),), daemon=True).start()  # may block
        yield


def _readable() -> Path | None:
    """Where a browser reads files: as a snap it sees the home folder and no temporary files."""
    confined = any(Path("/snap", name).exists() for name in ("firefox", "chromium"))
    return Path.home() if confined else None

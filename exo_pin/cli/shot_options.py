"""Options that picture and film share: the walk, the output file, camera, size and curves."""

from __future__ import annotations

import argparse

from exo_pin.cli import shown_walk
from exo_pin.errors import DescriptionError


def add(parser: argparse.ArgumentParser, *, size: str) -> None:
    """Add the walk, the output file, camera, size, quality and curves.

    Args:
        parser: Of the command.
        size: Default of `--size`, e.g. `"1920x1080"`.
    """
    shown_walk.add(parser)
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the file to write")
    parser.add_argument("--camera", default="iso", help="iso, left, right, front, back, top or feet")
    parser.add_argument("--size", default=size, metavar="WxH", help=f"pixels (default: {size})")
    parser.add_argument("--quality", default="high", help="high: light and shadows (default), or low")
    parser.add_argument("--curves", action="store_true", help="the whole page with the joint curves")
    add_timeout(parser)


def add_timeout(parser: argparse.ArgumentParser) -> None:
    """How long the browser may take."""
    parser.add_argument(
        "--timeout",
        type=float,
        default=60.0,
        metavar="S",
        help="longest wait for the browser: its start, the page, each picture (default: 60 s)",
    )


def pixels(text: str) -> tuple[int, int]:
    """Width and height from `1920x1080`.

    Raises:
        DescriptionError: It is not of that form.
    """
    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise DescriptionError(f"--size is {text!r}; width x height in pixels is accepted, e.g. 1920x1080")
    return int(width), int(height)

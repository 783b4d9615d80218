"""`exo-pin picture`: one moment of the walk as a PNG."""

from __future__ import annotations

import argparse
from pathlib import Path

from exo_pin.cli import shown_walk
from exo_pin.errors import DescriptionError
from exo_pin.files import write_bytes

_EXAMPLES = """examples:
  exo-pin picture -o walk.png
  exo-pin picture walk.mot --phase 0.3 --camera left --size 1280x720 -o left.png
  exo-pin picture free --curves -o page.png      the page with its curves
  exo-pin picture --robot g1 -o g1.png           a humanoid walks

Needs Chromium (e.g. apt install chromium); EXO_PIN_CHROMIUM names another one."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    add_view(parser, size="1920x1080")
    parser.add_argument("--phase", type=float, default=0.0, metavar="P", help="share of the walk, 0 .. 1")


def add_view(parser: argparse.ArgumentParser, *, size: str) -> None:
    """What picture and film share: the walk, the file, camera, size and curves."""
    shown_walk.add(parser)
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the file to write")
    parser.add_argument("--camera", default="iso", help="iso, left, right, front, back, top or feet")
    parser.add_argument("--size", default=size, metavar="WxH", help=f"pixels (default: {size})")
    parser.add_argument("--quality", default="high", help="high: light and shadows (default), or low")
    parser.add_argument("--curves", action="store_true", help="the whole page with the joint curves")


def pixels(text: str) -> tuple[int, int]:
    """Width and height from `1920x1080`.

    Raises:
        DescriptionError: It is not of that form.
    """
    width, _, height = text.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise DescriptionError(f"--size is {text!r}; width x height in pixels is accepted, e.g. 1920x1080")
    return int(width), int(height)


def run(args: argparse.Namespace) -> int:
    """Show and photograph."""
    from exo_pin.viewer.film import shots

    size = pixels(args.size)
    if Path(args.output).suffix.lower() != ".png":
        raise DescriptionError(f"{args.output}: a picture ends in .png")
    scene = shown_walk.scene(args, *shown_walk.read(args))
    view = {"camera": args.camera, "size": size, "curves": args.curves, "quality": args.quality}
    data = shots.picture(scene, phase=args.phase, **view)
    write_bytes(args.output, data)
    print(f"{args.output}: {size[0]} x {size[1]}, {len(data) / 1e3:.0f} kB")
    return 0

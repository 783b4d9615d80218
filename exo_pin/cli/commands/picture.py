"""`exo-pin picture`: one moment of the walk as a PNG."""

from __future__ import annotations

import argparse
from pathlib import Path

from exo_pin.cli import measures, shot_options, show, shown_walk
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
    shot_options.add(parser, size="1920x1080")
    parser.add_argument(
        "--phase", type=measures.share, default=0.0, metavar="P", help="share of the walk, 0.3 or 30%%"
    )


def run(args: argparse.Namespace) -> int:
    """Make the scene and its picture, and write it."""
    from exo_pin.viewer.film import shots

    size = shot_options.pixels(args.size)
    if Path(args.output).suffix.lower() != ".png":
        raise DescriptionError(f"{args.output}: a picture ends in .png")
    scene = shown_walk.scene(args, *shown_walk.read(args))
    with show.busy("picture"):
        data = shots.picture(
            scene,
            phase=args.phase,
            camera=args.camera,
            size=size,
            curves=args.curves,
            quality=args.quality,
            timeout=args.timeout,
        )
    write_bytes(args.output, data)
    print(f"{args.output}: {size[0]} x {size[1]}, {len(data) / 1e3:.0f} kB")
    return 0

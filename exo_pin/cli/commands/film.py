"""`exo-pin film`: the walk as an animation."""

from __future__ import annotations

import argparse
from pathlib import Path

from exo_pin.cli import shot_options, show, shown_walk
from exo_pin.errors import DescriptionError
from exo_pin.files import write_bytes

_EXAMPLES = """examples:
  exo-pin film -o walk.gif
  exo-pin film walk.mot --camera left --size 1280x720 -o walk.webm
  exo-pin film fast --speed 0.5 --curves -o walk.mp4

GIF and WebM need Chromium (e.g. apt install chromium), MP4 ffmpeg besides."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    shot_options.add(parser, size="960x720")
    parser.add_argument("--fps", type=float, default=25.0, help="frames per second (default: 25)")


def run(args: argparse.Namespace) -> int:
    """Show frame by frame and write the film."""
    from exo_pin.viewer.film import shots
    from exo_pin.viewer.film.encode import FILMS

    size = shot_options.pixels(args.size)
    if Path(args.output).suffix.lower() not in FILMS:
        raise DescriptionError(f"{args.output}: a film ends in {', '.join(FILMS)}")
    scene = shown_walk.scene(args, *shown_walk.read(args))
    data = shots.film(
        scene,
        Path(args.output),
        camera=args.camera,
        size=size,
        fps=args.fps,
        curves=args.curves,
        quality=args.quality,
        timeout=args.timeout,
        progress=lambda phases: show.progress(phases, "film"),
    )
    write_bytes(args.output, data)
    print(f"{args.output}: {size[0]} x {size[1]}, {len(data) / 1e6:.2f} MB")
    return 0

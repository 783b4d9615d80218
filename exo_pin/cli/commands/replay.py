"""`exo-pin replay`: the exoskeleton walks a gait, its angles found from the feet's paths."""

from __future__ import annotations

import argparse
import threading

from exo_pin.cli import last_picture, shown_walk
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

_EXAMPLES = """examples:
  exo-pin replay                          the normal walk at free speed, in the browser
  exo-pin replay very_slow --stature 1.6 --speed 0.5
  exo-pin replay walk.mot                 a recording
  exo-pin replay --device lokomat         another device, as near to the feet as it can
  exo-pin replay --robot talos            a humanoid, or --robot my.urdf: any robot with two legs
  exo-pin replay walk.mot --torques id.sto    and the torques that inverse dynamics found
  exo-pin replay --torques own            its own torques, the ground reaction predicted or of --forces
  exo-pin replay walk.mot --html walk.html    one offline file that every browser plays

The feet's paths are computed from the gait, inverse kinematics finds the exoskeleton's angles from the feet,
and these are shown; the gait's own curves are drawn dashed beside them. Ctrl-C ends it. What was shown last
time for the same arguments is shown until this run's own is there (EXO_PIN_CACHE= keeps nothing)."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "--html", metavar="FILE", help="write one offline page instead of opening the browser"
    )
    last_picture.add_address(parser)
    shown_walk.add(parser)


def run(args: argparse.Namespace) -> int:
    """Solve, print the residuals, show."""
    if not 0 <= args.port <= 65535:
        raise DescriptionError(f"--port is {args.port}; 0 .. 65535 is accepted (0: any free one)")
    if args.html is None:
        return _serve(args)
    from exo_pin import viewer

    text = viewer.html(shown_walk.scene(args, *shown_walk.read(args)))
    write_text(args.html, text)
    print(f"{args.html}: {len(text.encode()) / 1e6:.1f} MB, opens in any browser without a network")
    return 0


def _serve(args: argparse.Namespace) -> int:
    """Block until a signal, then leave nothing behind."""
    try:
        given = None if args.server else shown_walk.read(args)  # bad input is refused before a browser opens
        with args.server or last_picture.open_server(args) as server:
            body, gait = given or shown_walk.read(args)
            scene = shown_walk.scene(args, body, gait)  # the browser opens while this is computed
            last_picture.keep(args.words, server.show(scene))
            threading.Event().wait()
    except KeyboardInterrupt:
        pass
    return 0

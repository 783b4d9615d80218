"""`exo-pin replay`: the exoskeleton walks a gait, its angles found from the feet's paths."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from exo_pin.cli import last_picture, shown_walk
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.viewer import Server

_EXAMPLES = """examples:
  exo-pin replay                          the normal walk at free speed, in the browser
  exo-pin replay very_slow --stature 1.6 --speed 0.5
  exo-pin replay walk.mot                 a recording
  exo-pin replay --device lokomat         another device, as near to the feet as it can
  exo-pin replay --robot talos            a humanoid, or --robot my.urdf: any robot with two legs
  exo-pin replay walk.mot --torques id.sto    and the torques that inverse dynamics found
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
    """Block until Ctrl-C or SIGTERM, then leave nothing behind."""
    import signal
    import threading

    for number in (signal.SIGINT, signal.SIGTERM):  # both, also where a shell's `&` has switched Ctrl-C off
        signal.signal(number, signal.default_int_handler)
    try:
        given = None if args.server else shown_walk.read(args)  # bad input is refused before a browser opens
        with args.server or _server(args) as server:
            body, gait = given or shown_walk.read(args)
            scene = shown_walk.scene(args, body, gait)  # the browser opens while this is computed
            last_picture.keep(args.words, server.show(scene))
            _print_address(args, server)
            threading.Event().wait()
    except KeyboardInterrupt:
        pass
    return 0


def _server(args: argparse.Namespace) -> Server:
    from exo_pin import viewer

    opens = not args.no_open and last_picture.has_display()
    return viewer.serve(host=args.host, port=args.port, open_browser=opens)


def _print_address(args: argparse.Namespace, server: Server) -> None:
    """Print where the page is, and warnings about port and host."""
    if args.port and server.port != args.port:
        print(f"port {args.port} is in use: {server.port} is used instead", file=sys.stderr)
    if not server.loopback:
        print(f"warning: {args.host} lets other machines watch; there is no password", file=sys.stderr)
    print(f"{server.url}   Ctrl-C ends it", flush=True)
    if not last_picture.has_display():
        print("no display here: open that address, or write a file with --html walk.html", flush=True)

"""`exo-pin replay`: the exoskeleton walks a gait, its angles found from the feet's paths."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, show
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.crosscheck import Recovery
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot
    from exo_pin.viewer import Scene

_EXAMPLES = """examples:
  exo-pin replay                          the normal walk at free speed, in the browser
  exo-pin replay very_slow --stature 1.6 --speed 0.5
  exo-pin replay walk.mot                 a recording
  exo-pin replay walk.mot --html walk.html    one offline file that every browser plays

The feet's paths are computed from the gait, inverse kinematics finds the exoskeleton's angles from the feet,
and these are shown; the gait's own curves are drawn dashed beside them. Ctrl-C ends it."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument(
        "--html", metavar="FILE", help="write one offline page instead of opening the browser"
    )
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="F", help="playback speed 0.1 .. 2 (default: 1)"
    )
    parser.add_argument(
        "--port", type=int, default=7000, help="port of the page, or the next free one (default: 7000)"
    )
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on (default: this machine only)"
    )
    parser.add_argument("--no-open", action="store_true", help="print the address, open no browser")
    options.add_body(parser)
    options.add_hip_order(parser)


def run(args: argparse.Namespace) -> int:
    """Solve, print the residuals, show."""
    if not 0.1 <= args.speed <= 2:
        raise DescriptionError(f"--speed is {args.speed:g}; 0.1 .. 2 is accepted")
    if not 0 <= args.port <= 65535:
        raise DescriptionError(f"--port is {args.port}; 0 .. 65535 is accepted (0: any free one)")
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    if not args.html:
        return _serve(args, body, gait)
    from exo_pin import viewer

    text = viewer.html(_scene(args, body, gait))
    write_text(args.html, text)
    print(f"{args.html}: {len(text.encode()) / 1e6:.1f} MB, opens in any browser without a network")
    return 0


def _scene(args: argparse.Namespace, body: Body, gait: Gait) -> Scene:
    from exo_pin import crosscheck, viewer
    from exo_pin.robot import load_robot

    robot = load_robot(body, hip_order=args.hip_order)
    gait, note = options.with_events(robot, gait)
    recovery = crosscheck.recover(robot, gait)
    name = Path(args.gait).name
    _print(robot, recovery, name)
    notes = [line for line in (gait.source, note) if line]
    title = f"{name} - exo_pin"
    return viewer.scene(robot, recovery.gait, reference=gait, title=title, notes=notes, speed=args.speed)


def _print(robot: Robot, recovery: Recovery, name: str) -> None:
    """The solver's residuals and what the gait asks beyond the limits."""
    from exo_pin import crosscheck

    track, within = recovery.track, recovery.within
    rows = [
        ["frames", f"{len(track.q)}"],
        ["feet reached", f"{int(track.converged.sum())}"],
        ["largest position error", f"{track.position_error[within].max(initial=0.0):.1e} m"],
        ["largest rotation error", f"{track.rotation_error[within].max(initial=0.0):.1e} rad"],
    ]
    show.table(f"{name} on the exoskeleton", ["inverse kinematics", ""], rows)
    asked = crosscheck.limits(robot, recovery.given)
    for joint, (low, high, frames) in asked.items():
        if frames:
            k = robot.joints.index(joint)
            print(
                f"{joint}: {frames} frames outside its limits: the gait asks {_degrees(low, high)}, "
                f"the joint has {_degrees(robot.lower[k], robot.upper[k])}"
            )


def _degrees(low: float, high: float) -> str:
    from math import degrees

    return f"{show.fixed(degrees(low))} .. {show.fixed(degrees(high))} deg"


def _serve(args: argparse.Namespace, body: Body, gait: Gait) -> int:
    """Block until Ctrl-C or SIGTERM, then leave nothing behind."""
    import signal
    import threading

    from exo_pin import viewer

    done = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: done.set())
    opens = not args.no_open and _display()
    with viewer.serve(host=args.host, port=args.port, open_browser=opens) as server:
        server.show(_scene(args, body, gait))  # the browser opens while this is computed
        if args.port and server.port != args.port:
            print(f"port {args.port} is in use: {server.port} is used instead", file=sys.stderr)
        if not server.loopback:
            print(f"warning: {args.host} lets other machines watch; there is no password", file=sys.stderr)
        print(f"{server.url}   Ctrl-C ends it", flush=True)
        if not _display():
            print("no display here: open that address, or write a file with --html walk.html", flush=True)
        done.wait()
    return 0


def _display() -> bool:
    """Whether this machine can show a browser."""
    import os

    return sys.platform == "darwin" or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))

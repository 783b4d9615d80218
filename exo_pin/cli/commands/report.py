"""`exo-pin report`: one walk as a self-contained page for an engineer or a clinician."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import (
    body_options,
    device_options,
    shot_options,
    show,
    shown_walk,
    trials,
)
from exo_pin.cli.answered_walk import AnsweredWalk, answered
from exo_pin.cli.clock import moment
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.anatomy import Body

_EXAMPLES = """examples:
  exo-pin report -o report.html
  exo-pin report walk.mot --body patient.toml --who "patient 17" -o report.html
  exo-pin report walk.mot --torques inverse_dynamics.sto -o report.html
  exo-pin report walk.mot --normal slow --filter 8 -o report.html
  exo-pin report walk.mot --no-player -o report.html     0.2 MB, for mail and print

The page holds everything and loads nothing; the browser's own "print" makes a PDF of it (with --still, the
model is on paper too)."""

_CUTOFF = 6.0  # [Hz]
_STILL_PHASE = 0.1  # share of the walk that the picture for paper shows
_STILL_SIZE = (1400, 800)  # [px]


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the page to write (.html)")
    parser.add_argument("--title", help="heading (default: the walk's name)")
    parser.add_argument(
        "--who", default="", help="whose walk it is, or who made the report; printed as given"
    )
    parser.add_argument(
        "--normal",
        choices=(*SPEEDS, "none"),
        default="free",
        help="speed of the normative band (default: free)",
    )
    parser.add_argument(
        "--filter",
        type=float,
        default=_CUTOFF,
        metavar="HZ",
        help="low-pass of a recording's velocities and accelerations; 0: none (default: 6)",
    )
    parser.add_argument("--no-player", action="store_true", help="leave the 3-D player out")
    parser.add_argument(
        "--still", action="store_true", help="a picture in the player's place on paper (needs Chromium)"
    )
    shot_options.add_timeout(parser)
    shown_walk.add(parser)


def run(args: argparse.Namespace) -> int:
    """Compute, embed the player, write."""
    from exo_pin import report
    from exo_pin.robot import load_robot

    if Path(args.output).suffix.lower() not in (".html", ".htm"):
        raise DescriptionError(f"{args.output}: a report ends in .html")
    if not (math.isfinite(args.filter) and args.filter >= 0):
        raise DescriptionError(f"--filter is {args.filter:g}; a frequency in Hz, or 0 for none, is accepted")
    body, gait = shown_walk.read(args)
    walk = answered(args, body, gait)
    answer, gait = walk.answer, walk.gait
    device = answer.device.carried()  # the gait itself says where the pelvis is
    robot = load_robot(body, device=device, hip_order=args.hip_order)
    shown = answer.gait if args.torques is None else gait
    if device.locked:
        shown = answer.loss.motion.gait
    device_options.print_answer(answer)
    name = Path(args.gait).name
    info = report.ReportInfo(
        title=args.title or f"Gait report: {name}",
        who=args.who,
        what=name,
        when=moment(),
        choices=_choices(args, walk.events_note),
    )
    player, still = ("", b"") if args.no_player else _player(args, body, walk)
    with show.busy("reporting"):
        document = report.walk(
            robot,
            shown,
            info=info,
            player=player,
            still=still,
            normal=None if args.normal == "none" else args.normal,
            cutoff=args.filter or None,
            torques=walk.shown_torques if device.locked else walk.torques,
            plausibility=walk.plausibility,
            feet=trials.feet(args, walk.robot, gait),
            answer=answer,
        )
        page = report.html(document)
    write_text(args.output, page)
    print(f"{args.output}: {len(page.encode()) / 1e6:.1f} MB, opens in any browser without a network")
    return 0


def _player(args: argparse.Namespace, body: Body, walk: AnsweredWalk) -> tuple[str, bytes]:
    """The offline page as text, and its picture for paper if `--still` is given."""
    from exo_pin import viewer
    from exo_pin.viewer.film import shots

    scene = (
        shown_walk.exoskeleton_scene(args, body, walk)
        if args.robot is None
        else shown_walk.scene(args, body, walk.gait)
    )
    still = (
        shots.picture(scene, phase=_STILL_PHASE, size=_STILL_SIZE, timeout=args.timeout)
        if args.still
        else b""
    )
    return viewer.html(scene), still


def _choices(args: argparse.Namespace, note: str) -> dict[str, str]:
    """The choices of the command line, by name."""
    chosen = {
        "sign preset of the file": args.preset or "none given",
        "columns": ", ".join(args.map) if args.map else "under their own names",
        "body": _body(args),
        "scaling": "angles as given, on the body's own lengths; a normal walk's stride time follows the leg",
        "player": "left out" if args.no_player else f"{args.support} by the support, speed {args.speed:g}",
    }
    more = {"units of the table": args.units, "marker set": args.markers, "note on events": note}
    files = {
        "static trial": args.static,
        "OpenSim model": args.model,
        "torques": args.torques,
        "compared with": args.compare,
    }
    more |= {what: Path(name or "").name for what, name in files.items()}
    return chosen | {name: words for name, words in more.items() if words}


def _body(args: argparse.Namespace) -> str:
    """The source of the body's sizes."""
    return body_options.words(body_options.sized(args))

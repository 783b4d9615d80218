"""`exo-pin report`: a walk, or several side by side, as a self-contained page."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import (
    body_options,
    device_options,
    normal_options,
    report_chapters,
    shot_options,
    show,
    shown_walk,
    trial_reports,
    trials,
)
from exo_pin.cli.answered_walk import AnsweredWalk, answered
from exo_pin.cli.clock import moment
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.clinic import NormalBand
    from exo_pin.report import Document

_EXAMPLES = """examples:
  exo-pin report -o report.html
  exo-pin report walk.mot --body patient.toml --who "patient 17" -o report.html
  exo-pin report trial.c3d --normal ours.csv -o report.html          a band of your own (exo-pin normal)
  exo-pin report walk.mot --forces grf.mot --device lokomat -o report.html
  exo-pin report slow --simulate --bws 0.3 -o report.html            a chapter on control
  exo-pin report walk.mot --no-player --csv numbers.csv -o report.html     0.3 MB, for mail and print
  exo-pin report before.c3d after.c3d -o both.html                   trials over each other, side by side
  exo-pin report session/ -o index.html                              a folder: a row for each trial

The page holds everything and loads nothing; the browser's own "print" makes a PDF of it: two sheets of
answers, one on forces and motors, an appendix (with --still the 3-D picture is on paper too). --csv is every
number of the page in one table. docs/report.md explains the numbers."""

_CUTOFF = 6.0  # [Hz]
_STILL_PHASE = 0.1  # share of the walk that the picture for paper shows
_STILL_SIZE = (1400, 800)  # [px]


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the page to write (.html)")
    parser.add_argument("--csv", metavar="FILE", help="every number of the page in one table (.csv)")
    parser.add_argument("--title", help="heading (default: the walk's name)")
    parser.add_argument(
        "--who", default="", help="whose walk it is, or who made the report; printed as given"
    )
    normal_options.add(parser)
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
    parser.add_argument("--no-forces", action="store_true", help="leave the chapter on forces out")
    report_chapters.add(parser)
    shot_options.add_timeout(parser)
    shown_walk.add(parser)
    parser.add_argument("more", metavar="MORE", nargs="*", help="further trials to compare with the first")


def run(args: argparse.Namespace) -> int:
    """Compute, embed the player, write."""
    from exo_pin import report

    _check(args)
    band = normal_options.band(args)
    if args.more or Path(args.gait).is_dir():
        document = trial_reports.document(args, band)
    else:
        document = _walk(args, band)
    page = report.html(document)
    if args.csv:
        write_text(args.csv, report.csv_of(document))
    write_text(args.output, page)
    print(f"{args.output}: {len(page.encode()) / 1e6:.1f} MB, opens in any browser without a network")
    return 0


def _check(args: argparse.Namespace) -> None:
    """Refuse bad options before any work."""
    if Path(args.output).suffix.lower() not in (".html", ".htm"):
        raise DescriptionError(f"{args.output}: a report ends in .html")
    if args.csv and Path(args.csv).suffix.lower() != ".csv":
        raise DescriptionError(f"{args.csv}: the table of numbers ends in .csv")
    if not (math.isfinite(args.filter) and args.filter >= 0):
        raise DescriptionError(f"--filter is {args.filter:g}; a frequency in Hz, or 0 for none, is accepted")
    report_chapters.check(args)


def _walk(args: argparse.Namespace, band: NormalBand | None) -> Document:
    """The report of one walk."""
    from exo_pin import report
    from exo_pin.clinic import clinical_cycles
    from exo_pin.robot import load_robot

    body, gait = shown_walk.read(args)
    with show.busy("the device's answer"):
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
        session=report_chapters.session(args),
    )
    feet = trials.feet(args, walk.robot, gait)
    player, still = ("", b"") if args.no_player else _player(args, body, walk)
    loads = report_chapters.loads(args, body, gait)
    simulated = report_chapters.simulated(args, body, gait)
    with show.busy("reporting"):
        return report.walk(
            robot,
            shown,
            info=info,
            player=player,
            still=still,
            normal=band,
            cutoff=args.filter or None,
            torques=walk.shown_torques if device.locked else walk.torques,
            plausibility=walk.plausibility,
            feet=feet,
            answer=answer,
            clinical_sides=clinical_cycles(walk.robot, gait, report_chapters.further_angles(args), feet),
            loads=loads,
            run=simulated,
        )


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

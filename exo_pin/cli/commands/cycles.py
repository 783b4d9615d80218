"""`exo-pin cycles`: a walk cut into cycles: mean and spread, spatiotemporal numbers."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from exo_pin.anatomy import SIDES
from exo_pin.cli import body_options, options, show, trials, walk_output
from exo_pin.errors import GaitError
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.gait import Cycles, Gait
    from exo_pin.kinematics import WalkNumbers

_EXAMPLES = """examples:
  exo-pin cycles walk.mot                      numbers of the walk, against those of healthy adults
  exo-pin cycles walk.mot -o cycles.csv        101 points: mean and sd of every joint
  exo-pin cycles walk.mot --mean cycle.mot     the mean cycle as a gait that repeats
  exo-pin cycles walk.c3d --cutoff 6           filtered first (zero-lag Butterworth, order 4)"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="table of mean and sd over the cycle (.csv)")
    parser.add_argument("--mean", metavar="FILE", help="the mean cycle as a gait file")
    parser.add_argument(
        "--side",
        choices=SIDES,
        help="whose heel strikes cut (default: the foot with more of them)",
    )
    parser.add_argument("--cutoff", type=float, metavar="HZ", help="low-pass the angles first")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Cut, print, write."""
    from exo_pin import edit
    from exo_pin.formats import save_gait
    from exo_pin.kinematics import curve_outliers, walk_numbers, with_events
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot, gait = load_robot(body), options.gait_from(args, body)
    judged = options.judged(args, robot, gait)
    outliers = curve_outliers(judged.gait)  # before the filter spreads them
    verdict = judged.verdict
    gait = judged.gait if args.cutoff is None else edit.filtered(gait, cutoff=args.cutoff)
    gait = with_events(robot, gait)
    found = walk_numbers(robot, gait, trials.feet(args, robot, gait))
    cut = _cut(args, gait, found)
    if args.json:
        facts = {"outliers": walk_output.outliers_to_json(outliers), "plausibility": verdict.facts()}
        show.as_json(walk_output.numbers_to_json(gait, found) | {"source": gait.source} | facts)
    else:
        _print(args, cut, gait, found)
        walk_output.print_outliers(outliers)
        walk_output.print_plausibility(verdict)
    if args.output and cut:
        _write(args.output, cut, gait.source)
        if not args.json:
            print(f"{args.output}: {len(cut.percent)} points of {walk_output.count(cut)}")
    if args.mean and cut:
        save_gait(cut.average(f"{gait.source}; mean of {walk_output.count(cut)}"), args.mean)
    return 0


def _cut(args: argparse.Namespace, gait: Gait, found: WalkNumbers) -> Cycles | None:
    """The cycles; None where no foot has a whole one and the numbers are those of an estimated stride.

    Raises:
        GaitError: There is nothing to cut, and it is asked for: a mean cycle, or cycles of one side.
    """
    from exo_pin.gait import cycles, side_with_more_strides

    if found.estimate is None:
        return cycles(gait, args.side or side_with_more_strides(gait))
    wanted = {"--output": args.output, "--mean": args.mean, "--side": args.side}
    for option in (name for name, value in wanted.items() if value):
        raise GaitError(f"{option} needs a whole cycle: {found.estimate}")
    return None


def _rounded(value: float, unit: str) -> str:
    """Lengths and times to the millimetre and millisecond, the rest to a tenth."""
    return show.fixed(value, 3 if unit in ("m", "s", "m/s") else 1)


def _print(args: argparse.Namespace, cut: Cycles | None, gait: Gait, found: WalkNumbers) -> None:
    from exo_pin.kinematics.walk_numbers import ON_THE_MODEL

    sources = walk_output.event_sources(gait)
    print(f"source: {gait.source or 'not stated'}; events: {', '.join(sources)}")
    title = f"{args.gait}: {walk_output.count(cut) if cut else 'an estimated stride'}"
    columns = ["number", "mean", "sd", "n", "usual", "this", "source"]
    show.table(title, columns, [_row(name, found) for name in found.numbers])
    if found.estimate:
        print(f"estimate: {found.estimate}")
    if words := walk_output.manner_words(found):
        print(words)
    for k, citation in enumerate(found.citations.values(), 1):
        print(f"{k}  {citation}")
    of_walks = found.manner == "walk"
    print(f"-  {'no published range was checked' if of_walks else 'published ranges are those of walks'}")
    walk_output.print_measured(found)
    on_model = ON_THE_MODEL in found.measured.values()
    if on_model and args.gait not in SPEEDS and not body_options.sized(args).own_legs:
        print("lengths and width are the default body's: --stature, --hip-width or --body set the person's")
    if cut and cut.outliers:
        print(f"cycles that stand out: {', '.join(str(k + 1) for k in cut.outliers)} of {len(cut)}")
    walk_output.print_left_out(found)


def _row(name: str, found: WalkNumbers) -> list[str]:
    number, usual = found.numbers[name], found.usual.get(name)
    return [
        f"{name.replace('_', ' ')}, {number.unit}",
        _rounded(number.mean, number.unit),
        "-" if math.isnan(number.sd) else _rounded(number.sd, number.unit),
        str(number.n),
        "-" if usual is None else f"{usual.low:.3g} .. {usual.high:.3g}",
        found.verdicts.get(name, "-"),
        "-" if usual is None else str(list(found.citations).index(usual.source) + 1),
    ]


def _write(path: str, cut: Cycles, source: str) -> None:
    import numpy as np

    from exo_pin.anatomy import JOINTS
    from exo_pin.files import write_text

    names = ["percent", *(f"{joint}_{what}_deg" for joint in JOINTS for what in ("mean", "sd"))]
    pairs = np.stack([cut.mean, cut.sd], axis=2).reshape(len(cut.percent), -1)
    rows = np.column_stack([cut.percent, np.degrees(pairs)]).tolist()
    lines = [",".join("" if x != x else repr(x) for x in row) for row in rows]
    head = [f"# {walk_output.count(cut)}, mean and standard deviation", f"# source: {source}"]
    write_text(path, "\n".join([*head, ",".join(names), *lines, ""]))

"""`exo-pin cycles`: a walk cut into cycles: mean and spread as a table, and the walk's numbers."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from exo_pin.anatomy import SIDES
from exo_pin.cli import options, outliers, show, trials
from exo_pin.cli.walk_facts import WalkFacts, walk_facts
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.gait import Cycles

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
    from exo_pin.gait import cycles, side_with_more_strides
    from exo_pin.kinematics import with_events
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot, gait = load_robot(body), options.gait_from(args, body)
    odd = outliers.find(gait)  # before the filter spreads them
    if args.cutoff is not None:
        gait = edit.filtered(gait, cutoff=args.cutoff)
    gait = with_events(robot, gait)
    cut = cycles(gait, args.side or side_with_more_strides(gait))
    facts = walk_facts(robot, gait)
    if args.json:
        show.as_json(facts.to_json() | {"source": gait.source, "outliers": [x.to_json() for x in odd]})
    else:
        _print(args, cut, facts, gait.source)
        outliers.show(odd)
    if args.output:
        _write(args.output, cut, gait.source)
        if not args.json:
            print(f"{args.output}: {len(cut.percent)} points of {count(cut)}")
    if args.mean:
        save_gait(cut.average(f"{gait.source}; mean of {count(cut)}"), args.mean)
    return 0


def count(cut: Cycles) -> str:
    """How many cycles of which foot."""
    return f"{len(cut)} cycle{'s' * (len(cut) != 1)} of the {cut.side} foot"


def _rounded(value: float, unit: str) -> str:
    """Lengths and times to the millimetre and millisecond, the rest to a tenth."""
    return show.fixed(value, 3 if unit in ("m", "s", "m/s") else 1)


def _row(facts: WalkFacts, name: str) -> list[str]:
    """A spatiotemporal number, its usual range, and the number of the range's source."""
    x, usual = facts.numbers[name], facts.usual.get(name)
    return [
        f"{name.replace('_', ' ')}, {x.unit}",
        _rounded(x.mean, x.unit),
        "-" if x.sd != x.sd else _rounded(x.sd, x.unit),
        str(x.n),
        f"{usual.low:.3g} .. {usual.high:.3g}" if usual else "-",
        facts.verdicts.get(name) or "-",
        str(list(facts.citations).index(usual.source) + 1) if usual else "-",
    ]


def _print(args: argparse.Namespace, cut: Cycles, facts: WalkFacts, source: str) -> None:
    print(f"source: {source or 'not stated'}; events: {', '.join(facts.events_by)}")
    from exo_pin.gait.zeni_method import ZENI

    rows = [_row(facts, name) for name in facts.numbers]
    title = f"{args.gait}: {count(cut)}"
    show.table(title, ["number", "mean", "sd", "n", "usual", "this", "source"], rows)
    for k, citation in enumerate(facts.citations.values()):
        print(f"{k + 1}  {citation}")
    print("-  no published range was checked")
    if any(ZENI in by and "plate" not in by for by in facts.events_by):
        print(
            "events by kinematics: strikes are up to 60 ms early, toe-offs late, so stance and double support"
        )
        print("come out too long; --forces sets them by force plates")
    if args.gait not in SPEEDS and not trials.sized(args):
        print("lengths and width are the default body's: --stature, --hip-width or --body tell the person's")
    if cut.outliers:
        print(f"cycles that stand out: {', '.join(str(k + 1) for k in cut.outliers)} of {len(cut)}")
    facts.print_left_out()


def _write(path: str, cut: Cycles, source: str) -> None:
    import numpy as np

    from exo_pin.anatomy import JOINTS
    from exo_pin.files import write_text

    names = ["percent", *(f"{joint}_{what}_deg" for joint in JOINTS for what in ("mean", "sd"))]
    pairs = np.stack([cut.mean, cut.sd], axis=2).reshape(len(cut.percent), -1)
    rows = np.column_stack([cut.percent, np.degrees(pairs)]).tolist()
    lines = [",".join("" if x != x else repr(x) for x in row) for row in rows]
    head = [f"# {count(cut)}, mean and standard deviation", f"# source: {source}"]
    write_text(path, "\n".join([*head, ",".join(names), *lines, ""]))

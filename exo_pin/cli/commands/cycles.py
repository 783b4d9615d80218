"""`exo-pin cycles`: a walk cut into cycles: mean and spread as a table, and the walk's numbers."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import SIDES
from exo_pin.cli import options, outliers, show, trials
from exo_pin.errors import GaitError
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.gait import Cycles, Gait
    from exo_pin.robot import Robot

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
    odd = outliers.facts(gait)  # before the filter spreads them
    if args.cutoff is not None:
        gait = edit.filtered(gait, cutoff=args.cutoff)
    gait = with_events(robot, gait)
    cut = cycles(gait, args.side or side_with_more_strides(gait))
    found = facts(robot, gait) | {"source": gait.source, "outliers": odd}
    if args.json:
        show.as_json(found)
    else:
        _print(args, cut, found)
    if args.output:
        _write(args.output, cut, gait.source)
        if not args.json:
            print(f"{args.output}: {len(cut.percent)} points of {count(cut)}")
    if args.mean:
        save_gait(cut.average(f"{gait.source}; mean of {count(cut)}"), args.mean)
    return 0


def facts(robot: Robot, gait: Gait) -> dict[str, Any]:
    """Cycles by side, spans that are none and why, the spatiotemporal numbers; or why there are none."""
    from exo_pin.gait import against_normal, normal, strides
    from exo_pin.gait.reference_values import CITATIONS
    from exo_pin.kinematics import spatiotemporal

    none: dict[str, Any] = {
        "events_by": sorted({e.source or "not stated" for e in gait.events}),
        "cycles": {},
        "left_out": [],
        "spatiotemporal": {},
        "sources": {},
    }
    try:
        numbers = spatiotemporal(robot, gait)
    except GaitError as error:
        return none | {"no_cycles": str(error)}
    spans = [span for side in SIDES for span in strides(gait, side)]
    legs = robot.body.leg_length if robot.body else float("nan")
    usual, verdicts = normal(numbers, leg_length=legs), against_normal(numbers, leg_length=legs)
    return none | {
        "cycles": {side: sum(span.side == side and not span.why for span in spans) for side in SIDES},
        "left_out": [
            {"side": x.side, "start_s": x.start, "end_s": x.end, "why": x.why} for x in spans if x.why
        ],
        "spatiotemporal": {
            name: {
                "mean": x.mean,
                "sd": None if x.sd != x.sd else x.sd,
                "n": x.n,
                "unit": x.unit,
                "normal": verdicts.get(name),
                "usual": usual[name]._asdict() if name in usual else None,
            }
            for name, x in numbers.items()
        },
        "sources": {key: CITATIONS[key] for key in CITATIONS if key in {x.source for x in usual.values()}},
        "no_cycles": "",
    }


def print_left_out(found: dict[str, Any]) -> None:
    """Spans between heel strikes that are no strides, and why."""
    for span in found["left_out"]:
        print(f"left out: {span['side']} {span['start_s']:.2f} .. {span['end_s']:.2f} s: {span['why']}")


def count(cut: Cycles) -> str:
    """How many cycles of which foot."""
    return f"{len(cut)} cycle{'s' * (len(cut) != 1)} of the {cut.side} foot"


def _rounded(value: float, unit: str) -> str:
    """Lengths and times to the millimetre and millisecond, the rest to a tenth."""
    return show.fixed(value, 3 if unit in ("m", "s", "m/s") else 1)


def _print(args: argparse.Namespace, cut: Cycles, found: dict[str, Any]) -> None:
    print(f"source: {found['source'] or 'not stated'}; events: {', '.join(found['events_by'])}")
    from exo_pin.gait.zeni_method import ZENI

    sources = list(found["sources"])
    rows = [
        [
            f"{name.replace('_', ' ')}, {x['unit']}",
            _rounded(x["mean"], x["unit"]),
            "-" if x["sd"] is None else _rounded(x["sd"], x["unit"]),
            str(x["n"]),
            f"{x['usual']['low']:.3g} .. {x['usual']['high']:.3g}" if x["usual"] else "-",
            x["normal"] or "-",
            str(sources.index(x["usual"]["source"]) + 1) if x["usual"] else "-",
        ]
        for name, x in found["spatiotemporal"].items()
    ]
    title = f"{args.gait}: {count(cut)}"
    show.table(title, ["number", "mean", "sd", "n", "usual", "this", "source"], rows)
    for k, citation in enumerate(found["sources"].values()):
        print(f"{k + 1}  {citation}")
    print("-  no published range was checked")
    if any(ZENI in by and "plate" not in by for by in found["events_by"]):
        print(
            "events by kinematics: strikes are up to 60 ms early, toe-offs late, so stance and double support"
        )
        print("come out too long; --forces sets them by force plates")
    if args.gait not in SPEEDS and not trials.sized(args):
        print("lengths and width are the default body's: --stature, --hip-width or --body tell the person's")
    if cut.outliers:
        print(f"cycles that stand out: {', '.join(str(k + 1) for k in cut.outliers)} of {len(cut)}")
    print_left_out(found)
    outliers.show(found["outliers"])


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

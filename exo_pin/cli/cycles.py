"""`exo-pin cycles`: a walk cut into cycles: mean and spread as a table, and the walk's numbers."""

from __future__ import annotations

import argparse
import dataclasses
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import SIDES
from exo_pin.cli import options, show
from exo_pin.errors import GaitError

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
        "--side", choices=SIDES, default="left", help="whose heel strikes cut (default: left)"
    )
    parser.add_argument("--cutoff", type=float, metavar="HZ", help="low-pass the angles first")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Cut, print, write."""
    from exo_pin import edit
    from exo_pin.formats import save_gait
    from exo_pin.gait import cycles
    from exo_pin.kinematics import events
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot, gait = load_robot(body), options.gait_from(args, body)
    if args.cutoff is not None:
        gait = edit.filtered(gait, cutoff=args.cutoff)
    if not gait.events:
        gait = dataclasses.replace(gait, events=events(robot, gait))
    cut = cycles(gait, args.side)
    found = facts(robot, gait)
    if args.json:
        show.as_json(found)
    else:
        _print(args, cut, found)
    if args.output:
        _write(args.output, cut, gait.source)
    if args.mean:
        save_gait(cut.average(f"{gait.source}; mean of {len(cut)} {args.side} cycles"), args.mean)
    return 0


def facts(robot: Robot, gait: Gait) -> dict[str, Any]:
    """Number of cycles by side and the spatiotemporal numbers; empty where there are no cycles."""
    from exo_pin.gait import against_normal, cycles
    from exo_pin.kinematics import spatiotemporal

    try:
        numbers = spatiotemporal(robot, gait)
    except GaitError:
        return {"cycles": {}, "spatiotemporal": {}}
    counts = {}
    for side in SIDES:
        try:
            counts[side] = len(cycles(gait, side))
        except GaitError:
            counts[side] = 0
    usual = against_normal(numbers)
    return {
        "cycles": counts,
        "spatiotemporal": {
            name: {
                "mean": x.mean,
                "sd": None if x.sd != x.sd else x.sd,
                "n": x.n,
                "unit": x.unit,
                "normal": usual.get(name),
            }
            for name, x in numbers.items()
        },
    }


def _print(args: argparse.Namespace, cut: Cycles, found: dict[str, Any]) -> None:
    from exo_pin.gait.spatiotemporal import NORMAL_SOURCE

    rows = [
        [
            name,
            f"{x['mean']:.3f}",
            "-" if x["sd"] is None else f"{x['sd']:.3f}",
            str(x["n"]),
            x["unit"],
            x["normal"] or "",
        ]
        for name, x in found["spatiotemporal"].items()
    ]
    title = f"{args.gait}: {len(cut)} cycles of the {cut.side} foot"
    show.table(title, ["number", "mean", "sd", "n", "unit", "usual range"], rows)
    print(f"usual: {NORMAL_SOURCE}")
    if cut.outliers:
        print(f"cycles that stand out: {', '.join(str(k + 1) for k in cut.outliers)} of {len(cut)}")
    if cut.skipped:
        print(f"left out, too long: strides from {', '.join(f'{t:.2f}' for t in cut.skipped)} s")


def _write(path: str, cut: Cycles, source: str) -> None:
    import numpy as np

    from exo_pin.anatomy import JOINTS
    from exo_pin.files import write_text

    names = ["percent", *(f"{joint}_{what}_deg" for joint in JOINTS for what in ("mean", "sd"))]
    pairs = np.stack([cut.mean, cut.sd], axis=2).reshape(len(cut.percent), -1)
    rows = np.column_stack([cut.percent, np.degrees(pairs)]).tolist()
    lines = [",".join("" if x != x else repr(x) for x in row) for row in rows]
    head = [f"# {len(cut)} cycles of the {cut.side} foot, mean and standard deviation", f"# source: {source}"]
    write_text(path, "\n".join([*head, ",".join(names), *lines, ""]))
    print(f"{path}: {len(cut.percent)} points of {len(cut)} cycles")

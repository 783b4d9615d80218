"""`exo-pin study --simulate`: how often a simulated walk walks, over conditions and seeds."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from exo_pin.cli import measures, show, stopping
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.study import Share, SimulatedStudy
    from exo_pin.study.simulated_case import SimulatedCase, SimulatedOutcome

SIMULATED_FILE = "simulated.csv"
"""The table if no other is named."""

_LISTS = {
    "supports": ("NAME", "soft, stiff, stand, none (default: soft)"),
    "bws": ("B", "body-weight supports, 0 to below 1 (default: 0)"),
    "controllers": ("NAME", "as of `exo-pin simulate`, or file.py:Class (default: pd)"),
    "patients": ("NAME", "none, healthy, paretic_right, plegic or a TOML file (default: none)"),
    "delays": ("S", "from measurement to torque [s] (default: 0)"),
    "frictions": ("MU", "of the floor (default: 0.8)"),
    "mass_errors": ("PART", "the machine is heavier than its model by this part (default: 0)"),
}
"""Option with several values -> unit and help."""

_NUMBERS = {"bws", "delays", "frictions", "mass_errors"}

_SINGLE = ("runs", "seed", "cycles", "timestep", "spread")

_ARGUMENTS = {
    "bws": "body_weight_supports",
    "frictions": "floor_frictions",
}
"""Option -> argument of `exo_pin.study.simulations`, where that has another name."""

_OTHERS = ("recordings", "page", "statures", "step", "preset")
"""Options of the study of devices alone."""


def add(parser: argparse.ArgumentParser) -> None:
    """The options of a simulated study."""
    group = parser.add_argument_group("simulated runs (docs/study.md)")
    group.add_argument(
        "--simulate", action="store_true", help="simulate --speeds on --devices; the share that walks"
    )
    group.add_argument("--runs", type=int, metavar="N", help="seeds of each condition (default: 50)")
    for name, (unit, words) in _LISTS.items():
        group.add_argument(f"--{name.replace('_', '-')}", nargs="+", metavar=unit, help=words)
    group.add_argument("--cycles", type=int, metavar="N", help="of each run (default: 10)")
    group.add_argument("--timestep", type=measures.number, metavar="S", help="[s] (default: 0.001)")
    group.add_argument("--seed", type=int, metavar="K", help="the first (default: 0)")
    group.add_argument(
        "--spread",
        type=measures.number,
        metavar="X",
        help="how far the machines of the runs differ (default: 1)",
    )


def check(args: argparse.Namespace) -> None:
    """Refuse options of one kind of study in the other.

    Raises:
        DescriptionError: There is one.
    """
    mine = [*_LISTS, *_SINGLE]
    wrong = _OTHERS if args.simulate else mine
    for name in wrong:
        if getattr(args, name) is not None:
            why = "is not for --simulate" if args.simulate else "is for --simulate"
            raise DescriptionError(f"--{name.replace('_', '-')} {why}")


def run(args: argparse.Namespace) -> int:
    """Simulate, write, print; 0 if all conditions were simulated, 1 if some were not, 2 if none."""
    from exo_pin import study

    cases, start = _plan(args), time.perf_counter()
    try:
        done = study.run_simulations(
            cases, args.output, jobs=args.jobs, restart=args.restart, progress=_progress
        )
    except KeyboardInterrupt as stop:
        left = study.part(args.output)
        print(f"stopped; finished runs are in {left}, and the same command continues", file=sys.stderr)
        return stopping.exit_code(stop)
    for remark in done.remarks:
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    shares, seconds = study.walking_shares(done.rows), time.perf_counter() - start
    if args.json:
        show.as_json(_to_json(args.output, done, shares, seconds))
    elif done.rows:
        show.table("Runs that walk; the interval is that of 95 % (Wilson)", *_table(shares))
        print(f"{args.output}: {len(done.rows)} runs ({done.kept} of them from before), {seconds:.1f} s")
    return (1 if done.rows else 2) if done.failures else 0


def _plan(args: argparse.Namespace) -> list[SimulatedCase]:
    from exo_pin import study
    from exo_pin.anatomy import Body

    given: dict[str, Any] = {}
    for name in _LISTS:
        values = getattr(args, name)
        if values is not None:  # a comma within a number is a decimal one
            numeric = name in _NUMBERS
            listed = [_number(name, text) for text in values] if numeric else measures.listed(values)
            given[_ARGUMENTS.get(name, name)] = listed
    given |= {name: getattr(args, name) for name in _SINGLE if getattr(args, name) is not None}
    given |= {"speeds": args.speeds} if args.speeds else {}
    given |= {"devices": measures.listed(args.devices)} if args.devices else {}
    given |= {"body": Body.load(args.body)} if args.body else {}
    return study.simulations(**given)


def _number(option: str, text: str) -> float:
    try:
        return measures.number(text)
    except ValueError:
        raise DescriptionError(f"--{option.replace('_', '-')}: {text!r:.40} is not a number") from None


def _progress(outcomes: Iterable[SimulatedOutcome], total: int) -> Iterator[SimulatedOutcome]:
    """A bar, and a line for each condition that cannot be simulated."""
    for outcome in show.progress(outcomes, "simulating", total):
        if outcome.failure:
            print(f"left out: {show.plain(outcome.failure)}", file=sys.stderr)
        yield outcome


def _table(shares: list[Share]) -> tuple[tuple[str, ...], list[list[str]]]:
    """Headings and rows; of the conditions those that differ, and the speed."""
    names = [
        name
        for name in shares[0].conditions
        if name == "gait" or len({share.conditions[name] for share in shares}) > 1
    ]
    rows = [
        [
            *[_cell(share.conditions[name]) for name in names],
            str(share.runs),
            str(share.verdicts.get("walks", 0)),
            f"{share.share:.2f}",
            f"{share.low:.2f} - {share.high:.2f}",
            show.fixed(share.tracking_rms_deg, 2),
        ]
        for share in shares
    ]
    heads = [name.replace("_", " ") for name in names]
    return (*heads, "runs", "walk", "share", "interval", "rms deg"), rows


def _cell(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else show.plain(str(value))


def _to_json(table: str, done: SimulatedStudy, shares: list[Share], seconds: float) -> dict[str, Any]:
    return {
        "table": table if done.rows else None,
        "rows": len(done.rows),
        "computed": done.computed,
        "kept": done.kept,
        "conditions": [asdict(share) for share in shares],
        "left_out": list(done.failures),
        "remarks": list(done.remarks),
        "seconds": round(seconds, 3),
    }

"""`exo-pin study`: all devices under many walks and on many bodies: a table and a page of figures."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import Body
from exo_pin.anatomy.names import PelvisMotion
from exo_pin.cli import measures, options, show, simulated_study, stopping
from exo_pin.cli.clock import moment
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.study import Case, Outcome, Study

_EXAMPLES = """examples:
  exo-pin study                                 9 devices, 5 speeds, 10 statures; study.csv and study.html
  exo-pin study --jobs 2 --step 0.01            finer, on two cores
  exo-pin study --speeds free --devices exo12 lokomat mine.toml --pelvis recorded -o mine.csv
  exo-pin study --recordings walks -o walks.csv        every recording in a folder
  exo-pin study --simulate --runs 50 --patients none plegic --delays 0 0.005     the share that walks

The same command continues a study that was interrupted. A finished study may get more devices, speeds,
statures or recordings: existing rows are not computed again, unless they were edited or made by another
exo_pin; a note says so. A recording that cannot be used is reported in a
line and left out; the exit code is then 1. docs/study.md explains the columns, and how the same study runs on
a cluster."""

_PELVIS: dict[str, tuple[PelvisMotion, ...]] = {
    "recorded": ("recorded",),
    "device": ("device",),
    "both": ("recorded", "device"),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="the table (default: study.csv; simulated.csv)"
    )
    parser.add_argument("--page", metavar="FILE", help="the figures (default: the table's name with .html)")
    parser.add_argument("--no-page", action="store_true", help="the table alone")
    parser.add_argument("--json", action="store_true", help="print the summary as one JSON object")
    parser.add_argument("--restart", action="store_true", help="leave the rows of an earlier study behind")
    parser.add_argument(
        "--jobs", type=int, default=1, metavar="N", help="processes; -1: one per core (default: 1)"
    )
    _configure_plan(parser)
    simulated_study.add(parser)


def _configure_plan(parser: argparse.ArgumentParser) -> None:
    plan = parser.add_argument_group("what is studied")
    plan.add_argument("--devices", nargs="+", metavar="DEVICE", help="names or device files (default: all)")
    plan.add_argument("--speeds", nargs="+", choices=SPEEDS, help="of the normal walk (default: all five)")
    plan.add_argument(
        "--statures", nargs=2, type=measures.metres, metavar=("LOW", "HIGH"), help="[m] (default: 1.50 1.95)"
    )
    plan.add_argument(
        "--step", type=measures.metres, metavar="M", help="between statures [m] (default: 0.05)"
    )
    plan.add_argument(
        "--mass", type=measures.kilograms, metavar="KG", help="of every person (default: as stature squared)"
    )
    plan.add_argument("--sex", choices=("male", "female"), default="male", help="whose segment masses")
    plan.add_argument(
        "--pelvis",
        choices=_PELVIS,
        default="both",
        help="who moves the pelvis: the recorded walk, each device as it can, or both in turn (default)",
    )
    plan.add_argument("--passive", choices=("held", "released"), default="held", help="passive joints")
    plan.add_argument(
        "--recordings",
        metavar="DIR",
        help="every recording in this folder and those below, instead of the normal walk (unless --speeds)",
    )
    options.add_preset(plan, "sign convention of recordings that do not tell it")
    plan.add_argument(
        "--body",
        metavar="FILE",
        help="who wears the recordings (default: the body that a marker trial is solved on, else 1.75 m; or "
        "every one of --statures)",
    )


def run(args: argparse.Namespace) -> int:
    """Study, write, print."""
    from exo_pin import study

    simulated_study.check(args)
    args.output = args.output or (simulated_study.SIMULATED_FILE if args.simulate else "study.csv")
    _check_names(args)
    if args.simulate:
        return simulated_study.run(args)
    cases, start = _plan(args), time.perf_counter()
    try:
        done = study.run(cases, args.output, jobs=args.jobs, restart=args.restart, progress=_progress)
    except KeyboardInterrupt as stop:
        left = study.part(args.output)
        print(f"stopped; finished rows are in {left}, and the same command continues", file=sys.stderr)
        return stopping.exit_code(stop)
    for remark in done.remarks:
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    page = "" if args.no_page or not done.rows else _write_page(args, done)
    seconds = time.perf_counter() - start
    if args.json:
        show.as_json(_to_json(args.output, done, cases=len(cases), page=page, seconds=seconds))
    else:
        _print(args.output, done, page=page, seconds=seconds)
    return (1 if done.rows else 2) if done.failures else 0


def _check_names(args: argparse.Namespace) -> None:
    if Path(args.output).suffix.lower() != ".csv":
        raise DescriptionError(f"{args.output}: the table of a study ends in .csv")
    if args.page is not None and Path(args.page).suffix.lower() not in (".html", ".htm"):
        raise DescriptionError(f"{args.page}: the page of a study ends in .html")
    if args.recordings and Path(args.recordings).resolve() in Path(args.output).resolve().parents:
        why = "the next run would take the table for a recording; choose another place for it"
        raise DescriptionError(f"{args.output} is in the folder of the recordings: {why}")
    if args.body and not (args.recordings or args.simulate):
        raise DescriptionError("--body is for --recordings; the normal walk is studied on --statures")
    if args.body and args.statures:
        raise DescriptionError("--body and --statures exclude each other: both set who wears the recordings")


def _plan(args: argparse.Namespace) -> list[Case]:
    from exo_pin import devices, study
    from exo_pin.compare import Conditions

    common: dict[str, Any] = {
        "devices": measures.listed(args.devices or ()) or tuple(devices.DEVICES),
        "conditions": [Conditions(pelvis, args.passive) for pelvis in _PELVIS[args.pelvis]],
    }
    on_statures = args.statures is not None or args.step is not None
    low, high = args.statures or study.STATURE_RANGE
    of = study.statures(low, high, study.STATURE_STEP if args.step is None else args.step)
    cases = []
    if args.recordings:
        on: list[Body | None] = [Body.load(args.body)] if args.body else [None]
        if on_statures:
            on = list(study.bodies(of, mass=args.mass, sex=args.sex))
        cases += study.recordings(args.recordings, on, preset=args.preset, **common)
    if args.speeds or not args.recordings:
        cases += study.plan(args.speeds or SPEEDS, of, mass=args.mass, sex=args.sex, **common)
    return cases


def _progress(outcomes: Iterable[Outcome], total: int) -> Iterator[Outcome]:
    """A bar, and a line for each recording that cannot be used."""
    for outcome in show.progress(outcomes, "studying", total):
        if outcome.failure:
            print(f"left out: {outcome.failure}", file=sys.stderr)
        yield outcome


def _write_page(args: argparse.Namespace, done: Study) -> str:
    from exo_pin import report

    page = args.page or str(Path(args.output).with_suffix(".html"))
    write_text(page, report.html(report.study(done.rows, failures=done.failures, when=moment())))
    return page


def _to_json(table: str, done: Study, *, cases: int, page: str, seconds: float) -> dict[str, Any]:
    return {
        "table": table if done.rows else None,
        "page": page or None,
        "walks": done.walks,
        "devices": done.devices,
        "rows": len(done.rows),
        "computed": done.computed,
        "kept": done.kept,
        "cases": cases,
        "left_out": done.failures,
        "remarks": list(done.remarks),
        "seconds": round(seconds, 3),
    }


def _print(table: str, done: Study, *, page: str, seconds: float) -> None:
    if not done.rows:
        print("nothing could be used", file=sys.stderr)
        return
    from exo_pin import study

    show.table("Sole error, best motion [mm]", *study.summary(done.rows))
    print(
        f"{table}: {len(done.rows)} rows ({done.kept} of them from before), {done.walks} walks, "
        f"{done.devices} devices, {seconds:.1f} s"
    )
    if page:
        print(f"{page}: the figures, opens in any browser without a network")
    if done.failures:
        print(f"{len(done.failures)} left out (see above)")

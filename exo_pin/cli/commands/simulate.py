"""`exo-pin simulate`: the exoskeleton walks by torques, under a controller, with a patient in it."""

from __future__ import annotations

import argparse
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.cli import (
    last_picture,
    missing,
    options,
    show,
    simulated_scene,
    simulation_options,
    simulation_output,
)
from exo_pin.errors import DescriptionError, GaitError
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot
    from exo_pin.simulation import Run
    from exo_pin.viewer import Scene

_EXAMPLES = """examples:
  exo-pin simulate                                  the normal walk by torques, in the browser
  exo-pin simulate slow --bws 0.4 --patient plegic --json
  exo-pin simulate slow --controller my.py:MyController --patient me.toml
  exo-pin simulate free --delay 0.002 --mass-error 0.1 --html run.html
  exo-pin simulate slow --device lokomat --support stand -o run.csv
  exo-pin simulate slow --patient plegic --controller pd,impedance --html both.html     side by side
  exo-pin simulate slow --bws 0.4 --controller all --patient all --table

MuJoCo computes the motion; the walk is seen by controller and support alone. docs/simulate.md defines every
number and shows how to write a controller and a patient. A controller's file is run as it is, not in a
sandbox. With two runs the second is the first's ghost. exit code 0: it walks; 1: it stumbles, falls or
diverges; of several runs: 0 once all were simulated"""

_MOST_SHOWN = 2


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument(
        "--device", default="exo12", metavar="DEVICE", help="name or device file (default: exo12)"
    )
    simulation_options.add(parser)
    parser.add_argument("--table", action="store_true", help="print the table of the runs, show nothing")
    parser.add_argument(
        "--html", metavar="FILE", help="write one offline page instead of opening the browser"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="write the simulated walk (.csv .mot .sto .npz ...)"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    last_picture.add_address(parser)
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Simulate, print, show; 0 if it walks, else 1."""
    if not 0 <= args.port <= 65535:
        raise DescriptionError(f"--port is {args.port}; 0 .. 65535 is accepted (0: any free one)")
    drives, people = simulation_options.controllers(args), simulation_options.patients(args)
    _check(args, len(drives) * len(people))
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    from exo_pin.robot import load_robot

    robot = load_robot(body, device=args.device)
    walk = _with_stance(load_robot(body), gait, args.gait)
    if args.cycles is not None and not gait.periodic:
        raise DescriptionError(
            f"--cycles is for a walk that repeats; {args.gait} is a recording, walked once"
        )
    what = f"{show.plain(Path(args.gait).name)} on {show.plain(Path(args.device).stem)}"
    found = _Results([], [], [], [])
    for done in _runs(args, robot, walk, drives, people):
        found.add(done, keep=len(drives) * len(people) <= _MOST_SHOWN, json=args.json)
    _print(args, found, what)
    _write(args, found.runs, what)
    if not (args.table or args.json or args.html or args.output) and found.runs:
        _serve(args, found.runs, what)
    return 0 if len(found.words) > 1 or found.words[0] == "walks" else 1


@dataclass(frozen=True, eq=False)
class _Results:
    """What is printed of every run, and one or two runs themselves: a run holds some 30 MB.

    Attributes:
        words: The verdicts.
        rows: Of the table.
        facts: For JSON, if asked for.
        runs: Those that are shown.
    """

    words: list[str]
    rows: list[list[str]]
    facts: list[dict[str, Any]]
    runs: list[Run]

    def add(self, run: Run, *, keep: bool, json: bool) -> None:
        """Take what is printed of a run; keep the run itself, or not."""
        self.words.append(run.verdict.word)
        self.rows.append(simulation_output.row(run))
        self.facts.extend([run.facts()] if json else [])
        self.runs.extend([run] if keep else [])


def _check(args: argparse.Namespace, n: int) -> None:
    """Refuse what several runs cannot do, before any is computed."""
    if args.html and n > _MOST_SHOWN:
        raise DescriptionError(f"--html shows one run or two beside each other; these are {n}")
    if args.output and n > 1:
        raise DescriptionError(f"-o writes one simulated walk; these are {n}")


def _with_stance(person: Robot, gait: Gait, name: str) -> Gait:
    """The walk with events, which tell stance and swing apart.

    Raises:
        GaitError: There are none, and the motion shows none.
    """
    found, why = options.with_events(person, gait)
    if why:
        raise GaitError(f"{Path(name).name} has no stance to be simulated. {why}")
    return found


def _runs(
    args: argparse.Namespace, robot: Robot, gait: Gait, drives: list[str], people: list[str | None]
) -> Iterator[Run]:
    """All controllers with all patients; names and files are looked at before the first run."""
    from exo_pin.control import find_controller, find_patient
    from exo_pin.simulation import simulate

    conditions = simulation_options.conditions(args)
    patients = [None if name is None else find_patient(name) for name in people]
    for drive in drives:
        find_controller(drive)
    for drive, patient in product(drives, patients):
        who = "no patient" if patient is None else patient.name
        with simulation_output.progress(f"{drive}, {who}") as bar:
            run = simulate(robot, gait, drive, patient=patient, after=bar, **conditions)
        yield run


def _print(args: argparse.Namespace, found: _Results, what: str) -> None:
    """JSON, the table, or one run in words."""
    single = len(found.words) == 1 and not args.table
    if args.json:
        show.as_json(found.facts[0] if single else {"runs": found.facts})
    elif single:
        simulation_output.print_run(found.runs[0], what)
    else:
        held = f"{what}, support {args.support}, body-weight support {args.bws:g}"
        show.table(f"{held}; left / right leg", simulation_output.RUN_COLUMNS, found.rows)


def _write(args: argparse.Namespace, runs: list[Run], what: str) -> None:
    """The files that are asked for; a line for each, on the terminal alone where JSON is printed."""
    lines = []
    if args.output:
        from exo_pin.formats import save_gait
        from exo_pin.simulation import walked

        gait = walked(runs[0])
        save_gait(gait, args.output)
        lines.append(f"{args.output}: {len(gait)} samples, {gait.duration:.3f} s")
    if args.html:
        from exo_pin import viewer

        text = viewer.html(_scene(runs, what))
        write_text(args.html, text)
        lines.append(
            f"{args.html}: {len(text.encode()) / 1e6:.1f} MB, opens in any browser without a network"
        )
    for line in lines * (not args.json):
        print(line)


def _serve(args: argparse.Namespace, runs: list[Run], what: str) -> None:
    """Show the runs in the browser until a signal."""
    try:
        with last_picture.open_server(args) as server:
            server.show(_scene(runs, what))
            threading.Event().wait()
    except KeyboardInterrupt:
        pass


def _scene(runs: list[Run], what: str) -> Scene:
    """The run; with two the second as the ghost of the first."""
    if runs[0].robot.body is not None and runs[0].robot.body.wearer:
        missing.note_without_figure()
    return simulated_scene.scene(runs[0], what, other=runs[1] if len(runs) > 1 else None)

"""`exo-pin compare`: one walk on many devices, and the loss of each."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.cli import measures, options, show, torque_options
from exo_pin.cli.clock import moment
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.compare import Comparison

_EXAMPLES = """examples:
  exo-pin compare                                all devices under the normal walk
  exo-pin compare walk.mot --devices lokomat lopes8 mine.toml
  exo-pin compare fast --pelvis device           each pelvis as its device holds it
  exo-pin compare --passive released             passive joints move as it suits the feet
  exo-pin compare -o report.html                 one page: the motion behind every number, the five speeds
  exo-pin compare -o table.md                    also .csv and .json
  exo-pin compare very_fast --torques own        the torque and power of every motor as well

For every device: the best motion towards the recorded feet (least squares over the corners of the soles,
within the joints' ranges, speeds and accelerations), and the plain copy of its joints. docs/devices.md
explains the columns."""

_SAMPLES = 500  # of a recording are enough to compare choices of joints


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument(
        "--devices", nargs="+", metavar="DEVICE", help="names or device files (default: all of them)"
    )
    parser.add_argument(
        "--pelvis",
        choices=("recorded", "device"),
        default="recorded",
        help="who moves the pelvis: the recorded walk (default), or each device as it can",
    )
    parser.add_argument(
        "--passive",
        choices=("held", "released"),
        default="held",
        help="passive joints: held at zero (default), or moving freely",
    )
    torque_options.add(parser, "judged against the motors of every device")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("-o", "--output", metavar="FILE", help="write .html, .md, .csv or .json as well")
    parser.add_argument(
        "--quick",
        action="store_true",
        help="the .html page without the five speeds and the choices of joints",
    )
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Compare and print."""
    from exo_pin import devices
    from exo_pin.compare import Conditions, compare

    chosen = [devices.find(name) for name in measures.listed(args.devices or devices.DEVICES)]
    _check_output(args.output)
    body = options.body_from(args)
    gait, conditions = options.gait_from(args, body), Conditions(args.pelvis, args.passive)
    torques = torque_options.given(args, body, gait)
    with show.busy(f"comparing {len(chosen)} devices"):
        comparison = compare(gait, chosen, body, conditions=conditions, torques=torques)
    if args.json:
        show.as_json(comparison.facts())
    else:
        _print(comparison, Path(args.gait).name)
    if args.output:
        write_text(args.output, _WRITERS[Path(args.output).suffix.lower()](comparison, args))
    return 0


def _print(comparison: Comparison, name: str) -> None:
    from exo_pin.compare import PHASES, comparison_table

    print(comparison_table.conditions(comparison))
    show.table(
        f"What each device loses of {name}", comparison_table.LOSS_COLUMNS, comparison_table.rows(comparison)
    )
    if comparison.walk.gait.events:
        columns = ("sole rms mm", *PHASES)
        show.table("By phase of the foot's cycle", columns, comparison_table.phase_rows(comparison))
    if comparison.motors is not None:
        heads = comparison_table.MOTOR_COLUMNS[:-1]
        rows = [row[:-1] for row in comparison_table.motor_rows(comparison)]
        show.table("Torque and power of the motors (joints copy the walk)", heads, rows)
        for motor in comparison.motors:
            for failure in motor.failures:
                print(f"NOT OK {show.plain(motor.device.name)}, {failure}")
        print(f"torques: {show.plain(comparison.torques)}")


def _check_output(output: str | None) -> None:
    if output is not None and Path(output).suffix.lower() not in _WRITERS:
        raise DescriptionError(f"{output}: {', '.join(_WRITERS)} are accepted")


def _markdown(comparison: Comparison, _: argparse.Namespace) -> str:
    from exo_pin.compare import PHASES, comparison_table

    parts = [
        comparison_table.conditions(comparison) + "\n",
        comparison_table.markdown(comparison_table.LOSS_COLUMNS, comparison_table.rows(comparison)),
        comparison_table.markdown(("sole rms mm", *PHASES), comparison_table.phase_rows(comparison)),
    ]
    if comparison.motors is not None:
        rows = comparison_table.motor_rows(comparison)
        parts.append(comparison_table.markdown(comparison_table.MOTOR_COLUMNS, rows))
        parts.append(f"Torques: {comparison.torques}\n")
    return "\n".join(parts)


def _csv(comparison: Comparison, _: argparse.Namespace) -> str:
    from exo_pin.compare import comparison_table

    columns: tuple[str, ...] = comparison_table.LOSS_COLUMNS
    rows = comparison_table.rows(comparison)
    if comparison.motors is not None:
        columns += comparison_table.MOTOR_COLUMNS[1:]
        motors = comparison_table.motor_rows(comparison)
        rows = [row + motor[1:] for row, motor in zip(rows, motors, strict=True)]
    return comparison_table.csv(columns, rows)


def _json(comparison: Comparison, _: argparse.Namespace) -> str:
    return json.dumps(comparison.facts(), indent=2) + "\n"


def _html(comparison: Comparison, args: argparse.Namespace) -> str:
    from exo_pin import report

    choices = {
        "sign preset of the file": args.preset or "none given",
        "measures of the body": args.body or "those given, else the defaults",
    }
    more = {} if args.quick else _more(comparison, args.gait)
    name = Path(args.gait).name
    return report.html(report.comparison(comparison, name=name, choices=choices, when=moment(), **more))


def _more(comparison: Comparison, name: str) -> dict[str, Any]:
    """The comparison at the five speeds, and the choices of joints, for the page."""
    from exo_pin.compare import compare, compare_joints

    body, gait = comparison.walk.robot.body, comparison.walk.gait
    assert body is not None  # compare made it
    devices = [loss.device for loss in comparison.best]
    speeds = {} if name in SPEEDS else {"this walk": comparison}
    for speed in show.progress(SPEEDS, "speeds"):
        walk = options.load(speed, body)
        speeds[speed] = (
            comparison if speed == name else compare(walk, devices, body, conditions=comparison.conditions)
        )
    with show.busy("choices of joints"):
        found = compare_joints(gait.resampled(_SAMPLES) if len(gait) > _SAMPLES else gait, body)
    return {"speeds": speeds, "worth": found}


_WRITERS: dict[str, Callable[[Comparison, argparse.Namespace], str]] = {
    ".html": _html,
    ".md": _markdown,
    ".csv": _csv,
    ".json": _json,
}

"""`exo-pin info`: the content of a gait file: time, joint ranges, events, cycles, outliers."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from math import degrees
from typing import TYPE_CHECKING, Any

from exo_pin.cli import body_options, options, show, trials, walk_output

if TYPE_CHECKING:
    from exo_pin.anatomy.sized_body import SizedBody
    from exo_pin.arrays import Array
    from exo_pin.demand import RangeDemand
    from exo_pin.gait import Gait, Plausibility
    from exo_pin.kinematics import CurveOutlier, EventDifference, WalkNumbers

_EXAMPLES = """examples:
  exo-pin info walk.mot
  exo-pin info walk.trc                  a marker trial, solved by inverse kinematics
  exo-pin info fast --json"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    options.add_body(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    """Print what the gait holds."""
    found = _found(args)
    if args.json:
        show.as_json(_to_json(found))
    else:
        _print(args.gait, found)
    return 0


@dataclass(frozen=True, eq=False)
class _Info:
    """What a gait file holds.

    Attributes:
        gait: The walk, with its events or those of its kinematics.
        events_note: Why there are no events; empty where there are.
        differences: Of the events to those of force plates.
        ranges: By joint: the range of the angles against the robot's limits.
        peak_speeds: Of the joints in the same order [rad/s].
        numbers: Cycles and spatiotemporal numbers.
        outliers: Samples that stand out of their curve.
        plausibility: The verdict on the walk as it was read.
        body: The body that walks, with the origin of its sizes.
        markers: How well a marker trial's markers are met, for JSON; None for other files.
    """

    gait: Gait
    events_note: str
    differences: tuple[EventDifference, ...]
    ranges: dict[str, RangeDemand]
    peak_speeds: Array
    numbers: WalkNumbers
    outliers: tuple[CurveOutlier, ...]
    plausibility: Plausibility
    body: SizedBody
    markers: dict[str, Any] | None


def _found(args: argparse.Namespace) -> _Info:
    import numpy as np

    from exo_pin.demand import range_demands
    from exo_pin.kinematics import curve_outliers, walk_numbers
    from exo_pin.robot import load_robot

    body = body_options.sized(args)
    robot = load_robot(body.body)
    judged = options.judged(args, robot, options.gait_from(args, body.body))
    gait = judged.gait
    return _Info(
        gait=gait,
        events_note=judged.events_note,
        differences=args.event_differences,
        peak_speeds=np.maximum(gait.dq.max(axis=0), -gait.dq.min(axis=0)),
        numbers=walk_numbers(robot, gait, trials.feet(args, robot, gait)),
        outliers=curve_outliers(gait),
        plausibility=judged.verdict,
        ranges=range_demands(robot, robot.from_gait(gait)),
        body=body,
        markers=trials.to_json(args),
    )


def _to_json(found: _Info) -> dict[str, Any]:
    gait = found.gait
    return {
        "source": gait.source,
        "remarks": list(gait.remarks),
        "samples": len(gait),
        "duration_s": gait.duration,
        "periodic": gait.periodic,
        "pelvis_moves": gait.base is not None,
        "joints": {
            joint: {
                "min_deg": degrees(demand.lowest),
                "max_deg": degrees(demand.highest),
                "peak_speed_deg_s": degrees(speed),
                "outside": demand.samples_outside,
            }
            for speed, (joint, demand) in zip(found.peak_speeds, found.ranges.items(), strict=True)
        },
        "events": [
            {"time_s": e.time, "side": e.side, "kind": e.kind, "source": e.source} for e in gait.events
        ],
        "event_differences": [
            {"source": x.source, "kind": x.kind, "mean_s": x.mean, "largest_s": x.largest, "n": len(x.late)}
            for x in found.differences
        ],
        "events_note": found.events_note,
        "body": body_options.to_json(found.body),
        "markers": found.markers,
        "outliers": walk_output.outliers_to_json(found.outliers),
        "plausibility": found.plausibility.facts(),
        **walk_output.numbers_to_json(gait, found.numbers),
    }


def _print(name: str, found: _Info) -> None:
    gait = found.gait
    rows = [
        [
            joint,
            show.fixed(degrees(demand.lowest)),
            show.fixed(degrees(demand.highest)),
            show.fixed(degrees(speed), 0),
            str(demand.samples_outside or "-"),
        ]
        for speed, (joint, demand) in zip(found.peak_speeds, found.ranges.items(), strict=True)
    ]
    kind = "one cycle, repeated" if gait.periodic else "a recording"
    title = f"{name}: {kind}, {len(gait)} samples in {gait.duration:.3f} s"
    show.table(title, ["joint", "min deg", "max deg", "peak deg/s", "outside limits"], rows)
    moves = "pelvis does not move" if gait.base is None else "pelvis moves"
    print(f"source: {gait.source or 'not stated'}\n{moves}; events: {len(gait.events) or 'none'}")
    for event in gait.events:
        print(f"  {event.time:.3f} s  {event.side} {event.kind}  ({event.source})")
    if found.events_note and found.numbers.missing not in found.events_note:
        print(f"  {found.events_note}")
    title = f"body: {body_options.words(found.body)}"
    show.table(title, body_options.COLUMNS, body_options.rows(found.body))
    _print_numbers(found)


def _print_numbers(found: _Info) -> None:
    """Cycles, outliers and the verdict."""
    numbers = found.numbers
    if numbers.missing:
        print(f"cycles: {numbers.missing}")
    else:
        counts = ", ".join(f"{n} {side}" for side, n in numbers.cycles.items())
        speed = f"{numbers.numbers['speed'].mean:.2f} m/s, " if "speed" in numbers.numbers else ""
        cadence = numbers.numbers["cadence"].mean
        print(f"cycles: {counts}; {speed}{cadence:.0f} steps/min (exo-pin cycles)")
    if numbers.estimate:
        print(f"estimate: {numbers.estimate}")
    if words := walk_output.manner_words(numbers):
        print(words)
    walk_output.print_left_out(numbers)
    walk_output.print_outliers(found.outliers)
    walk_output.print_plausibility(found.plausibility)

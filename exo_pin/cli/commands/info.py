"""`exo-pin info`: what a gait holds: time, joint ranges, events, what lies outside the limits."""

from __future__ import annotations

import argparse
from typing import Any

from exo_pin.cli import options, outliers, show, trials
from exo_pin.cli.commands import cycles

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
    facts = _facts(args)
    if args.json:
        show.as_json(facts)
        return 0
    rows = [
        [
            joint,
            show.fixed(r["min_deg"]),
            show.fixed(r["max_deg"]),
            show.fixed(r["peak_speed_deg_s"], 0),
            r["outside"] or "-",
        ]
        for joint, r in facts["joints"].items()
    ]
    kind = "one cycle, repeated" if facts["periodic"] else "a recording"
    title = f"{args.gait}: {kind}, {facts['samples']} samples in {facts['duration_s']:.3f} s"
    columns = ["joint", "min deg", "max deg", "peak deg/s", "outside limits"]
    show.table(title, columns, [[str(cell) for cell in row] for row in rows])
    moves = "pelvis moves" if facts["pelvis_moves"] else "pelvis does not move"
    print(f"source: {facts['source'] or 'not stated'}\n{moves}; events: {len(facts['events']) or 'none'}")
    for event in facts["events"]:
        print(f"  {event['time_s']:.3f} s  {event['side']} {event['kind']}  ({event['source']})")
    if facts["events_note"] and facts["no_cycles"] not in facts["events_note"]:
        print(f"  {facts['events_note']}")
    _print_walk(facts)
    return 0


def _print_walk(facts: dict[str, Any]) -> None:
    """Cycles and plausibility."""
    if facts["cycles"]:
        counts = ", ".join(f"{n} {side}" for side, n in facts["cycles"].items())
        speed, cadence = (facts["spatiotemporal"].get(name, {}) for name in ("speed", "cadence"))
        print(f"cycles: {counts}; {speed['mean']:.2f} m/s, {cadence['mean']:.0f} steps/min (exo-pin cycles)")
    else:
        print(f"cycles: {facts['no_cycles']}")
    cycles.print_left_out(facts)
    outliers.show(facts["outliers"])
    print("plausible" if not facts["doubts"] else "doubtful: " + "; ".join(facts["doubts"]))


def _facts(args: argparse.Namespace) -> dict[str, Any]:
    import numpy as np

    from exo_pin.demand import range_demands
    from exo_pin.gait import implausibilities
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot = load_robot(body)
    gait, note = options.with_events(robot, options.gait_from(args, body))
    ranges = range_demands(robot, robot.from_gait(gait))
    peaks = np.degrees(np.abs(gait.dq).max(axis=0))
    return {
        "source": gait.source,
        "samples": len(gait.time),
        "duration_s": gait.duration,
        "periodic": gait.periodic,
        "pelvis_moves": gait.base is not None,
        "joints": {
            joint: {
                "min_deg": float(np.degrees(demand.lowest)),
                "max_deg": float(np.degrees(demand.highest)),
                "peak_speed_deg_s": float(peak),
                "outside": demand.samples_outside,
            }
            for peak, (joint, demand) in zip(peaks, ranges.items(), strict=True)
        },
        "events": [
            {"time_s": e.time, "side": e.side, "kind": e.kind, "source": e.source} for e in gait.events
        ],
        "events_note": note,
        "markers": trials.facts(args),
        "outliers": outliers.facts(gait),
        "doubts": [*implausibilities(gait), *trials.doubts(args)],
        **cycles.facts(robot, gait),
    }

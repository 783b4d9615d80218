"""`exo-pin info`: what a gait holds: time, joint ranges, events, what lies outside the limits."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from exo_pin.cli import options, outliers, show, trials
from exo_pin.cli.walk_facts import WalkFacts, walk_facts

if TYPE_CHECKING:
    from exo_pin.gait import Gait

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
    info = _info(args)
    if args.json:
        show.as_json(info.to_json(markers=trials.to_json(args)) | info.walk.to_json())
    else:
        _print(args.gait, info)
    return 0


class _Range(NamedTuple):
    """What a joint does.

    Attributes:
        least: Smallest angle [deg].
        most: Largest angle [deg].
        peak: Largest speed [deg/s].
        outside: Samples outside the joint's limits.
    """

    least: float
    most: float
    peak: float
    outside: int


@dataclass(frozen=True, eq=False)
class _Info:
    """The gait, and what follows from it; `note` says why there are no events, or is empty."""

    gait: Gait
    joints: dict[str, _Range]
    note: str
    outliers: tuple[outliers.CurveOutlier, ...]
    doubts: tuple[str, ...]
    walk: WalkFacts

    def to_json(self, *, markers: dict[str, Any] | None) -> dict[str, Any]:
        """As `--json` prints it, but for the walk."""
        gait = self.gait
        return {
            "source": gait.source,
            "samples": len(gait.time),
            "duration_s": gait.duration,
            "periodic": gait.periodic,
            "pelvis_moves": gait.base is not None,
            "joints": {
                joint: {
                    "min_deg": x.least,
                    "max_deg": x.most,
                    "peak_speed_deg_s": x.peak,
                    "outside": x.outside,
                }
                for joint, x in self.joints.items()
            },
            "events": [
                {"time_s": e.time, "side": e.side, "kind": e.kind, "source": e.source} for e in gait.events
            ],
            "events_note": self.note,
            "markers": markers,
            "outliers": [x.to_json() for x in self.outliers],
            "doubts": list(self.doubts),
        }


def _info(args: argparse.Namespace) -> _Info:
    import numpy as np

    from exo_pin.demand import range_demands
    from exo_pin.gait import implausibilities
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot = load_robot(body)
    gait, note = options.with_events(robot, options.gait_from(args, body))
    ranges = range_demands(robot, robot.from_gait(gait))
    peaks = np.degrees(np.abs(gait.dq).max(axis=0))
    joints = {
        joint: _Range(
            float(np.degrees(demand.lowest)),
            float(np.degrees(demand.highest)),
            float(peak),
            demand.samples_outside,
        )
        for peak, (joint, demand) in zip(peaks, ranges.items(), strict=True)
    }
    reasons = (*implausibilities(gait), *trials.doubts(args))
    return _Info(gait, joints, note, outliers.find(gait), reasons, walk_facts(robot, gait))


def _print(name: str, info: _Info) -> None:
    gait = info.gait
    rows = [
        [joint, show.fixed(x.least), show.fixed(x.most), show.fixed(x.peak, 0), str(x.outside or "-")]
        for joint, x in info.joints.items()
    ]
    kind = "one cycle, repeated" if gait.periodic else "a recording"
    title = f"{name}: {kind}, {len(gait.time)} samples in {gait.duration:.3f} s"
    show.table(title, ["joint", "min deg", "max deg", "peak deg/s", "outside limits"], rows)
    moves = "pelvis moves" if gait.base is not None else "pelvis does not move"
    print(f"source: {gait.source or 'not stated'}\n{moves}; events: {len(gait.events) or 'none'}")
    for event in gait.events:
        print(f"  {event.time:.3f} s  {event.side} {event.kind}  ({event.source})")
    if info.note and info.walk.no_cycles not in info.note:
        print(f"  {info.note}")
    _print_walk(info)


def _print_walk(info: _Info) -> None:
    """Cycles, outliers and plausibility."""
    walk = info.walk
    if walk.cycles:
        counts = ", ".join(f"{n} {side}" for side, n in walk.cycles.items())
        speed, cadence = walk.numbers["speed"].mean, walk.numbers["cadence"].mean
        print(f"cycles: {counts}; {speed:.2f} m/s, {cadence:.0f} steps/min (exo-pin cycles)")
    else:
        print(f"cycles: {walk.no_cycles}")
    walk.print_left_out()
    outliers.show(info.outliers)
    print("plausible" if not info.doubts else "doubtful: " + "; ".join(info.doubts))

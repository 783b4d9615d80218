"""`exo-pin edit`: adjust a walk and write it; the joint limits are checked after each adjustment."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import body_options, device_options, measures, options, show, walk_output
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.edit import Recheck
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot

_EXAMPLES = """examples:
  exo-pin edit walk.mot slow.mot --slower 1.5 --stride 0.8
  exo-pin edit free soft.csv --amplitude knee_flexion=0.8 --clearance 1.2
  exo-pin edit free start.yaml --ramp 3 3                   a slow start and stop, for a controller
  exo-pin edit free start.yaml --duration 20 --ramp 3 3     20 s in all, ramps included
  exo-pin edit free long.csv --for 20s                      at its cadence for 20 s; or --cycles 12
  exo-pin edit walk.mot smooth.csv --cutoff 6 --mirror
  exo-pin edit walk.mot even.csv --cutoff 6 --cycle --symmetric
  exo-pin edit free between.csv --blend slow=0.3
  exo-pin edit slow faster.csv --transition free=3          from one to the other within 3 cycles
  exo-pin edit slow faster.csv --transition free=4s --ramp 2 2
  exo-pin edit walk.mot fit.csv --fit lokomat               what the device can do of it: see exo-pin feasible

Adjustments are made in the order of these options: cutoff, cycle, symmetric, mirror, blend, amplitude,
stride and clearance, transition, duration or slower, cycles or for, ramp, fit. Limits, speeds and
accelerations are checked after each. exit code 0: done; 1: written, but a joint leaves its limits; or the
legs cannot follow or the device of --fit does not fit, and nothing is written."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser, default=None)
    parser.add_argument("output", metavar="OUT", help="the new file; its ending is the format")
    group = parser.add_argument_group("adjustments")
    group.add_argument("--cutoff", type=float, metavar="HZ", help="zero-lag Butterworth of order 4")
    group.add_argument(
        "--cycle", action="store_true", help="a recording's mean cycle first, as a gait that repeats"
    )
    group.add_argument("--symmetric", action="store_true", help="both sides alike (a gait that repeats)")
    group.add_argument("--mirror", action="store_true", help="left and right change places")
    group.add_argument("--blend", metavar="GAIT=SHARE", help="mix with another gait that repeats")
    group.add_argument(
        "--amplitude",
        action="append",
        default=[],
        metavar="JOINT=F",
        help="about the joint's mean; one or both sides",
    )
    group.add_argument("--stride", type=float, default=1.0, metavar="F", help="stride length, at the feet")
    group.add_argument("--clearance", type=float, default=1.0, metavar="F", help="height of the swing foot")
    group.add_argument(
        "--transition",
        metavar="GAIT=CYCLES",
        help="go over to another gait that repeats, within so many cycles (3) or seconds (4s)",
    )
    group.add_argument(
        "--lead",
        type=float,
        default=2.0,
        metavar="CYCLES",
        help="of each gait around a transition (default: 2)",
    )
    group.add_argument("--slower", type=float, metavar="F", help="this many times slower")
    group.add_argument(
        "--duration",
        type=measures.seconds,
        metavar="S",
        help="length of the whole walk [s]; with --ramp a gait that repeats keeps its cadence",
    )
    group.add_argument("--cycles", type=int, metavar="N", help="a gait that repeats, this often")
    group.add_argument(
        "--for", dest="seconds", type=measures.seconds, metavar="S", help="a gait that repeats, for 20s"
    )
    group.add_argument("--ramp", type=float, nargs=2, metavar=("UP", "DOWN"), help="slow start and stop [s]")
    group.add_argument(
        "--fit",
        metavar="DEVICE",
        help="the walk that this device can do, with the smallest concession: knee held at its stop, slower "
        "or smaller",
    )
    device_options.add_knee(group)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def _check(args: argparse.Namespace) -> None:
    """Refuse options that contradict each other and files that are not written, before any work."""
    from exo_pin.formats import written_format

    written_format(Path(args.output))
    lengths = {"--duration": args.duration, "--cycles": args.cycles, "--for": args.seconds}
    given = [name for name, value in lengths.items() if value is not None]
    if len(given) > 1 and not (given == ["--duration", "--cycles"] and not args.ramp):
        raise DescriptionError(f"{' and '.join(given)} both state the length of the walk; one is accepted")
    if args.slower is not None and args.duration is not None:
        raise DescriptionError("--slower and --duration both state the time; one is accepted")
    if args.cycles is not None and args.cycles < 1:
        raise DescriptionError(f"--cycles is {args.cycles}; 1 or more is accepted")


def run(args: argparse.Namespace) -> int:
    """Adjust, check after each adjustment, write."""
    from exo_pin import edit
    from exo_pin.formats import save_gait
    from exo_pin.robot import load_robot

    _check(args)
    body = options.body_from(args)
    robot, gait = load_robot(body), options.gait_from(args, body)
    checks = {"as it is": edit.recheck(robot, gait)}
    for name, step in _STEPS.items():
        changed = step(args, robot, body, gait)
        if changed is not gait:
            checks[name] = edit.recheck(robot, changed)
        gait = changed
    if args.fit is not None:
        fitted = _fitted(args, body, gait)
        if fitted is None:
            return 1
        gait, device = fitted
        checks["fitted"] = edit.recheck(device, gait)
    save_gait(gait, args.output)
    if args.json:
        steps = [{"step": name, **found.facts()} for name, found in checks.items()]
        facts = {"output": args.output, "samples": len(gait.time), "duration_s": gait.duration}
        show.as_json(facts | {"source": gait.source, "steps_in_rad": steps})
    else:
        print(f"{args.output}: {len(gait.time)} samples, {gait.duration:.3f} s\n{gait.source}")
        _print(checks)
    return 0 if checks[next(reversed(checks))].ok else 1


def _print(checks: dict[str, Recheck]) -> None:
    """The largest demand after each adjustment, and the joints that exceed a limit after the last one."""
    import math

    from exo_pin.demand import ACCELERATION_LIMIT

    rows = [
        [
            name,
            show.fixed(math.degrees(found.closest.position.margin)),
            show.fixed(100 * found.fastest.speed.use, 0),
            show.fixed(100 * found.hardest.acceleration.use, 0),
        ]
        for name, found in checks.items()
    ]
    title = (
        "after each adjustment: degrees inside the limits, % of the motors' speed, "
        f"% of {ACCELERATION_LIMIT:g} rad/s^2"
    )
    show.table(title, ["after", "deg inside", "speed", "acceleration"], rows)
    for line in checks[next(reversed(checks))].lines():
        print(line)


Step = Callable[[argparse.Namespace, "Robot", "Body", "Gait"], "Gait"]


def _filter(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    return gait if args.cutoff is None else edit.filtered(gait, cutoff=args.cutoff)


def _cycle(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin.gait import cycles, side_with_more_strides
    from exo_pin.kinematics import with_events

    if not args.cycle:
        return gait
    known = with_events(robot, gait)
    found = cycles(known, side_with_more_strides(known))
    return found.average(f"{gait.source}; mean of {walk_output.count(found)}")


def _symmetric(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    return edit.symmetrised(gait) if args.symmetric else gait


def _mirror(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    return edit.mirrored(gait) if args.mirror else gait


def _blend(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.blend is None:
        return gait
    name, share = _name_and_number(args.blend, "--blend")
    return edit.blended(gait, options.load(name, body), share=share)


def _transition(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.transition is None:
        return gait
    in_time = args.transition.endswith("s") and args.transition[-2:-1].isdigit()
    text = args.transition.removesuffix("s") if in_time else args.transition
    name, length = _name_and_number(text, "--transition")
    other = options.load(name, body)
    around = {"before": args.lead, "after": args.lead}
    if in_time:
        return edit.transitioned(gait, other, seconds=length, **around)
    return edit.transitioned(gait, other, cycles=length, **around)


def _amplitude(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    factors = dict(_name_and_number(text, "--amplitude") for text in args.amplitude)
    return edit.scaled(gait, factors) if factors else gait


def _feet(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.stride == args.clearance == 1.0:
        return gait
    return edit.strided(robot, gait, stride=args.stride, clearance=args.clearance)[0]


def _time(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.slower is None and (args.duration is None or args.ramp):
        return gait
    return edit.retimed(gait, factor=args.slower, duration=args.duration)


def _fitted(args: argparse.Namespace, body: Body, gait: Gait) -> tuple[Gait, Robot] | None:
    """The walk that the device of `--fit` can do, and the device; None and why on stderr if it fits none."""
    import dataclasses

    from exo_pin.feasible import device_walk

    found = device_walk(gait, args.fit, body, knee=args.knee)
    print(found.sentence if found.ok else f"exo-pin: {found.sentence}", file=sys.stderr)
    if not found.ok:
        return None
    walk = dataclasses.replace(found.gait, source=f"{gait.source}; {found.sentence}")
    return walk, found.as_recorded.robot  # the joints that it locks have no limits to keep


def _length(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.cycles is None and args.seconds is None:
        return gait
    if not gait.periodic:
        raise DescriptionError("--cycles and --for are for a gait that repeats; --cycle makes one first")
    if args.cycles is not None:
        return edit.lasting(gait, args.cycles * gait.duration) if args.ramp else gait.repeated(args.cycles)
    return gait if args.ramp else edit.lasting(gait, args.seconds)


def _ramp(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if not args.ramp:
        return gait
    whole = args.duration if args.seconds is None else args.seconds
    return edit.ramped(gait, start=args.ramp[0], stop=args.ramp[1], duration=whole)


_STEPS: dict[str, Step] = {
    "filtered": _filter,
    "mean cycle": _cycle,
    "symmetric": _symmetric,
    "mirrored": _mirror,
    "blended": _blend,
    "amplitude": _amplitude,
    "at the feet": _feet,
    "transition": _transition,
    "retimed": _time,
    "repeated": _length,
    "ramped": _ramp,
}
"""The adjustments in the order in which they are made."""


def _name_and_number(text: str, option: str) -> tuple[str, float]:
    name, value = body_options.assignment(text)
    if isinstance(value, bool) or not isinstance(value, float):
        raise DescriptionError(f"{option} {text!r}: expected a number after the =")
    return name, value

"""`exo-pin edit`: adjust a walk and write it; limits, velocities and accelerations are checked anew."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING

from exo_pin.cli import options
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot

_EXAMPLES = """examples:
  exo-pin edit walk.mot slow.mot --slower 1.5 --stride 0.8
  exo-pin edit free soft.csv --amplitude knee_flexion=0.8 --clearance 1.2
  exo-pin edit free start.yaml --ramp 3 3                   a slow start and stop, for a controller
  exo-pin edit walk.mot smooth.csv --cutoff 6 --mirror
  exo-pin edit free between.csv --blend slow=0.3

Adjustments are made in the order of these options: cutoff, symmetric, mirror, blend, amplitude, stride and
clearance, duration or slower, ramp. exit code 0: done; 1: written, but a joint leaves its limits."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser, default=None)
    parser.add_argument("output", metavar="OUT", help="the new file; its ending is the format")
    group = parser.add_argument_group("adjustments")
    group.add_argument("--cutoff", type=float, metavar="HZ", help="zero-lag Butterworth of order 4")
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
    group.add_argument("--slower", type=float, metavar="F", help="this many times slower")
    group.add_argument("--duration", type=float, metavar="S", help="length of the whole walk [s]")
    group.add_argument("--ramp", type=float, nargs=2, metavar=("UP", "DOWN"), help="slow start and stop [s]")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Adjust, check, write."""
    from exo_pin import edit
    from exo_pin.formats import save_gait
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot, gait = load_robot(body), options.gait_from(args, body)
    for step in _STEPS:
        gait = step(args, robot, body, gait)
    checked = edit.recheck(robot, gait)
    save_gait(gait, args.output)
    print(f"{args.output}: {len(gait.time)} samples, {gait.duration:.3f} s\n{gait.source}")
    for line in checked.lines():
        print(line)
    return 0 if checked.ok else 1


Step = Callable[[argparse.Namespace, "Robot", "Body", "Gait"], "Gait"]


def _filter(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    return gait if args.cutoff is None else edit.filtered(gait, cutoff=args.cutoff)


def _sides(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    gait = edit.symmetrised(gait) if args.symmetric else gait
    return edit.mirrored(gait) if args.mirror else gait


def _blend(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.blend is None:
        return gait
    name, share = _number(args.blend, "--blend")
    return edit.blended(gait, options.load(name, body), share=share)


def _amplitude(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    factors = dict(_number(text, "--amplitude") for text in args.amplitude)
    return edit.scaled(gait, factors) if factors else gait


def _feet(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.stride == args.clearance == 1.0:
        return gait
    return edit.strided(robot, gait, stride=args.stride, clearance=args.clearance)[0]


def _time(args: argparse.Namespace, robot: Robot, body: Body, gait: Gait) -> Gait:
    from exo_pin import edit

    if args.slower is not None or args.duration is not None:
        gait = edit.retimed(gait, factor=args.slower, duration=args.duration)
    return edit.ramped(gait, start=args.ramp[0], stop=args.ramp[1]) if args.ramp else gait


_STEPS: tuple[Step, ...] = (_filter, _sides, _blend, _amplitude, _feet, _time)


def _number(text: str, option: str) -> tuple[str, float]:
    name, value = options.assignment(text)
    if isinstance(value, bool) or not isinstance(value, float):
        raise DescriptionError(f"{option} {text!r}: expected a number after the =")
    return name, value

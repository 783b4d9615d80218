"""Options that say which steps are planned: even ones, a table of footsteps, or those of a recorded walk."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import SIDES, Body
from exo_pin.cli import measures, options
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.robot import Robot
    from exo_pin.walking import Footsteps

_EVEN = ("steps", "length", "width", "turn", "start")
"""Options of even steps; a table or a recorded walk holds its own."""


def add(parser: argparse.ArgumentParser) -> None:
    """Which steps, and in what time."""
    group = parser.add_argument_group("steps")
    group.add_argument(
        "--steps", type=int, metavar="N", help="even steps; one more closes the feet (default: 8)"
    )
    group.add_argument("--length", type=measures.metres, metavar="M", help="of a step [m] (default: 0.30)")
    group.add_argument(
        "--width", type=measures.metres, metavar="M", help="between the feet [m] (default: the hips' width)"
    )
    group.add_argument(
        "--turn", type=float, metavar="DEG", help="of every step, to the left positive [deg] (default: 0)"
    )
    group.add_argument("--start", choices=SIDES, help="the foot that steps first (default: left)")
    group.add_argument(
        "--footsteps", metavar="CSV", help="a table of footsteps instead: side,x_m,y_m,heading_deg"
    )
    group.add_argument(
        "--strides", metavar="GAIT", help="the footsteps of a recorded walk over ground instead"
    )
    group.add_argument(
        "--shorten", type=float, metavar="F", help="every step F times as long, 0 .. 1 (default: 1)"
    )
    group.add_argument(
        "--step-time", type=float, metavar="S", help="from landing to landing [s] (default: 0.8, or recorded)"
    )
    group.add_argument(
        "--double-support",
        type=float,
        metavar="SHARE",
        help="of the step time, both feet down (default: 0.2, or recorded)",
    )
    group.add_argument(
        "--clearance", type=measures.metres, default=0.05, metavar="M", help="of the foot (default: 0.05)"
    )


def footsteps(args: argparse.Namespace, body: Body, robot: Robot) -> Footsteps:
    """The footsteps of the arguments.

    Args:
        args: Of the command line.
        body: Who walks.
        robot: That body on the device.

    Raises:
        DescriptionError: Options contradict each other.
        GaitError: The steps are no walk.
        FormatError: A file cannot be read.
    """
    from exo_pin.walking import footsteps as even
    from exo_pin.walking import load_footsteps

    if args.footsteps and args.strides:
        raise DescriptionError("--footsteps and --strides both give the steps; use one of them")
    given = next((name for name in _EVEN if getattr(args, name) is not None), None)
    if given and (args.footsteps or args.strides):
        raise DescriptionError(f"--{given} is for even steps; leave it away with --footsteps or --strides")
    if args.strides:
        walk = _recorded(args, body, robot)
    elif args.footsteps:
        walk = load_footsteps(args.footsteps, clearance=args.clearance, **_times(args))
    else:
        chosen = {name: getattr(args, name) for name in _EVEN if getattr(args, name) is not None}
        chosen |= {"turn": math.radians(args.turn or 0.0), "width": args.width or body.hip_width}
        walk = even(clearance=args.clearance, **chosen, **_times(args))
    return walk if args.shorten is None else walk.shortened(args.shorten)


def _times(args: argparse.Namespace) -> dict[str, Any]:
    times = {"step_time": args.step_time, "double_support": args.double_support}
    return {name: value for name, value in times.items() if value is not None}


def _recorded(args: argparse.Namespace, body: Body, robot: Robot) -> Footsteps:
    """The steps of a recorded walk, at its own times unless others are given."""
    import dataclasses

    from exo_pin.walking import recorded_footsteps

    gait, why = options.with_events(robot, options.load(args.strides, body))
    if why:
        raise DescriptionError(f"{args.strides}: {why}")
    walk = recorded_footsteps(robot, gait, clearance=args.clearance)
    return dataclasses.replace(walk, **_times(args))

"""Chapters of a report that its command computes: session, forces and motors, a simulated run."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from exo_pin.cli import body_options, device_options, options, own_torques, show, simulation_output, trials
from exo_pin.errors import DescriptionError, ExoPinError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.gait import Gait
    from exo_pin.gait.further_angles import FurtherAngles
    from exo_pin.report.sections.forces import Loads
    from exo_pin.simulation import Run

_CYCLES = 5
"""Of a walk that repeats: enough for the numbers of a report."""


def add(parser: argparse.ArgumentParser) -> None:
    """`--simulate` and its conditions."""
    group = parser.add_argument_group("control (a chapter on a simulated run)")
    group.add_argument(
        "--simulate",
        nargs="?",
        const="pd",
        metavar="CONTROLLER",
        help="simulate the walk by torques, under a controller by name or file.py:Class (default: pd)",
    )
    group.add_argument("--patient", metavar="NAME|FILE", help="who walks in it (see `exo-pin simulate`)")
    group.add_argument(
        "--bws", type=float, default=0.0, metavar="PART", help="body-weight support, 0 to 1 (default: 0)"
    )


def check(args: argparse.Namespace) -> None:
    """Refuse options that do not fit, before any work.

    Raises:
        DescriptionError: A part is out of range, or a condition is given without a run.
        UnknownNameError: There is no such controller or patient.
    """
    if not 0.0 <= args.bws <= 1.0:
        raise DescriptionError(f"--bws is {args.bws:g}; a part of the weight, 0 to 1, is accepted")
    if args.simulate is None:
        if args.patient is not None:
            raise DescriptionError("--patient walks in a simulated run; add --simulate")
        return
    from exo_pin.control import find_controller, find_patient

    find_controller(args.simulate)
    if args.patient is not None:
        find_patient(args.patient)


def session(args: argparse.Namespace) -> dict[str, str]:
    """Who was recorded, where and when, by the walk's file, and the body in words."""
    words = {"body": body_options.words(body_options.sized(args))}
    return {**(args.files.open(args.gait).session() if trials.is_file(args) else {}), **words}


def further_angles(args: argparse.Namespace) -> FurtherAngles | None:
    """Pelvis and foot progression of the walk's file, where it has them."""
    return args.files.open(args.gait).further_angles() if trials.is_file(args) else None


def loads(args: argparse.Namespace, body: Body, walk: Gait) -> Loads | str:
    """Torques of the walk on the device and its drives' loads; words why there are none; empty: not asked.

    Args:
        args: The command line.
        body: Who wears the device.
        walk: The walk, with its events.
    """
    from exo_pin import sizing
    from exo_pin.report.sections.forces import Loads

    if args.no_forces:
        return ""
    with show.busy("forces"):
        try:
            robot, moved = device_options.motion(args, body, walk)
            moved, _ = options.with_events(robot, moved)
            known = own_torques.inverse_dynamics(args, robot, moved, body_weight_support=args.bws)
            return Loads(moved, known, sizing.size(known, stride=sizing.stride_time(robot, moved)))
        except ExoPinError as error:
            return f"{error}."


def simulated(args: argparse.Namespace, body: Body, walk: Gait) -> Run | None:
    """The run of `--simulate`; None without.

    Args:
        args: The command line.
        body: Who wears the device.
        walk: The walk, with its events.
    """
    if args.simulate is None:
        return None
    from exo_pin.robot import load_robot
    from exo_pin.simulation import simulate

    robot = load_robot(body, device=args.device)
    with simulation_output.progress("simulating") as bar:
        return simulate(
            robot,
            walk,
            args.simulate,
            patient=args.patient,
            body_weight_support=args.bws,
            cycles=_CYCLES,
            after=bar,
        )

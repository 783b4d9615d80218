"""Inverse dynamics of the command line's walk, with the force plates that its options or its file give."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from exo_pin.cli import plate_options, show
from exo_pin.errors import FormatError, GaitError

if TYPE_CHECKING:
    from exo_pin.dynamics import Dynamics
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot


_NOT_OF_THIS_MOTION = (
    "the force plates measured the recorded motion, which the device changes: their forces are not used, the "
    "ground reaction is predicted"
)


def inverse_dynamics(
    args: argparse.Namespace, robot: Robot, walk: Gait, *, changed: bool = False, **options: Any
) -> Dynamics:
    """The torques of a walk; remarks on them go to stderr.

    Args:
        args: The command line, with the arguments of `plate_options.add`.
        robot: Who walks.
        walk: The walk, with its events.
        changed: Whether it is not the motion that was recorded: force plates did not measure it, and are not
            used.
        options: Of `exo_pin.dynamics.torques`.

    Raises:
        FormatError: The force plates cannot be read, or do not belong to the walk.
        GaitError: There is no ground reaction by which a torque is known.
    """
    from exo_pin import dynamics

    plates = plate_options.measured(args)
    if changed and plates:
        plates = ()
        print(f"note: {_NOT_OF_THIS_MOTION}", file=sys.stderr)
    try:
        found = dynamics.torques(robot, walk, forces=plates, **options)
    except FormatError:
        raise
    except GaitError as error:
        if not plates:
            raise
        without = "" if args.forces else " (--forces none predicts the ground reaction instead)"
        raise FormatError(plate_options.source(args), f"{error}{without}") from error
    said = dict.fromkeys(remark for plate in plates for remark in plate.remarks)
    known = [f"{plate_options.source(args).name}: {remark}" for remark in said]
    for remark in (*(words for words in known if words not in walk.remarks), *found.remarks):
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    return found

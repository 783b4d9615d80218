"""Force plates on the command line: the feet's heel strikes and toe-offs as they measured them."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.errors import FormatError, GaitError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.gait import Gait


def add(group: argparse._ArgumentGroup) -> None:
    """The option."""
    group.add_argument(
        "--forces",
        metavar="FILE",
        help="ground reaction forces of the same trial (.mot .sto .c3d), for heel strikes and toe-offs; "
        "a C3D without events uses its own",
    )


def with_plate_events(args: argparse.Namespace, body: Body, walk: Gait) -> Gait:
    """The walk with the events that force plates measured, where an option or a C3D without events has them.

    Args:
        args: The command's arguments.
        body: Who walks.
        walk: The walk.

    Raises:
        FormatError: The file that is named cannot be read, no foot can be found on its plates, or the
            walk is no trial.
    """
    own = not walk.events and Path(args.gait).suffix.lower() == ".c3d"
    if not (args.forces or own):
        return walk
    from exo_pin.formats import load_forces
    from exo_pin.kinematics import with_plates
    from exo_pin.robot import load_robot

    path = Path(args.forces or args.gait)
    if walk.periodic:
        raise FormatError(path, f"measured on a trial, but {args.gait} is one cycle that repeats")
    try:
        plates = load_forces(args.files.open(path, "forces"))
    except FormatError:
        if args.forces:
            raise
        return walk  # a file whose unit of length is not known has no plates
    try:
        return with_plates(load_robot(body), walk, plates) if plates or args.forces else walk
    except GaitError as error:
        if args.forces:
            raise FormatError(path, str(error)) from error
        remark = f"its force plates give no events: {error}"
        return dataclasses.replace(walk, remarks=(*walk.remarks, remark))

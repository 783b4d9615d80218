"""Force plates on the command line: when the feet of a recording struck and left the ground."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.errors import FormatError, GaitError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.formats import ForcePlate
    from exo_pin.gait import Gait


def add(group: argparse._ArgumentGroup) -> None:
    """The option."""
    group.add_argument(
        "--forces",
        metavar="FILE",
        help="ground reaction forces of the same trial (.mot .sto .c3d), for heel strikes and toe-offs; "
        "a C3D without events uses its own",
    )


def struck(args: argparse.Namespace, body: Body, walk: Gait) -> Gait:
    """The walk with the moments that force plates saw, where the arguments or a C3D without events have them.

    Raises:
        FormatError: The file that is named cannot be read, no foot can be found on its plates, or the
            walk is no trial.
    """
    told = getattr(args, "forces", None)
    own = hasattr(args, "forces") and not walk.events and Path(args.gait).suffix.lower() == ".c3d"
    if not (told or own):
        return walk
    from exo_pin.kinematics import with_plates
    from exo_pin.robot import load_robot

    path = Path(told or args.gait)
    if walk.periodic:
        raise FormatError(path, f"measured on a trial, but {args.gait} is one cycle that repeats")
    try:
        return with_plates(load_robot(body), walk, _plates(path))
    except FormatError:
        raise
    except GaitError as error:
        if told:
            raise FormatError(path, str(error)) from error
        return walk  # its plates say nothing of these feet


def _plates(path: Path) -> tuple[ForcePlate, ...]:
    from exo_pin.formats import load_forces, load_markers

    return load_markers(path).plates if path.suffix.lower() == ".c3d" else load_forces(path)

"""Force plates on the command line: the feet's heel strikes and toe-offs as they measured them."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.errors import FormatError, GaitError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.formats import TrialFile
    from exo_pin.gait import Gait
    from exo_pin.gait.trial import ForcePlate


def add(group: argparse._ArgumentGroup) -> None:
    """The option."""
    group.set_defaults(event_differences=())
    group.add_argument(
        "--forces",
        metavar="FILE",
        help="ground reaction forces of the same trial (.mot .sto .c3d), for heel strikes and toe-offs; "
        "a C3D without events uses its own; none: not even these",
    )


_NONE = "none"
"""In place of a file: force plates are not used."""


def measured(args: argparse.Namespace) -> tuple[ForcePlate, ...]:
    """The force plates of the command line, or those in the walk's own file, z up; none if there are none.

    Raises:
        FormatError: The file that is named cannot be read, or holds no forces.
    """
    path = source(args)
    if args.forces == _NONE or not path.suffix:  # a normal walk
        return ()
    return _plates(args, path)


def source(args: argparse.Namespace) -> Path:
    """The file of `measured`."""
    return Path(args.forces or args.gait)


def with_plate_events(args: argparse.Namespace, body: Body, walk: Gait) -> Gait:
    """The walk with the events that force plates measured, where an option or a C3D without events has them.

    How its own events and those of its kinematics differ from the plates' is a remark of the walk, and is
    kept in the arguments for the verdict on it.

    Args:
        args: The command's arguments.
        body: Who walks.
        walk: The walk.

    Raises:
        FormatError: The file that is named cannot be read, no foot can be found on its plates, or the
            walk is no trial.
    """
    own = Path(args.gait).suffix.lower() == ".c3d" and not walk.periodic
    if args.forces == _NONE or not (args.forces or own):
        return walk
    from exo_pin.kinematics import event_differences, with_plates
    from exo_pin.robot import load_robot

    path = source(args)
    if walk.periodic:
        raise FormatError(path, f"measured on a trial, but {args.gait} is one cycle that repeats")
    plates = _plates(args, path)
    if not (plates or args.forces):
        return walk
    robot = load_robot(body)
    args.event_differences = event_differences(robot, walk, plates)
    found = dict.fromkeys(remark for plate in plates for remark in plate.remarks)
    walk = _remarked(walk, f"{path.name}: ", "; ".join(found))
    known = _remarked(walk, "against the force plates: ", "; ".join(map(str, args.event_differences)))
    if walk.events and not args.forces:
        return known
    try:
        return with_plates(robot, known, plates)
    except GaitError as error:
        why = _why(walk, plates) or str(error)
        if args.forces:
            raise FormatError(path, why) from error
        return _remarked(walk, "its force plates are not used for events: ", why)


def _why(walk: Gait, plates: tuple[ForcePlate, ...]) -> str:
    """Clock, unit or sign by which plates cannot belong to the walk; empty where it is none of these."""
    from exo_pin.dynamics.plate_checks import check_plates

    try:
        check_plates(walk, plates)
    except GaitError as error:
        return str(error)
    return ""


def _plates(args: argparse.Namespace, path: Path) -> tuple[ForcePlate, ...]:
    """The force plates of a file, z up; none where only the walk's own file has them, and unreadable ones."""
    from exo_pin.formats import load_forces

    try:
        file = args.files.open(path, "forces")
        return _z_up(file, load_forces(file))
    except FormatError:
        if args.forces:
            raise
        return ()  # a file whose unit of length is not known has no plates


def _z_up(file: TrialFile, plates: tuple[ForcePlate, ...]) -> tuple[ForcePlate, ...]:
    """Plates in the axes of the file's own marker trial, turned as its walk is; others are z up already."""
    from exo_pin.gait.trial import to_z_up

    try:
        up = file.markers().up
    except FormatError:
        return plates
    if not up or up == "+z":
        return plates
    R = to_z_up(up)
    turned = {name: [getattr(p, name) @ R.T for p in plates] for name in ("force", "point", "moment")}
    rows = zip(plates, *turned.values(), strict=True)
    return tuple(dataclasses.replace(p, force=f, point=x, moment=m) for p, f, x, m in rows)


def _remarked(walk: Gait, what: str, words: str) -> Gait:
    """The walk with one more remark, if there are words for it."""
    return dataclasses.replace(walk, remarks=(*walk.remarks, what + words)) if words else walk

"""Joint torques on the command line: of a file, or the walk's own by inverse dynamics."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, own_torques, plate_options, show
from exo_pin.errors import GaitError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.dynamics import Dynamics
    from exo_pin.gait import Gait, Torques

_OPENSIM = (".mot", ".sto")


def add(parser: argparse.ArgumentParser, purpose: str = "for a further tab of curves") -> None:
    """`--torques FILE`, or `own`.

    Args:
        parser: Of the command.
        purpose: What the torques are for, in its help.
    """
    parser.add_argument(
        "--torques",
        metavar="FILE",
        help=f"joint torques of the walk, {purpose}: own (by inverse dynamics, as `exo-pin "
        "torques` has it), OpenSim's inverse dynamics (.sto), Plug-in Gait's moments (.c3d), or a .csv with "
        "time_s and columns like left_knee_flexion_torque_nm",
    )


OWN = "own"
"""In place of a file: inverse dynamics of the walk itself."""


def given(args: argparse.Namespace, body: Body, walk: Gait) -> Torques | None:
    """The torques that the arguments name; OpenSim's have the signs of `--preset` or of the walk's file.

    What reading the file corrected is printed as a note, and what is doubtful in the walk's own torques.

    Args:
        args: The command line, with the arguments of `add`.
        body: Who walks.
        walk: The walk.

    Raises:
        FormatError: The file cannot be read, nothing tells the sign of its knee, or force plates are not of
            the walk.
        GaitError: No torque of the walk itself can be computed.
    """
    if args.torques is None:
        return None
    if args.torques == OWN:
        return computed(args, body, walk).to_torques()
    torques = _loaded(args)
    for remark in torques.remarks:
        print(f"note: {show.plain(f'{Path(args.torques).name}: {remark}')}", file=sys.stderr)
    return torques


def computed(args: argparse.Namespace, body: Body, walk: Gait) -> Dynamics:
    """By inverse dynamics on the 12-joint exoskeleton, whatever device is asked for.

    Args:
        args: The command line, with the arguments of `plate_options.add`.
        body: Who walks.
        walk: The walk.

    Raises:
        FormatError: Force plates are not of the walk.
        GaitError: No torque can be computed.
    """
    from exo_pin.robot import load_robot

    robot = load_robot(body)
    return own_torques.inverse_dynamics(args, robot, options.with_events(robot, walk)[0])


def on_plates(args: argparse.Namespace, body: Body, walk: Gait) -> Dynamics | None:
    """As `computed`, of a walk with force plates; a note and None where they do not fit it.

    Args:
        args: The command line, with the arguments of `plate_options.add`.
        body: Who walks.
        walk: The walk.
    """
    if walk.periodic or not plate_options.measured(args):
        return None
    try:
        return computed(args, body, walk)
    except GaitError as error:
        print(f"note: the ground reaction is not shown: {show.plain(str(error))}", file=sys.stderr)
        return None


def _loaded(args: argparse.Namespace) -> Torques:
    from exo_pin.formats import knee_preset, load_torques

    files, kind = args.files, Path(args.torques).suffix.lower()
    torques = files.open(args.torques, "torques")
    if kind not in _OPENSIM:
        return load_torques(torques, mass=args.mass if kind == ".c3d" else None)
    preset = args.preset
    if preset is None and Path(args.gait).suffix.lower() in _OPENSIM:
        preset = knee_preset(files.open(args.gait), model=args.model)
    return load_torques(torques, preset=preset)


def of_shown(torques: Torques | None, recorded: Gait, shown: Gait) -> Torques | None:
    """The torques, unless the walk that is shown has other times; then a note, and None.

    Args:
        torques: Of the recorded walk.
        recorded: The walk as given.
        shown: The walk that is shown, perhaps slower.
    """
    import numpy as np

    if torques is None or np.array_equal(recorded.time, shown.time):
        return torques
    print(
        "note: --torques is left out: they are those of the recorded walk, a slower one is shown",
        file=sys.stderr,
    )
    return None

"""Options that several commands share: the gait, the body, JSON."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import HIP_ORDERS, Body
from exo_pin.anatomy.names import SIGN_PRESETS
from exo_pin.cli import body_options, plate_options, show, trials
from exo_pin.cli.opened_files import OpenedFiles
from exo_pin.errors import DescriptionError, GaitError, UnknownNameError, same_name
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.gait import Gait, Plausibility
    from exo_pin.robot import Robot


def add_gait(parser: argparse.ArgumentParser, *, default: str | None = "free") -> None:
    """GAIT: a file, or the name of one of the normative speeds."""
    what = (
        f"a gait file (.csv .mot .sto .npz .yaml .json .c3d .trc ...) or a normal walk: {', '.join(SPEEDS)}"
    )
    if default is None:
        parser.add_argument("gait", metavar="GAIT", type=_walk, help=what)
    else:
        parser.add_argument(
            "gait",
            metavar="GAIT",
            nargs="?",
            type=_walk,
            default=default,
            help=f"{what} (default: {default})",
        )
    add_preset(parser, "sign convention (and names) of a file that does not tell it")
    trials.add(parser)


def _walk(text: str) -> str:
    """The speed that is meant (`Free`, `very-slow`), or a file's name as it is."""
    return text if Path(text).exists() else same_name(text, SPEEDS) or text


def add_preset(parser: argparse._ActionsContainer, what: str) -> None:
    """The sign convention of a laboratory."""
    parser.add_argument("--preset", choices=SIGN_PRESETS, help=what)


def gait_from(args: argparse.Namespace, body: Body) -> Gait:
    """The gait of the arguments; what its file was read as, and reasons to doubt that, go to stderr."""
    walk = trials.gait(args)
    if walk is None:
        options = {"preset": args.preset, "mapping": trials.mapping(args), "units": args.units}
        options |= trials.positions(args)
        walk = load(args.gait, body, args.files, **options, **trials.opensim(args))
    if args.gait not in SPEEDS and walk.source:
        print(f"read: {show.plain(walk.source)}", file=sys.stderr)
    walk = plate_options.with_plate_events(args, body, walk)
    if trials.is_file(args):
        body_options.print_person(args)
    for remark in walk.remarks:
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    for reason in _doubts(args, body, walk):
        print(f"warning: {reason}", file=sys.stderr)
    return walk


def _doubts(args: argparse.Namespace, body: Body, walk: Gait) -> tuple[str, ...]:
    """Reasons to doubt a walk of a file."""
    if not trials.is_file(args):
        return ()
    from exo_pin.robot import load_robot

    return judged(args, load_robot(body), walk).verdict.reasons


def load(name: str, body: Body, files: OpenedFiles | None = None, **options: Any) -> Gait:
    """A gait by file or speed; a normal walk's stride time follows the body's legs.

    Args:
        name: A file, or one of `SPEEDS`.
        body: Who walks.
        files: Those that the command has opened.
        options: Of a file, as `formats.load_gait` takes them.

    Raises:
        DescriptionError: Options are given for a normal walk.
        FormatError: The file cannot be read.
        UnknownNameError: There is no such speed.
    """
    if name in SPEEDS and not Path(name).exists():
        if any(options.values()) or (files and files.length_unit):
            raise DescriptionError(
                f"{name} is a normal walk; --preset, --map, --columns, --units and --model are for files"
            )
        from exo_pin.gait import normative_gait

        return normative_gait(name, leg_length=body.leg_length)
    if not Path(name).suffix and not Path(name).exists():
        raise UnknownNameError("gait (a file or a speed)", name, SPEEDS)
    files = files or OpenedFiles()
    if trials.may_hold_markers(Path(name)) and files.open(name).needs_inverse_kinematics:
        return files.reconstruct(name).gait
    from exo_pin.formats import load_gait

    return load_gait(files.open(name), **options)


def plausibility(args: argparse.Namespace, robot: Robot, walk: Gait) -> Plausibility:
    """The verdict on a walk as it was read: by its motion, its markers and its force plates."""
    return judged(args, robot, walk).verdict


@dataclass(frozen=True, eq=False)
class JudgedWalk:
    """A walk with its events and the verdict on it.

    Attributes:
        read: The walk as it was read.
        body: Who walks.
        gait: The walk, with its events or those of its kinematics.
        events_note: Why there are no events; empty where there are.
        verdict: By its motion, its markers and its force plates.
    """

    read: Gait
    body: Body | None
    gait: Gait
    events_note: str
    verdict: Plausibility


def judged(args: argparse.Namespace, robot: Robot, walk: Gait) -> JudgedWalk:
    """Events of a walk and the verdict on it, found once for a command: a long recording takes seconds.

    Args:
        args: The command line; it keeps the answer.
        robot: The robot that walks.
        walk: As it was read, or with the events that were found in it.
    """
    from exo_pin import kinematics

    kept: JudgedWalk | None = getattr(args, "judged", None)
    if kept is not None and kept.body == robot.body and (walk is kept.read or walk is kept.gait):
        return kept
    more = (*trials.doubts(args), *kinematics.disagreements(args.event_differences))
    gait, note = with_events(robot, walk)
    found = JudgedWalk(walk, robot.body, gait, note, kinematics.plausibility(robot, gait, more=more))
    args.judged = found
    return found


def add_body(parser: argparse.ArgumentParser) -> None:
    """The options of `body_options`."""
    body_options.add(parser)


def add_hip_order(parser: argparse.ArgumentParser) -> None:
    """The order of the hip axes."""
    parser.add_argument(
        "--hip-order", choices=tuple(HIP_ORDERS), default="clinical", help="hip axes (default: clinical)"
    )


def body_from(args: argparse.Namespace) -> Body:
    """The body of the arguments, as `body_options.sized` has it; errors as there."""
    return body_options.sized(args).body


def with_events(robot: Robot, gait: Gait) -> tuple[Gait, str]:
    """The gait with events: its own, or those of its kinematics; and a note where there are none."""
    from exo_pin import kinematics

    try:
        return kinematics.with_events(robot, gait), ""
    except GaitError as error:
        return gait, f"The motion tells no heel strikes and toe-offs: {error}"

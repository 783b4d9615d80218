"""Options that several commands share: the gait, the body, JSON."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.anatomy import HIP_ORDERS, Body
from exo_pin.anatomy.body import both_sides
from exo_pin.anatomy.names import SIGN_PRESETS
from exo_pin.cli import plate_options, show, trials
from exo_pin.cli.opened_files import OpenedFiles
from exo_pin.errors import DescriptionError, GaitError, UnknownNameError
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
        parser.add_argument("gait", metavar="GAIT", help=what)
    else:
        parser.add_argument(
            "gait", metavar="GAIT", nargs="?", default=default, help=f"{what} (default: {default})"
        )
    add_preset(parser, "sign convention (and names) of a file that does not tell it")
    trials.add(parser)


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
    for remark in walk.remarks:
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    from exo_pin.gait import implausibilities

    for reason in (*implausibilities(walk), *trials.doubts(args)):
        print(f"warning: {reason}", file=sys.stderr)
    return walk


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
    from exo_pin import kinematics

    more = (*trials.doubts(args), *kinematics.disagreements(args.event_differences))
    return kinematics.plausibility(robot, walk, more=more)


def add_body(parser: argparse.ArgumentParser) -> None:
    """The body: a file, or a person's measures, or both (measures win)."""
    group = parser.add_argument_group("body")
    group.add_argument("--body", metavar="FILE", help="body file, as `exo-pin body` writes it")
    group.add_argument("--stature", type=float, metavar="M", help="height of the person [m] (default: 1.75)")
    group.add_argument("--mass", type=float, metavar="KG", help="mass of the person [kg] (default: 70)")
    group.add_argument("--sex", choices=("male", "female"), help="whose segment masses (default: male)")
    group.add_argument("--waist-width", type=float, metavar="M", help="inner width of the waist ring [m]")
    group.add_argument("--hip-width", type=float, metavar="M", help="between the hip joint centres [m]")
    group.add_argument("--no-wearer", action="store_true", help="the bare device: nobody's mass in it")
    group.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="any other size, e.g. thigh=0.43 or left_thigh=0.42 (see `exo-pin body`)",
    )


def add_hip_order(parser: argparse.ArgumentParser) -> None:
    """The order of the hip axes."""
    parser.add_argument(
        "--hip-order", choices=tuple(HIP_ORDERS), default="clinical", help="hip axes (default: clinical)"
    )


def body_from(args: argparse.Namespace) -> Body:
    """The body that the arguments describe.

    Raises:
        DescriptionError: A measure is not plausible.
    """
    scaled = trials.body(args)
    if scaled is not None:
        return dataclasses.replace(scaled, wearer=False) if args.no_wearer else scaled
    measures = {name: getattr(args, name) for name in ("stature", "mass", "sex", "waist_width", "hip_width")}
    values: dict[str, Any] = {name: value for name, value in measures.items() if value is not None}
    values |= dict(map(assignment, args.set))
    if args.no_wearer:
        values["wearer"] = False
    if args.body is None:
        return Body.from_stature(**values)
    body = Body.load(args.body)
    grown = {"stature", "mass", "sex"} & set(values)
    if grown:
        raise DescriptionError(
            f"--body holds every size already; --{sorted(grown)[0]} would contradict it (change the file)"
        )
    return dataclasses.replace(body, **both_sides(values))


def assignment(text: str, *, sign: str = "=") -> tuple[str, Any]:
    """`name=value` as a pair; numbers and true/false are read as such.

    Raises:
        DescriptionError: There is no sign in it.
    """
    name, found, value = text.partition(sign)
    if not found or not name:
        raise DescriptionError(f"{text!r} is not of the form name{sign}value")
    if value in ("true", "false"):
        return name, value == "true"
    try:
        return name, float(value)
    except ValueError:
        return name, value


def with_events(robot: Robot, gait: Gait) -> tuple[Gait, str]:
    """The gait with events: its own, or those of its kinematics; and a note where there are none."""
    from exo_pin import kinematics

    try:
        return kinematics.with_events(robot, gait), ""
    except GaitError as error:
        return gait, f"The motion tells no heel strikes and toe-offs: {error}"

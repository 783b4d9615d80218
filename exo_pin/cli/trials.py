"""Marker trials on the command line: their walk, and their body where no measure is given."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from exo_pin.anatomy.person import Person
from exo_pin.cli import plate_options
from exo_pin.cli.opened_files import OpenedFiles
from exo_pin.errors import DescriptionError, FormatError
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.gait import Gait
    from exo_pin.gait.marked_feet import FootMarkers
    from exo_pin.markers import Reconstruction
    from exo_pin.robot import Robot

_MARKER_ENDINGS = (".trc", ".c3d", ".csv", ".txt", ".tsv")
"""Of `exo_pin.formats.MARKER_FORMATS`, which takes time to import."""


def add(parser: argparse.ArgumentParser) -> None:
    """Options of tables of other laboratories and of marker trials, and the files that the command opens."""
    parser.set_defaults(files=OpenedFiles())
    group = parser.add_argument_group("files of other laboratories")
    group.add_argument(
        "--map",
        action="append",
        default=[],
        metavar="COLUMN=JOINT",
        help="a table's column is this joint, or `time`; --map=-COLUMN=JOINT turns the sign, a number as "
        "COLUMN holds the joint there; of a marker trial: MARKER=NAME, a marker's name in its set",
    )
    group.add_argument(
        "--columns",
        metavar="A,B,...",
        help="of a table without column names: each column's joint, `time` or `_` (not used); -JOINT turns "
        "the sign",
    )
    group.add_argument(
        "--row-rate", type=float, metavar="HZ", help="rows per second of a table without a column of seconds"
    )
    group.add_argument(
        "--units",
        action=_Units,
        choices=("deg", "rad", "mm", "cm", "m"),
        help="of angles, or of lengths in a marker trial (.c3d, .trc), where the file does not tell "
        "or is wrong; repeat for both",
    )
    group.add_argument(
        "--model",
        metavar="OSIM",
        help="the OpenSim model of a .mot: axes, order and signs of its coordinates; of a trial: where "
        "markers sit on the person that the model was scaled to",
    )
    group.add_argument(
        "--pelvis-order",
        metavar="A,B,C",
        help="without a model: the pelvis's turns from the ground on (default: tilt,list,rotation)",
    )
    group.add_argument(
        "--markers", metavar="SET", help="use a trial's markers, of this set, TOML file or `auto`"
    )
    group.add_argument("--static", metavar="FILE", help="a standing trial that the body is scaled from")
    plate_options.add(group)


class _Units(argparse.Action):
    """A unit of angles is an option of its own, one of lengths belongs to the files that are opened."""

    def __call__(
        self, parser: argparse.ArgumentParser, args: argparse.Namespace, values: Any, option: Any = None
    ) -> None:
        if values in ("deg", "rad"):
            args.units = values
        else:
            args.files.length_unit = values


def mapping(args: argparse.Namespace) -> dict[str, str]:
    """The pairs of `--map`: the file's name of a column or marker -> ours.

    Raises:
        DescriptionError: A word of it is not of the form NAME=NAME.
    """
    return dict(map(_pair, args.map))


def _pair(text: str) -> tuple[str, str]:
    """`COLUMN=JOINT` as a pair; a column's own name may hold the sign `=`."""
    column, found, joint = text.rpartition("=")
    if not (found and column and joint):
        raise DescriptionError(f"--map {text!r} is not of the form COLUMN=JOINT")
    return column, joint


def positions(args: argparse.Namespace) -> dict[str, Any]:
    """Options of a table without column names, as `load_gait` takes them."""
    columns = () if args.columns is None else tuple(args.columns.split(","))
    return {"columns": columns, "row_rate": args.row_rate}


def opensim(args: argparse.Namespace) -> dict[str, Any]:
    """Options of OpenSim's coordinates, as `load_gait` takes them."""
    order = None if args.pelvis_order is None else args.pelvis_order.split(",")
    return {"model": args.model, "pelvis_order": order}


def found(args: argparse.Namespace) -> Reconstruction | None:
    """The walk of the arguments' marker trial, or None where GAIT is no trial or has angles of its own.

    Raises:
        FormatError: The trial cannot be read, or makes no walk.
    """
    if "files" not in args or not args.gait:
        return None
    path, chosen = Path(args.gait), args.markers is not None or args.static is not None
    if not (may_hold_markers(path) and (chosen or args.files.open(path).needs_inverse_kinematics)):
        return None
    files: OpenedFiles = args.files
    return files.reconstruct(
        path,
        static=args.static,
        markers=None if args.markers == "auto" else args.markers,
        model=args.model,
        mapping=tuple(mapping(args).items()),
        mass=args.mass,
        sex=args.sex or "male",
    )


def may_hold_markers(path: Path) -> bool:
    """Whether a file's ending is that of a marker trial."""
    return path.suffix.lower() in _MARKER_ENDINGS


def person(args: argparse.Namespace) -> Person:
    """What the trial of the arguments says of its person; nothing where GAIT is no file.

    Raises:
        FormatError: The trial, its standing trial or the model cannot be read.
    """
    return args.files.person(lambda: _person(args)) if is_file(args) else Person()


def is_file(args: argparse.Namespace) -> bool:
    """Whether GAIT is a file, and no normal walk or a word that is neither."""
    if "files" not in args or not getattr(args, "gait", None):
        return False
    path = Path(args.gait)
    return path.exists() or (bool(path.suffix) and args.gait not in SPEEDS)


def _person(args: argparse.Namespace) -> Person:
    from exo_pin.markers.trial_person import trial_person

    files: OpenedFiles = args.files
    model = None if args.model is None else Path(args.model)
    known = trial_person(files.open(args.gait), found(args), model)
    return known if args.static is None else known.over(files.open(args.static, "markers").person())


def feet(args: argparse.Namespace, robot: Robot, walk: Gait) -> FootMarkers | None:
    """Heel and toe markers of the arguments' trial; None where it has none, or GAIT is no trial.

    Args:
        args: The command's arguments.
        robot: On the person's body.
        walk: The walk of the trial.
    """
    if not (is_file(args) and may_hold_markers(Path(args.gait))):
        return None
    from exo_pin.formats import load_markers
    from exo_pin.kinematics import foot_markers

    try:
        return foot_markers(load_markers(args.files.open(args.gait)), robot, walk)
    except FormatError:  # a trial whose unit of length is not known has no lengths
        return None


def gait(args: argparse.Namespace) -> Gait | None:
    """The trial's walk; how well the markers are met goes to stderr."""
    trial = found(args)
    if trial is None:
        return None
    if args.pelvis_order:
        raise FormatError(args.gait, "an order of the pelvis's turns is for .mot and .sto files")
    print(sentence(trial), file=sys.stderr)
    return trial.gait


def sentence(trial: Reconstruction) -> str:
    """How well the markers are met."""
    k, marker = divmod(int(np.nanargmax(trial.error)), len(trial.names))
    frame = int(trial.rms.argmax())
    rms, furthest = 1e3 * trial.rms[frame], 1e3 * trial.worst[k]
    time = trial.gait.time
    return (
        f"markers ({trial.marker_set}): RMS {1e3 * trial.total_rms:.1f} mm, worst frame {rms:.1f} mm at "
        f"{time[frame]:.2f} s, furthest marker {trial.names[marker]} {furthest:.1f} mm at {time[k]:.2f} s; "
        f"body scaled to {trial.body.stature:.2f} m"
    )


def doubts(args: argparse.Namespace) -> tuple[str, ...]:
    """Reasons to doubt that the markers were understood; none where GAIT is no trial."""
    trial = found(args)
    return () if trial is None else trial.doubts


def to_json(args: argparse.Namespace) -> dict[str, Any] | None:
    """How well the markers are met, by frame and marker, for JSON; None where GAIT is no trial."""
    trial = found(args)
    if trial is None:
        return None
    return {
        "set": trial.marker_set,
        "rms_mm": 1e3 * trial.total_rms,
        "filled_coordinates": trial.filled,
        "frame_rms_mm": (1e3 * trial.rms).tolist(),
        "frame_worst_mm": (1e3 * trial.worst).tolist(),
        "marker_rms_mm": {name: 1e3 * error for name, error in trial.by_marker().items()},
        "stature_m": trial.body.stature,
    }

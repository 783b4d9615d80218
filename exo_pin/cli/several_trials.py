"""Several trials on the command line: each read as a walk of its own, with its cycles, scores and numbers."""

from __future__ import annotations

import argparse
import copy
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from exo_pin.cli import options, show, trials
from exo_pin.cli.opened_files import OpenedFiles
from exo_pin.errors import ExoPinError, FormatError, shortened

if TYPE_CHECKING:
    from exo_pin.clinic import NormalBand, Trial

_MOST_FILES = 500
"""Of a folder."""

_SHORTEST_REASON = 160  # characters of a reason that a page prints


class Found(NamedTuple):
    """Trials that were read, and why others were not.

    Attributes:
        trials: In the order of their names.
        failures: Name -> reason.
    """

    trials: list[Trial]
    failures: dict[str, str]


def of_folder(args: argparse.Namespace, folder: Path, band: NormalBand | None) -> Found:
    """Every trial of a folder that can be read.

    Args:
        args: The command line, with the arguments of `trials.add` and of the body.
        folder: Where they are; folders in it are not looked into.
        band: Normal walks that they are scored against.

    Raises:
        FormatError: The folder holds no trial, or too many files.
    """
    from exo_pin.formats import FORMATS, MARKER_FORMATS

    endings = {*FORMATS, *MARKER_FORMATS}
    paths = sorted(path for path in folder.iterdir() if path.is_file() and path.suffix.lower() in endings)
    if not paths or len(paths) > _MOST_FILES:
        raise FormatError(folder, f"holds {len(paths)} trial files; 1 .. {_MOST_FILES} are accepted")
    found = Found([], {})
    for path in show.progress(paths, "trials", len(paths)):
        try:
            found.trials.append(trial(args, str(path), band))
        except ExoPinError as error:
            why = str(error).removeprefix(f"{path}: ")
            found.failures[path.name] = shortened(show.plain(why), _SHORTEST_REASON)
    if not found.trials:
        name, why = next(iter(found.failures.items()))
        raise FormatError(folder, f"none of its {len(paths)} files is a walk: {name}: {why}")
    return found


def of_names(args: argparse.Namespace, names: Sequence[str], band: NormalBand | None) -> list[Trial]:
    """Named trials; arguments as of `of_folder`, and its errors, for the first that cannot be read."""
    return [trial(args, name, band) for name in show.progress(names, "trials", len(names))]


def trial(args: argparse.Namespace, name: str, band: NormalBand | None) -> Trial:
    """One trial, with the command's options for files and body.

    Args:
        args: The command line.
        name: The file, or a speed of the normal walk.
        band: Normal walks.

    Raises:
        FormatError: It cannot be read.
    """
    from exo_pin import clinic, kinematics
    from exo_pin.robot import load_robot

    mine = copy.copy(args)
    mine.gait, mine.files, mine.judged = name, OpenedFiles(), None
    mine.files.length_unit = args.files.length_unit
    print(f"{show.plain(Path(name).name)}:", file=sys.stderr)
    body = options.body_from(mine)
    walk = options.gait_from(mine, body)
    robot = load_robot(body)
    walk = options.with_events(robot, walk)[0]
    feet, file = trials.feet(mine, robot, walk), mine.files.open(name) if trials.is_file(mine) else None
    further = None if file is None else file.further_angles()
    sides = clinic.clinical_cycles(robot, walk, further, feet)
    return clinic.Trial(
        name=Path(name).name,
        sides=sides,
        profile=None if band is None else clinic.gait_profile(sides, band),
        numbers=kinematics.walk_numbers(robot, walk, feet),
        session={} if file is None else file.session(),
    )

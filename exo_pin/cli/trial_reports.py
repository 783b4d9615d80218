"""The report of several trials, or of a folder of them."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import several_trials
from exo_pin.cli.clock import moment
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.clinic import NormalBand
    from exo_pin.report import Document

_OF_ONE = ("simulate", "patient", "torques", "compare", "robot", "static", "forces")
"""Options of one walk."""


def document(args: argparse.Namespace, band: NormalBand | None) -> Document:
    """Trials over each other, or the index of a folder.

    Args:
        args: The command line of `report`.
        band: Normal walks.

    Raises:
        DescriptionError: An option belongs to one walk.
        FormatError: A trial cannot be read, or the folder holds none.
    """
    from exo_pin import report

    for name in _OF_ONE:
        if getattr(args, name) is not None:
            raise DescriptionError(f"--{name} belongs to one walk; leave it away for several")
    names = [args.gait, *args.more]
    if len(names) == 1:
        folder = Path(names[0])
        found = several_trials.of_folder(args, folder, band)
        title = args.title or f"Trials of {folder.resolve().name}"
        return report.folder(found.trials, found.failures, band, title=title, when=moment())
    trials = several_trials.of_names(args, names, band)
    return report.trials(trials, band, title=args.title or "Trials compared", when=moment())

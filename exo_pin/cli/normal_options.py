"""The normal band on the command line: Schwartz 2008 at a speed, a file of one's own, or none."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.errors import UnknownNameError, same_name
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.clinic import NormalBand

_PUBLISHED = "schwartz2008"
_NONE = "none"


def add(parser: argparse.ArgumentParser) -> None:
    """`--normal`."""
    parser.add_argument(
        "--normal",
        default="free",
        metavar="NAME|FILE",
        help=f"normal band: {_PUBLISHED} (children, free speed; the default), one of its speeds "
        f"({', '.join(SPEEDS)}), a .csv of `exo-pin normal`, or {_NONE}",
    )


def band(args: argparse.Namespace) -> NormalBand | None:
    """The band of `--normal`; None for none.

    Raises:
        FormatError: The file is no band.
        UnknownNameError: There is no such band.
    """
    from exo_pin.clinic import load_band, published_band

    name = args.normal
    if Path(name).suffix.lower() == ".csv":
        return load_band(name)
    word = name.lower().removeprefix(_PUBLISHED).strip("-:_ ") or "free"
    if word == _NONE:
        return None
    speed = same_name(word, SPEEDS)
    for known in SPEEDS:
        if known == speed:
            return published_band(known)
    raise UnknownNameError("normal band (or a .csv file)", name, (_PUBLISHED, *SPEEDS, _NONE))

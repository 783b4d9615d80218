"""Joint torques on the command line; the sign of their knee is that of the walk's file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from exo_pin.gait import Torques

_OPENSIM = (".mot", ".sto")


def add(parser: argparse.ArgumentParser) -> None:
    """`--torques FILE`."""
    parser.add_argument(
        "--torques",
        metavar="FILE",
        help="joint torques of the walk, for a further tab of curves: OpenSim's inverse dynamics (.sto), "
        "Plug-in Gait's moments (.c3d), or a .csv with time_s and columns like left_knee_flexion_torque_nm",
    )


def given(args: argparse.Namespace) -> Torques | None:
    """The torques that the arguments name; OpenSim's have the signs of `--preset` or of the walk's file.

    Raises:
        FormatError: The file cannot be read, or nothing tells the sign of its knee.
    """
    if args.torques is None:
        return None
    from exo_pin.formats import knee_preset, load_torques

    files, kind = args.files, Path(args.torques).suffix.lower()
    torques = files.open(args.torques, "torques")
    if kind not in _OPENSIM:
        return load_torques(torques, mass=args.mass if kind == ".c3d" else None)
    preset = args.preset
    if preset is None and Path(args.gait).suffix.lower() in _OPENSIM:
        preset = knee_preset(files.open(args.gait), model=args.model)
    return load_torques(torques, preset=preset)

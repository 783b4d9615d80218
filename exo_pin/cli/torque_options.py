"""Torque files on the command line: their knee's sign is that of the walk's file."""

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
    from exo_pin.formats import load_torques
    from exo_pin.formats.opensim.coordinates import preset_of

    kind = Path(args.torques).suffix.lower()
    if kind not in _OPENSIM:
        return load_torques(args.torques, mass=args.mass if kind == ".c3d" else None)
    told = args.preset
    if told is None and Path(args.gait).suffix.lower() in _OPENSIM:
        told = preset_of(Path(args.gait), model=Path(args.model) if args.model else None)
    return load_torques(args.torques, preset=told)

"""Files that `exo-pin torques` writes: the torques, and for OpenSim what its own tool computes them from."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from exo_pin.anatomy.names import SignPreset
from exo_pin.cli import device_options
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.dynamics import Dynamics
    from exo_pin.gait import Gait

_OPENSIM = (".sto", ".mot")


class _Beside(NamedTuple):
    """Files beside one of torques for OpenSim, named after it."""

    forces: Path
    loads: Path
    setup: Path
    coordinates: Path


def add(parser: argparse.ArgumentParser) -> None:
    """`-o` and `--as`."""
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="write the torques (.csv, .sto or .mot); beside a .sto or .mot go FILE_forces.mot (force, "
        "point and moment on each foot), FILE_loads.xml (ExternalLoads that name it), FILE_setup.xml (for "
        "OpenSim's InverseDynamicsTool) and, unless the walk is a .mot or .sto itself, FILE_coordinates.mot",
    )
    parser.add_argument(
        "--as",
        dest="written",
        choices=("opensim-gait2392", "opensim-rajagopal"),
        help="of a .sto or .mot: the family of the model it is for (default: that of the walk's own .mot or "
        ".sto, else opensim-rajagopal)",
    )


def check(args: argparse.Namespace) -> None:
    """Refuse endings that are not written, before the work."""
    from exo_pin.formats import TORQUE_SUFFIXES

    ending = Path(args.output or "").suffix.lower()
    if args.output and ending not in TORQUE_SUFFIXES:
        raise DescriptionError(f"{args.output}: torques are written to {', '.join(TORQUE_SUFFIXES)}")
    if args.written and ending not in _OPENSIM:
        raise DescriptionError("--as is for a .sto or .mot file, named with -o")


def outputs(args: argparse.Namespace) -> list[str]:
    """The files beside the one that `-o` names."""
    if not args.output or Path(args.output).suffix.lower() not in _OPENSIM:
        return []
    beside = _beside(Path(args.output))
    return [str(path) for path in beside if path != beside.coordinates or not _of_opensim(args)]


def write(args: argparse.Namespace, found: Dynamics, walk: Gait) -> None:
    """Write what the arguments ask for; a line for each file, on the terminal alone where JSON is printed.

    Args:
        args: The command line, with the arguments of `add`.
        found: The torques.
        walk: The walk that they are of.
    """
    from exo_pin.formats import save_torques

    path, lines = Path(args.output), []
    preset: SignPreset | None = None
    if path.suffix.lower() in _OPENSIM:
        preset = args.written or _preset(args)
        lines = _write_beside(args, found, walk, preset)
    save_torques(found.to_torques(), path, preset=preset)
    lines.insert(0, f"{path}: {int(found.valid.sum())} of {len(found.time)} samples hold torques")
    if not args.json:
        print("\n".join(lines))


def _write_beside(args: argparse.Namespace, found: Dynamics, walk: Gait, preset: SignPreset) -> list[str]:
    from exo_pin.dynamics import CUTOFF
    from exo_pin.formats import save_gait
    from exo_pin.formats.opensim import write_external_loads, write_foot_forces, write_tool_setup

    beside, feet = _beside(Path(args.output)), found.foot_forces()
    times = feet["left"].time
    write_foot_forces(feet, beside.forces, source=found.source)
    write_external_loads(beside.loads, beside.forces, tuple(feet))
    coordinates = Path(args.gait)
    if not _of_opensim(args):
        coordinates = beside.coordinates
        base = found.motion.base if found.reaction == "predicted" else walk.base
        save_gait(dataclasses.replace(walk, base=base), coordinates, preset=preset)
    write_tool_setup(
        beside.setup,
        loads=beside.loads,
        coordinates=coordinates,
        model=Path(args.model) if args.model else None,
        times=(float(times[0]), float(times[-1])),
        cutoff=None if walk.periodic else CUTOFF,
    )
    return _lines(beside, coordinates, found, len(times), args.model)


def _lines(beside: _Beside, coordinates: Path, found: Dynamics, n: int, model: str | None) -> list[str]:
    """What was written, and what of it is not all."""
    whole = "" if n == found.valid.sum() else ", the longest run without a gap (OpenSim knows no gaps)"
    lines = [
        f"{beside.forces}: {found.reaction} forces on both feet, {n} samples{whole}",
        f"{beside.loads}: OpenSim's ExternalLoads of these forces",
        f"{beside.setup}: for OpenSim's inverse dynamics tool{'' if model else '; name your model in it'}",
    ]
    if coordinates == beside.coordinates:
        lines.append(f"{coordinates}: the walk as OpenSim's coordinates")
    return lines


def _beside(path: Path) -> _Beside:
    names = ("forces.mot", "loads.xml", "setup.xml", "coordinates.mot")
    return _Beside(*(path.with_name(f"{path.stem}_{name}") for name in names))


def _of_opensim(args: argparse.Namespace) -> bool:
    """Whether the walk's own file holds the motion that the torques are of, in OpenSim's coordinates."""
    return Path(args.gait).suffix.lower() in _OPENSIM and not device_options.changes_motion(args)


def _preset(args: argparse.Namespace) -> SignPreset:
    """The model family of the walk's own file."""
    from exo_pin.formats import knee_preset

    if Path(args.gait).suffix.lower() not in _OPENSIM:
        return "opensim-rajagopal"
    named = args.preset or knee_preset(args.files.open(args.gait), model=args.model)
    return named or "opensim-rajagopal"

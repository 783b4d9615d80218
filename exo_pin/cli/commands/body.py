"""`exo-pin body`: a body file from a person's measures, for the other commands."""

from __future__ import annotations

import argparse

from exo_pin.anatomy.sizes import SIZES
from exo_pin.cli import options, show

_EXAMPLES = """examples:
  exo-pin body --stature 1.82 --mass 81 -o patient.toml
  exo-pin body --stature 1.65 --sex female --set left_thigh=0.39 -o patient.toml
  exo-pin replay --body patient.toml

Without -o the sizes are printed. A file's joint ranges [deg] can be edited in it."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_body(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="write a body file (TOML)")


def run(args: argparse.Namespace) -> int:
    """Write the file, or print the sizes."""
    body = options.body_from(args)
    if args.output:
        body.save(args.output)
        print(f"{args.output}: a body of {body.stature:g} m and {body.mass:g} kg")
        return 0
    rows = [[name, f"{getattr(body, name):.4f}", s.unit, s.what] for name, s in SIZES.items()]
    show.table(f"Body: {body.sex}, {body.stature:g} m, {body.mass:g} kg", ["name", "value", "", ""], rows)
    wearer = "wearer and hardware" if body.wearer else "hardware alone"
    print(f"total mass {body.total_mass:.1f} kg ({wearer}), leg length {body.leg_length:.3f} m")
    return 0

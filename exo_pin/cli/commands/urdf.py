"""`exo-pin urdf`: the URDF of the exoskeleton, with any size or xacro argument changed."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from typing import Any, cast

from exo_pin.anatomy import Body
from exo_pin.anatomy.names import HipOrder
from exo_pin.anatomy.sizes import LEG_SIZES
from exo_pin.cli import body_options, options
from exo_pin.files import write_text

_EXAMPLES = """examples:
  exo-pin urdf -o exo.urdf
  exo-pin urdf stature:=1.82 waist_width:=0.40 left_thigh:=0.43 -o exo.urdf
  exo-pin urdf device:=lokomat -o lokomat.urdf
  exo-pin urdf hip_order:=yaw_roll_pitch left_knee_flexion_upper:=1.9
  exo-pin urdf --body patient.toml -o patient.urdf

name:=value takes every size of `exo-pin body`, device (`exo-pin devices`), hip_order, and every argument of
urdf/arguments.xacro (masses, inertias and limits of single links and joints, in SI units and rad)."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("assignments", nargs="*", metavar="name:=value", help="sizes and xacro arguments")
    options.add_body(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="write here instead of to the terminal")


def run(args: argparse.Namespace) -> int:
    """Make the URDF."""
    from exo_pin import description

    given = dict(body_options.assignment(text, sign=":=") for text in args.assignments)
    device = str(given.pop("device", "exo12"))
    hip_order = cast(HipOrder, given.pop("hip_order", "clinical"))  # description.urdf refuses other words
    fields = {f.name for f in dataclasses.fields(Body)} | set(LEG_SIZES)
    args.set += [f"{name}={_plain(given.pop(name))}" for name in sorted(fields & set(given))]
    for name in ("stature", "mass", "sex"):
        _move_to_option(args, name)
    xacro_arguments = {name: str(value) for name, value in given.items()}
    text = description.urdf(options.body_from(args), device=device, hip_order=hip_order, **xacro_arguments)
    if args.output:
        write_text(args.output, text)
        print(f"{args.output}: {len(text)} bytes")
    else:
        sys.stdout.write(text)
    return 0


def _plain(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _move_to_option(args: argparse.Namespace, name: str) -> None:
    """Make `stature:=1.8` the same as `--stature 1.8`."""
    for text in [t for t in args.set if t.startswith(f"{name}=")]:
        args.set.remove(text)
        setattr(args, name, body_options.assignment(text)[1])

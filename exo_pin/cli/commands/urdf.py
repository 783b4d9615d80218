"""`exo-pin urdf`: the URDF of the exoskeleton, with any size or xacro argument changed."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from typing import Any, cast

from exo_pin.anatomy import Body
from exo_pin.anatomy.names import HipOrder, Masses
from exo_pin.anatomy.sizes import LEG_SIZES
from exo_pin.cli import body_options, options
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

_EXAMPLES = """examples:
  exo-pin urdf -o exo.urdf
  exo-pin urdf stature:=1.82 waist_width:=0.40 left_thigh:=0.43 -o exo.urdf
  exo-pin urdf --device lokomat --stature 1.82 -o lokomat.urdf
  exo-pin urdf --hip-order yaw_roll_pitch left_knee_flexion_upper:=1.9
  exo-pin urdf --body patient.toml -o patient.urdf

name:=value takes every size of `exo-pin body`, device and hip_order as the options do, and every argument of
urdf/arguments.xacro (masses, inertias and limits of single links and joints, in SI units and rad)."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("assignments", nargs="*", metavar="name:=value", help="sizes and xacro arguments")
    parser.add_argument("--device", metavar="DEVICE", help="name or device file (default: exo12)")
    options.add_hip_order(parser)
    parser.set_defaults(hip_order=None)  # None: not given, so name:=value may give it
    options.add_body(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="write here instead of to the terminal")


def run(args: argparse.Namespace) -> int:
    """Make the URDF."""
    from exo_pin import description

    given = dict(body_options.assignment(text, sign=":=") for text in args.assignments)
    device = str(_once(given, args, "device") or "exo12")
    hip_order = cast(HipOrder, _once(given, args, "hip_order") or "clinical")  # urdf() refuses other words
    masses = cast(Masses, given.pop("masses", "both"))
    fields = {f.name for f in dataclasses.fields(Body)} | set(LEG_SIZES)
    for name in ("stature", "mass", "sex"):
        setattr(args, name, _once(given, args, name))
    args.set += [f"{name}={_plain(given.pop(name))}" for name in sorted(fields & set(given))]
    xacro_arguments = {name: str(value) for name, value in given.items()}
    body = options.body_from(args)
    text = description.urdf(body, device=device, hip_order=hip_order, masses=masses, **xacro_arguments)
    if args.output:
        write_text(args.output, text)
        print(f"{args.output}: {len(text)} bytes")
    else:
        sys.stdout.write(text)
    return 0


def _plain(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _once(given: dict[str, Any], args: argparse.Namespace, name: str) -> Any:
    """`stature:=1.8` taken out of the assignments, or `--stature 1.8`; None where neither is there.

    Raises:
        DescriptionError: Both are there and differ.
    """
    option, assigned = getattr(args, name), given.pop(name, None)
    if option is not None and assigned is not None and option != assigned:
        words = f"--{name.replace('_', '-')} {option}"
        raise DescriptionError(f"{words} and {name}:={_plain(assigned)} contradict each other; give one")
    return option if assigned is None else assigned

"""`exo-pin dh`: Craig's modified Denavit-Hartenberg table of this body, in the format one works in."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence

from exo_pin.cli import options
from exo_pin.dh import Row, table

_EXAMPLES = """examples:
  exo-pin dh                                 as Markdown
  exo-pin dh --format matlab --stature 1.82  for Peter Corke's toolbox
  exo-pin dh --format latex --hip-order yaw_roll_pitch > table.tex"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "--format", choices=tuple(_FORMATS), default="markdown", help="output (default: markdown)"
    )
    options.add_body(parser)
    options.add_hip_order(parser)


def run(args: argparse.Namespace) -> int:
    """Print both legs' tables and the largest difference to Pinocchio."""
    import numpy as np

    from exo_pin import crosscheck
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot = load_robot(body, hip_order=args.hip_order)
    random = np.random.default_rng(0).uniform(robot.lower, robot.upper, (1000, len(robot.joints)))
    difference = crosscheck.forward(robot, random)["dh"]
    note = (
        f"modified D-H (Craig), hip order {args.hip_order}, body {body.stature:g} m; frame 0 at the hip "
        f"centre; largest difference to Pinocchio over 1000 random poses: {difference:.1e} m"
    )
    rows = [row for side in ("left", "right") for row in table(body, side, hip_order=args.hip_order)]
    print(_FORMATS[args.format](rows, note))
    return 0


def _angle(name: str, offset: float) -> str:
    """The joint variable as text, e.g. `q2 + 90`."""
    return name if not offset else f"{name} {'-' if offset < 0 else '+'} {abs(math.degrees(offset)):g}"


def _cells(rows: Sequence[Row]) -> list[list[str]]:
    """joint, i, alpha [deg], a [m], theta [deg], d [m]."""
    cells = []
    for k, row in enumerate(rows):
        i = str(k % 6 + 1)
        alpha, theta = f"{math.degrees(row.alpha):g}", _angle(f"q{i}", row.offset)
        cells.append([row.joint, i, alpha, f"{row.a:g}", theta, f"{row.d:g}"])
    return cells


_HEAD = ["joint", "i", "alpha_{i-1} [deg]", "a_{i-1} [m]", "theta_i [deg]", "d_i [m]"]


def _markdown(rows: Sequence[Row], note: str) -> str:
    lines = [_HEAD, ["---"] * len(_HEAD), *_cells(rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + f"\n\n{note}"


def _csv(rows: Sequence[Row], note: str) -> str:
    lines = [
        f"{row.joint},{k % 6 + 1},{row.alpha!r},{row.a!r},{row.offset!r},{row.d!r}"
        for k, row in enumerate(rows)
    ]
    return "\n".join([f"# {note}", "joint,i,alpha_rad,a_m,theta_offset_rad,d_m", *lines])


def _latex(rows: Sequence[Row], note: str) -> str:
    head = r"joint & $i$ & $\alpha_{i-1}$ [deg] & $a_{i-1}$ [m] & $\theta_i$ [deg] & $d_i$ [m] \\ \hline"
    lines = []
    for joint, i, alpha, a, theta, d in _cells(rows):
        name = joint.replace("_", r"\_")
        lines.append(rf"{name} & {i} & ${alpha}$ & ${a}$ & ${theta.replace('q', 'q_')}$ & ${d}$ \\")
    return "\n".join(
        [f"% {note}", r"\begin{tabular}{lrrrrr}", r"\hline", head, *lines, r"\hline", r"\end{tabular}"]
    )


def _matlab(rows: Sequence[Row], note: str) -> str:
    lines = [f"% {note}"]
    for k, side in enumerate(("left", "right")):
        lines.append(f"{side} = SerialLink([")
        lines += [
            f"  Link('revolute', 'modified', 'd', {row.d!r}, 'a', {row.a!r}, "
            f"'alpha', {row.alpha!r}, 'offset', {row.offset!r})  % {row.joint}"
            for row in rows[6 * k : 6 * k + 6]
        ]
        lines.append(f"], 'name', '{side} leg');")
    return "\n".join(lines)


_FORMATS: dict[str, Callable[[Sequence[Row], str], str]] = {
    "markdown": _markdown,
    "csv": _csv,
    "latex": _latex,
    "matlab": _matlab,
}

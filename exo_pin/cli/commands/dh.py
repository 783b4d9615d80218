"""`exo-pin dh`: Craig's modified Denavit-Hartenberg table of a body, as Markdown, CSV, LaTeX or MATLAB."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array
from exo_pin.cli import options
from exo_pin.dh import DHRow, ends, table

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


class _LegTable(NamedTuple):
    """The table of a leg, with T_pelvis_0 before it and T_6_foot behind it."""

    side: Side
    rows: Sequence[DHRow]
    base: Array
    tool: Array


def run(args: argparse.Namespace) -> int:
    """Print both legs' tables and the largest difference to Pinocchio."""
    from exo_pin import crosscheck
    from exo_pin.robot import load_robot

    body, order = options.body_from(args), args.hip_order
    robot = load_robot(body, hip_order=order)
    random = np.random.default_rng(0).uniform(robot.lower, robot.upper, (1000, len(robot.joints)))
    difference = crosscheck.forward(robot, random, witnesses=("dh",))["dh"]
    note = (
        f"modified D-H (Craig), hip order {order}, body {body.stature:g} m; "
        f"T_pelvis_foot = base * rows * tool; largest difference to Pinocchio over 1000 random poses: "
        f"{difference:.1e}"
    )
    legs = [
        _LegTable(side, table(body, side, hip_order=order), *ends(body, side, hip_order=order))
        for side in SIDES
    ]
    print(_FORMATS[args.format](legs, note))
    return 0


def _matrix(T: Array, separator: str = "; ") -> str:
    """The upper three rows as text, with exact zeros where rounding left almost none."""
    return separator.join(" ".join(f"{x:g}" for x in np.round(row, 12) + 0.0) for row in T[:3])


def _angle(name: str, offset: float) -> str:
    """The joint variable as text, e.g. `q2 + 90`."""
    return name if not offset else f"{name} {'-' if offset < 0 else '+'} {abs(math.degrees(offset)):g}"


def _cells(rows: Sequence[DHRow]) -> list[list[str]]:
    """joint, i, alpha [deg], a [m], theta [deg], d [m]."""
    cells = []
    for i, row in enumerate(rows, 1):
        alpha, theta = f"{math.degrees(row.alpha):g}", _angle(f"q{i}", row.offset)
        cells.append([row.joint, str(i), alpha, f"{row.a:g}", theta, f"{row.d:g}"])
    return cells


_HEAD = ["joint", "i", "alpha_{i-1} [deg]", "a_{i-1} [m]", "theta_i [deg]", "d_i [m]"]


def _markdown(legs: Sequence[_LegTable], note: str) -> str:
    lines = [_HEAD, ["---"] * len(_HEAD), *(cells for leg in legs for cells in _cells(leg.rows))]
    drawn = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    return f"{drawn}\n\n{note}\n\n{_ends(legs, '- ')}"


def _ends(legs: Sequence[_LegTable], mark: str) -> str:
    return "\n".join(
        f"{mark}{leg.side} leg: {name} = [{_matrix(T)}; 0 0 0 1]"
        for leg in legs
        for name, T in (("base T_pelvis_0", leg.base), ("tool T_6_foot", leg.tool))
    )


def _csv(legs: Sequence[_LegTable], note: str) -> str:
    lines = [
        f"{row.joint},{i},{row.alpha!r},{row.a!r},{row.offset!r},{row.d!r}"
        for leg in legs
        for i, row in enumerate(leg.rows, 1)
    ]
    return "\n".join([f"# {note}", _ends(legs, "# "), "joint,i,alpha_rad,a_m,theta_offset_rad,d_m", *lines])


def _latex(legs: Sequence[_LegTable], note: str) -> str:
    head = r"joint & $i$ & $\alpha_{i-1}$ [deg] & $a_{i-1}$ [m] & $\theta_i$ [deg] & $d_i$ [m] \\ \hline"
    lines = []
    for joint, i, alpha, a, theta, d in (cells for leg in legs for cells in _cells(leg.rows)):
        name = joint.replace("_", r"\_")
        lines.append(rf"{name} & {i} & ${alpha}$ & ${a}$ & ${theta.replace('q', 'q_')}$ & ${d}$ \\")
    top = [f"% {note}", _ends(legs, "% "), r"\begin{tabular}{lrrrrr}", r"\hline", head]
    return "\n".join([*top, *lines, r"\hline", r"\end{tabular}"])


def _matlab(legs: Sequence[_LegTable], note: str) -> str:
    lines = [f"% {note}"]
    for leg in legs:
        lines.append(f"{leg.side} = SerialLink([")
        lines += [
            f"  Link('revolute', 'modified', 'd', {row.d!r}, 'a', {row.a!r}, "
            f"'alpha', {row.alpha!r}, 'offset', {row.offset!r})  % {row.joint}"
            for row in leg.rows
        ]
        lines.append(f"], 'name', '{leg.side} leg');")
        lines += [
            f"{leg.side}.{name} = [{_matrix(T)}; 0 0 0 1];"
            for name, T in (("base", leg.base), ("tool", leg.tool))
        ]
    return "\n".join(lines)


_FORMATS: dict[str, Callable[[Sequence[_LegTable], str], str]] = {
    "markdown": _markdown,
    "csv": _csv,
    "latex": _latex,
    "matlab": _matlab,
}

"""`exo-pin retarget`: a walk as joint angles of another robot."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, show
from exo_pin.files import write_text
from exo_pin.safe import spreadsheet_cells

if TYPE_CHECKING:
    from exo_pin.retarget import LimitUse, Retargeted
    from exo_pin.retarget.retargeted import FootErrors

_EXAMPLES = """examples:
  exo-pin retarget --robot talos -o joints.csv
  exo-pin retarget walk.mot --robot icub --json
  exo-pin retarget --robot my_robot.urdf     any URDF (or xacro file) with two legs
  exo-pin retarget --robot my_robot.toml     a record of it: feet, front, limits (docs/robots.md)
  exo-pin replay --robot talos               watch it walk

robots: {}. Foot by foot: the feet's paths, scaled to the robot's legs, through inverse kinematics within its
limits; the file holds these angles ("used"; "use" is how far from mid-range to a limit: 100 % is on it).
Joint by joint ("copied"): the walk's own angles, hips and ankles through their rotation; "outside" counts the
samples in which a limit forbids them. "speed / limit": the largest speed over the file's velocity limit.
Notes on stderr say what a leg cannot do: it gives up the foot's attitude first, the ankle's place last.
exit code 1: a foot was missed by more than 0.01 mm or 1e-5 rad (legs of fewer than six joints: 0.01 mm)"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    from exo_pin.retarget.target_robots import TARGETS

    parser.epilog = _EXAMPLES.format(", ".join(TARGETS))
    options.add_gait(parser)
    parser.add_argument(
        "--robot", default="talos", metavar="ROBOT", help="name, .urdf, .xacro or .toml file (default: talos)"
    )
    parser.add_argument(
        "--table", action="store_true", help="all known robots in one Markdown table (of docs/robots.md)"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("-o", "--output", metavar="FILE", help="joint angles as CSV: time_s, <joint>_deg ...")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Retarget, print and write; 0 if every foot was reached, else 1."""
    from exo_pin.retarget import retarget

    body = options.body_from(args)
    gait = options.gait_from(args, body)
    if args.table:
        from exo_pin.retarget.target_table import markdown

        print(markdown(gait, body), end="")
        return 0
    result = retarget(gait, args.robot, body)
    for note in result.notes:
        print(f"note: {show.plain(note)}", file=sys.stderr)
    if args.json:
        show.as_json(result.facts())
    else:
        _print(result, Path(args.gait).name)
    if args.output:
        write_text(args.output, _csv(result))
    return 1 if result.samples_missed else 0


def _print(result: Retargeted, name: str) -> None:
    feet, copied, biped = result.errors, result.copied_errors, result.biped
    rows = [
        ["legs, times the body's", f"{result.scale[0]:.3f}, {result.scale[1]:.3f}"],
        ["joints per leg, hip's order", f"{biped.joints_per_leg}, {biped.hip_order}"],
        ["samples", str(len(result.gait))],
        ["samples with a foot missed", str(result.samples_missed)],
        ["ankle's distance, rms and max", _position(feet)],
        ["foot's angle, rms and max", _rotation(feet)],
        ["joint by joint: ankle's distance", _position(copied)],
        ["joint by joint: foot's angle", _rotation(copied)],
    ]
    show.table(f"{name} on {result.target.title or result.target.name}", ["foot by foot", ""], rows)
    head = ["joint", "stands for", "limits deg", "used deg", "use", "copied deg", "outside"]
    head += ["speed rad/s", "speed / limit"]
    uses = result.limit_use.items()
    show.table("Joints", head, [_line(joint, result.movements[joint], use) for joint, use in uses])
    if result.target.remarks:
        print(result.target.remarks)


def _position(errors: FootErrors) -> str:
    """Root mean square and largest distance of the ankles."""
    return f"{1e3 * errors.position_rms:.3f}, {1e3 * errors.largest_position:.3f} mm"


def _rotation(errors: FootErrors) -> str:
    """Root mean square and largest angle of the feet."""
    return f"{math.degrees(errors.rotation_rms):.3f}, {math.degrees(errors.largest_rotation):.3f} deg"


def _line(joint: str, movement: str, use: LimitUse) -> list[str]:
    used, copied, speed = use
    share = "-" if math.isnan(used.use) else f"{100 * used.use:.0f} %"
    limits, taken = _degrees(*used.available), _degrees(used.lowest, used.highest)
    return [
        show.plain(joint),
        movement.replace("_", " "),
        limits,
        taken,
        share,
        _degrees(copied.lowest, copied.highest),
        str(copied.samples_outside or "-"),
        f"{speed.peak:.2f}",
        f"{speed.use:.2f}" if math.isfinite(speed.available) else "-",
    ]


def _degrees(low: float, high: float) -> str:
    return f"{show.fixed(math.degrees(low))} .. {show.fixed(math.degrees(high))}"


def _csv(result: Retargeted) -> str:
    from numpy import column_stack, degrees

    columns = [result.robot.column(joint) for joint in result.joints]
    head = spreadsheet_cells.table([["time_s", *(f"{joint}_deg" for joint in result.joints)]]).strip()
    rows = column_stack([result.time, degrees(result.q[:, columns])])
    return "\n".join([head, *(",".join(f"{x:.9g}" for x in row) for row in rows)]) + "\n"

"""`exo-pin retarget`: a walk as joint angles of another robot."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, show
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.retarget import Retargeted

_EXAMPLES = """examples:
  exo-pin retarget --robot talos -o joints.csv
  exo-pin retarget walk.mot --robot icub --json

robots: talos, romeo, icub, g1 (example-robot-data). Foot by foot: the feet's paths, scaled to the robot's
legs, through inverse kinematics within its limits; the file holds these angles. exit code 1: a foot was
missed by more than 0.01 mm or 1e-5 rad"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument("--robot", default="talos", metavar="NAME", help="which robot (default: talos)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("-o", "--output", metavar="FILE", help="joint angles as CSV: time_s, <joint>_deg ...")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Retarget, print and write; 0 if every foot was reached, else 1."""
    from exo_pin.retarget import retarget

    body = options.body_from(args)
    result = retarget(options.gait_from(args, body), args.robot, body)
    if args.json:
        show.as_json(result.facts())
    else:
        _print(result, Path(args.gait).name)
    if args.output:
        write_text(args.output, _csv(result))
    return 1 if result.facts()["samples_missed"] else 0


def _print(result: Retargeted, name: str) -> None:
    facts = result.facts()
    position, rotation = facts["position_error_mm"], facts["rotation_error_deg"]
    rows = [
        ["legs, times the body's", f"{result.scale[0]:.3f}, {result.scale[1]:.3f}"],
        ["samples", str(facts["samples"])],
        ["samples with a foot missed", str(facts["samples_missed"])],
        ["ankle's distance, rms and max", f"{position['rms']:.3f}, {position['max']:.3f} mm"],
        ["foot's angle, rms and max", f"{rotation['rms']:.4f}, {rotation['max']:.4f} deg"],
    ]
    show.table(f"{name} on {result.target.name}", ["foot by foot", ""], rows)
    lines = [
        [joint, f"{show.fixed(x['min_deg'])} .. {show.fixed(x['max_deg'])}", str(x["samples_outside"] or "-")]
        for joint, x in facts["joint_by_joint"].items()
    ]
    show.table("Joint by joint", ["joint", "asked deg", "samples outside its limits"], lines)
    if result.target.remarks:
        print(result.target.remarks)


def _csv(result: Retargeted) -> str:
    from numpy import column_stack, degrees

    columns = [result.robot.column(joint) for joint in result.legs]
    head = ",".join(["time_s", *(f"{joint}_deg" for joint in result.legs)])
    rows = column_stack([result.time, degrees(result.q[:, columns])])
    return "\n".join([head, *(",".join(f"{x:.9g}" for x in row) for row in rows)]) + "\n"

"""`exo-pin ik`: joint angles from a table of foot poses."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from exo_pin.cli import options, show

if TYPE_CHECKING:
    from exo_pin.ik import Track

_EXAMPLES = """examples:
  exo-pin fk free -o poses.csv && exo-pin ik poses.csv -o angles.csv
  exo-pin ik poses.csv -o angles.mot --stature 1.82

columns of the table: see `exo-pin fk --help`; without pelvis columns the pelvis stands still.
exit code 1: some frames could not be reached; the file then holds the nearest posture within the limits"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("poses", metavar="POSES", help="table of foot poses (.csv)")
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="gait file to write")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Solve, write, and tell what was not reached."""
    from exo_pin import ik
    from exo_pin.formats import load_poses, save_gait
    from exo_pin.gait import Gait
    from exo_pin.robot import load_robot

    table = load_poses(args.poses)
    for remark in table.remarks:
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    robot = load_robot(options.body_from(args))
    track = ik.track(robot, table.targets, base=table.base)
    gait = Gait(
        table.time,
        robot.angles(track.q),
        base=table.base,
        events=table.events,
        periodic=table.periodic,
        source=f"inverse kinematics of {args.poses}" + (f"; {table.source}" if table.source else ""),
    )
    save_gait(gait, args.output)
    _print(track, args.output)
    return 0 if track.converged.all() else 1


def _print(track: Track, output: str) -> None:
    missed = (~track.converged).nonzero()[0]
    rows = [
        ["frames", str(len(track.q))],
        ["reached", str(int(track.converged.sum()))],
        ["largest position error", f"{track.position_error.max():.1e} m"],
        ["largest rotation error", f"{track.rotation_error.max():.1e} rad"],
    ]
    show.table(output, ["inverse kinematics", ""], rows)
    if len(missed):
        more = f" and {len(missed) - 5} more" if len(missed) > 5 else ""
        print(f"out of reach or outside the limits: frames {', '.join(map(str, missed[:5]))}{more}")
    if len(missed) == len(track.q):
        print("no frame at all was reached: were the poses made for another body (--body, --stature)?")

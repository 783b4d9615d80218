"""`exo-pin fk`: a gait's foot poses in the world, as CSV."""

from __future__ import annotations

import argparse
from pathlib import Path

from exo_pin.cli import options, show
from exo_pin.errors import DescriptionError

_EXAMPLES = """examples:
  exo-pin fk walk.mot -o poses.csv
  exo-pin fk free --stature 1.6 -o poses.csv
  exo-pin ik poses.csv -o angles.csv         and back

columns: time_s, pelvis_{x,y,z}_m, pelvis_{qw,qx,qy,qz}, then left_foot_... and right_foot_... alike, all in
the world: x forward, y left, z up, origin on the ground"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument("-o", "--output", metavar="FILE", required=True, help="the table to write (.csv)")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Compute and write."""
    import numpy as np

    from exo_pin.anatomy import FEET
    from exo_pin.formats import Poses, save_poses
    from exo_pin.kinematics import poses
    from exo_pin.robot import load_robot

    if Path(args.output).suffix.lower() != ".csv":
        raise DescriptionError(f"{args.output}: a table of poses ends in .csv")
    body = options.body_from(args)
    robot, gait = load_robot(body), options.gait_from(args, body)
    n = len(gait.time)
    base = robot.pelvis_poses(gait)
    q = robot.from_gait(gait)
    parts = [poses(robot, q[part], FEET, base=base[part]) for part in show.blocks(n, "forward kinematics")]
    feet = np.concatenate(parts)
    targets = {foot: feet[:, k] for k, foot in enumerate(FEET)}
    table = Poses(gait.time, base, targets, events=gait.events, periodic=gait.periodic, source=gait.source)
    save_poses(table, args.output)
    print(f"{args.output}: {n} poses of {', '.join(FEET)}")
    return 0

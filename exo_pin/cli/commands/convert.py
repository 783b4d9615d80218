"""`exo-pin convert`: a gait from one file format to another."""

from __future__ import annotations

import argparse

from exo_pin.cli import options

_EXAMPLES = """examples:
  exo-pin convert walk.mot walk.csv
  exo-pin convert walk.mot walk.csv --model subject.osim    its axes, signs and hips
  exo-pin convert walk.csv walk.mot          the knee is written positive, and the header says so
  exo-pin convert walk.csv walk.mot --as opensim-gait2392   ... negative, for models of that family
  exo-pin convert free normal.csv            a normal walk as a file
  exo-pin convert walk.trc walk.npz          markers by inverse kinematics on a body scaled to them
  exo-pin convert walk.csv walk.c3d --rate 100    C3D files need even samples
  exo-pin convert walk.mot sub-01_task-walk_tracksys-imu_motion.tsv    Motion-BIDS
  exo-pin convert free walk.yaml             a ROS JointTrajectory for a controller
  exo-pin convert lab.csv walk.csv --units deg --map t=time --map KneeL=left_knee_flexion ..."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser, default=None)
    parser.add_argument(
        "output",
        metavar="OUT",
        help="the new file; its ending (.csv .tsv .mot .sto .npz .yaml .json .c3d _motion.tsv) is the format",
    )
    parser.add_argument(
        "--rate", type=float, metavar="HZ", help="sample the walk anew, at whole multiples of 1 / HZ"
    )
    parser.add_argument(
        "--as",
        dest="written",
        choices=("opensim-gait2392", "opensim-rajagopal"),
        help="of a .mot or .sto: the family of the model it is for (default: opensim-rajagopal)",
    )
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Read and write."""
    from exo_pin.formats import save_gait

    gait = options.gait_from(args, options.body_from(args))
    if args.rate is not None:
        gait = gait.sampled(args.rate)
    save_gait(gait, args.output, preset=args.written)
    print(f"{args.output}: {len(gait.time)} samples, {gait.duration:.3f} s")
    return 0

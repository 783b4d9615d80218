"""`exo-pin export`: the exoskeleton with its walk as a model of MuJoCo, OpenSim or ROS 2."""

from __future__ import annotations

import argparse
from typing import Any

from exo_pin.cli import options
from exo_pin.errors import DescriptionError

_EXAMPLES = """examples:
  exo-pin export mjcf -o exo.xml                 a MuJoCo scene: motors, contacts, sensors, keyframes
  exo-pin export mjcf --servo --support -o exo.xml    held by servos and a soft support: stands in the viewer
  exo-pin export osim -o exo.osim                an OpenSim model on which a .mot of `exo-pin convert` plays
  exo-pin export ros2 -o exo_description/        a ROS 2 package with ros2_control and the walk
  exo-pin export mjcf slow --device lokomat --stature 1.82 -o lokomat.xml
  exo-pin export osim --as opensim-gait2392 -o exo.osim    the knee negative in flexion, as in those models

Masses, inertias, joints and limits are the URDF's. docs/exports.md says what each file holds."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("tool", metavar="TOOL", help="mjcf (MuJoCo), osim (OpenSim) or ros2")
    options.add_gait(parser)
    parser.add_argument(
        "--device", default="exo12", metavar="DEVICE", help="name or device file (default: exo12)"
    )
    options.add_hip_order(parser)
    parser.add_argument("-o", "--output", metavar="OUT", required=True, help="the file; of ros2 a new folder")
    parser.add_argument(
        "--servo", action="store_true", help="mjcf: controls are angles held by servos, not torques"
    )
    parser.add_argument(
        "--support", action="store_true", help="mjcf: a mocap body holds the pelvis by a soft weld"
    )
    parser.add_argument(
        "--as",
        dest="family",
        choices=("opensim-gait2392", "opensim-rajagopal"),
        help="osim: the family whose signs it has (default: opensim-rajagopal, as of a .mot)",
    )
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Make the model and write it."""
    from exo_pin.errors import known_name
    from exo_pin.export import EXPORTS, export
    from exo_pin.robot import load_robot

    tool = known_name("tool", args.tool, EXPORTS)
    given = _given(args, tool, EXPORTS[tool].options)
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    robot = load_robot(body, device=args.device, hip_order=args.hip_order)
    export(tool, robot, gait, args.output, **given)
    print(f"{args.output}: {EXPORTS[tool].what}, {robot.name}")
    if tool == "osim" and robot.hip_order != "clinical":
        print(f"note: its hips turn in the order {robot.hip_order}; a .mot has the clinical order's angles")
    return 0


def _given(args: argparse.Namespace, tool: str, known: tuple[str, ...]) -> dict[str, Any]:
    """The options of the command line that were given, by the names that `export` knows.

    Raises:
        DescriptionError: One does not belong to the tool.
    """
    asked = {
        "actuators": ("--servo", "servo" if args.servo else None),
        "support": ("--support", args.support or None),
        "preset": ("--as", args.family),
    }
    for name, (option, value) in asked.items():
        if value is not None and name not in known:
            raise DescriptionError(f"{option} is not an option of {tool}")
    return {name: value for name, (_, value) in asked.items() if value is not None}

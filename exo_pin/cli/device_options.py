"""A device on the command line: who wears which, who moves the pelvis, what its knees do; and its answer."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.anatomy.names import PelvisMotion
    from exo_pin.feasible import DeviceWalk
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot


def add(parser: argparse.ArgumentParser, what: str = "name or device file (default: exo12)") -> None:
    """`--device`, `--pelvis` and `--knee`.

    Args:
        parser: Of the command.
        what: Help of `--device`.
    """
    add_device(parser, what)
    add_knee(parser)


def add_device(parser: argparse.ArgumentParser, what: str = "name or device file (default: exo12)") -> None:
    """`--device` and `--pelvis`; arguments as of `add`."""
    parser.add_argument("--device", default="exo12", metavar="DEVICE", help=what)
    parser.add_argument(
        "--pelvis",
        choices=("recorded", "device"),
        help="who moves the pelvis: the recorded walk, or the device as it can (default: a device whose "
        "stand has slides does, any other goes with the walk)",
    )


def add_knee(parser: argparse._ActionsContainer) -> None:
    """`--knee`."""
    parser.add_argument(
        "--knee",
        choices=("stop", "bend"),
        default="stop",
        help="a recorded knee beyond its stop is held there and the foot moves (default), or it bends and "
        "the foot stays",
    )


def answer(args: argparse.Namespace, body: Body, gait: Gait, **more: Any) -> DeviceWalk:
    """The device's answer to a walk.

    Args:
        args: The command line, with the arguments of `add`.
        body: Who wears the device.
        gait: The walk.
        more: Further arguments of `exo_pin.feasible.device_walk`.
    """
    from exo_pin.feasible import device_walk

    return device_walk(gait, args.device, body, pelvis=args.pelvis, knee=args.knee, **more)


def motion(args: argparse.Namespace, body: Body, gait: Gait) -> tuple[Robot, Gait]:
    """The device's robot, and its motion: its joints copy the walk, and those that it locks stay at zero.

    Args:
        args: The command line, with the arguments of `add_device`.
        body: Who wears the device.
        gait: The walk.
    """
    from exo_pin import devices
    from exo_pin.compare import Conditions, projected, robot_for, walk
    from exo_pin.feasible import pelvis_by_default
    from exo_pin.robot import load_robot

    device = devices.find(args.device)
    pelvis = args.pelvis or pelvis_by_default(device)
    robot = load_robot(body, device=device.carried())  # the walk itself has the place of the pelvis
    if not changes_motion(args):
        return robot, gait
    conditions = Conditions(pelvis)
    copy = projected(walk(gait, body), robot_for(device, body, conditions), conditions).gait
    print(f"note: {_copied(device.title or device.name, pelvis)}", file=sys.stderr)
    return robot, copy


def changes_motion(args: argparse.Namespace) -> bool:
    """Whether the device cannot copy a walk whole: it locks joints, or holds the pelvis.

    Args:
        args: The command line, with the arguments of `add_device`.
    """
    from exo_pin import devices
    from exo_pin.feasible import pelvis_by_default

    device = devices.find(args.device)
    return bool(device.locked) or (args.pelvis or pelvis_by_default(device)) == "device"


def _copied(device: str, pelvis: PelvisMotion) -> str:
    held = "; it holds the pelvis" if pelvis == "device" else ""
    return f"the joints of {device} copy the walk, those that it locks stay at zero{held}"


def print_answer(found: DeviceWalk, before: str = "") -> None:
    """Loss and verdict in sentences, and a warning where its treadmill cannot run so.

    Args:
        found: The device's answer.
        before: What stands before the verdict.
    """
    print(f"{found.loss_sentence}\n{before}{found.sentence}")
    if found.belt_warning:
        print(found.belt_warning)

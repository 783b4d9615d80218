"""The walk that replay, picture and film show: a gait, recovered by inverse kinematics, as a scene."""

from __future__ import annotations

import argparse
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, show, torque_options
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.crosscheck import Recovery
    from exo_pin.gait import Gait
    from exo_pin.robot import Robot
    from exo_pin.viewer import Scene


def add(parser: argparse.ArgumentParser) -> None:
    """Gait, body and playback speed."""
    options.add_gait(parser)
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="F", help="playback speed 0.1 .. 2 (default: 1)"
    )
    parser.add_argument(
        "--compare", metavar="GAIT", help="a second walk: a ghost beside the first, its curves dotted"
    )
    torque_options.add(parser)
    parser.add_argument(
        "--support",
        choices=("carried", "still"),
        default="carried",
        help="carried: the pelvis follows so that the standing foot stays on the belt (default); still: held",
    )
    parser.add_argument(
        "--device",
        default="exo12",
        metavar="DEVICE",
        help="name or device file: another one walks as near to the feet as it can (see `exo-pin devices`)",
    )
    parser.add_argument(
        "--robot",
        metavar="ROBOT",
        help="another robot walks instead: a name, .urdf or .toml file (see `exo-pin retarget --help`)",
    )
    options.add_body(parser)
    options.add_hip_order(parser)


def read(args: argparse.Namespace) -> tuple[Body, Gait]:
    """Body and gait that the arguments name.

    Raises:
        DescriptionError: The speed is out of range, or a measure is implausible.
    """
    if not 0.1 <= args.speed <= 2:
        raise DescriptionError(f"--speed is {args.speed:g}; 0.1 .. 2 is accepted")
    body = options.body_from(args)
    return body, options.gait_from(args, body)


def scene(args: argparse.Namespace, body: Body, gait: Gait) -> Scene:
    """Solve, print the residuals, and compile the scene."""
    from exo_pin import viewer
    from exo_pin.robot import load_robot

    if args.robot is not None:
        return _of_robot(args, body, gait)
    curves = torque_options.given(args)
    robot = load_robot(body, hip_order=args.hip_order)
    gait, note = options.with_events(robot, gait)
    name = Path(args.gait).name
    notes = [line for line in (gait.source, note) if line]
    title = name
    if args.device == "exo12":
        shown, beyond = _recovered(robot, gait, name)
        notes += beyond
    else:
        robot, shown, said = _on_device(args, body, gait)
        notes.append(said)
        title = f"{name} on {said.partition(' (')[0]}"
    second = (
        None if args.compare is None else options.load(args.compare, body, args.files, preset=args.preset)
    )
    return viewer.scene(
        robot,
        shown,
        reference=gait,
        compare=second,
        compare_title=Path(args.compare or "").name,
        torques=curves,
        title=f"{title} - exo_pin",
        support=args.support,
        notes=notes,
        speed=args.speed,
    )


def _of_robot(args: argparse.Namespace, body: Body, gait: Gait) -> Scene:
    """The walk on another robot, and what it misses."""
    from exo_pin import retarget, viewer
    from exo_pin.robot import load_robot

    for option, other in (("device", "exo12"), ("hip_order", "clinical"), ("torques", None)):
        if getattr(args, option) != other:
            name = option.replace("_", "-")
            raise DescriptionError(f"--{name} is for the exoskeleton; leave it away with --robot")
    gait, note = options.with_events(load_robot(body), gait)
    walk = retarget.retarget(gait, args.robot, body)
    title = walk.target.title or walk.target.name
    position = 1e3 * walk.errors.largest_position
    rotation = degrees(walk.errors.largest_rotation)
    print(
        f"{title}: the feet's paths {sum(walk.scale) / 2:.2f} times the person's, missed by "
        f"{position:.2f} mm and {rotation:.1f} deg at most "
        f"({walk.samples_missed} of {len(gait)} samples missed)"
    )
    return viewer.retargeted(
        walk,
        compare=None
        if args.compare is None
        else options.load(args.compare, body, args.files, preset=args.preset),
        compare_title=Path(args.compare or "").name,
        title=f"{Path(args.gait).name} on {title} - exo_pin",
        support=args.support,
        notes=[line for line in (gait.source, note) if line],
        speed=args.speed,
    )


def _recovered(robot: Robot, gait: Gait, name: str) -> tuple[Gait, list[str]]:
    """The walk that inverse kinematics makes of the gait's feet, and what the gait asks beyond the limits."""
    from exo_pin import crosscheck

    recovery = crosscheck.recover(robot, gait)
    _print(recovery, name)
    beyond = _beyond(robot, gait)
    for line in beyond:
        print(line)
    return recovery.gait, beyond


def _on_device(args: argparse.Namespace, body: Body, gait: Gait) -> tuple[Robot, Gait, str]:
    """The device's best motion towards the gait's feet, on a robot of its looks, and what it misses."""
    from exo_pin import devices
    from exo_pin.compare import compare, dressed

    if args.hip_order != "clinical":
        raise DescriptionError("--hip-order is for exo12; other devices are shown with clinical hips")
    device = devices.find(args.device)
    loss = compare(gait, [device], body).best[0]
    rms, most = 1e3 * loss.rms, 1e3 * float(loss.sole_error.max())
    said = (
        f"{device.title or device.name} ({device.motors} motors), the pelvis moving as recorded: the soles "
        f"miss the recorded ones by {rms:.1f} mm rms, {most:.1f} mm at most."
    )
    print(said)
    return dressed(loss.motion.robot), loss.motion.gait, said


def _print(recovery: Recovery, name: str) -> None:
    """The solver's residuals."""
    track, within = recovery.track, recovery.within
    rows = [
        ["frames", f"{len(track.q)}"],
        ["feet reached", f"{int(track.converged.sum())}"],
        ["largest position error", f"{track.position_error[within].max(initial=0.0):.1e} m"],
        ["largest rotation error", f"{track.rotation_error[within].max(initial=0.0):.1e} rad"],
    ]
    show.table(f"{name} on the exoskeleton", ["inverse kinematics", ""], rows)


def _beyond(robot: Robot, gait: Gait) -> list[str]:
    """What the gait asks beyond the joint limits, a sentence each."""
    from exo_pin.demand import range_demands

    lines = []
    for joint, demand in range_demands(robot, robot.from_gait(gait)).items():
        if demand.samples_outside:
            required = _degrees(demand.lowest, demand.highest)
            available = _degrees(*demand.available)
            lines.append(
                f"{joint}: {demand.samples_outside} frames outside its limits: "
                f"required {required}, available {available}"
            )
    return lines


def _degrees(low: float, high: float) -> str:
    return f"{show.fixed(degrees(low))} .. {show.fixed(degrees(high))} deg"

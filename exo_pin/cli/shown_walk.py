"""The walk that replay, picture, film and report show: read, recovered by inverse kinematics, as a scene."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, show, torque_options, walk_output
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.crosscheck import Recovery
    from exo_pin.gait import Gait, Plausibility
    from exo_pin.robot import Robot
    from exo_pin.viewer import Scene, SceneOptions


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
        help="another robot walks instead: a name or a file (see `exo-pin retarget --help`)",
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
    """Recover the walk by inverse kinematics, print the residuals, and make the scene.

    Args:
        args: The command line, with the arguments of `add`.
        body: As `read` returns it.
        gait: As `read` returns it.

    Raises:
        DescriptionError: Options contradict each other.
    """
    return _exoskeleton(args, body, gait) if args.robot is None else _other_robot(args, body, gait)


def _exoskeleton(args: argparse.Namespace, body: Body, gait: Gait) -> Scene:
    """The walk on the exoskeleton or another device, with the gait's own curves dashed."""
    from exo_pin import viewer
    from exo_pin.robot import load_robot

    torques = torque_options.given(args)
    robot = load_robot(body, hip_order=args.hip_order)
    gait, note = options.with_events(robot, gait)
    verdict = options.plausibility(args, robot, gait)
    walk_output.print_plausibility(verdict)
    name = Path(args.gait).name
    found = _recovered(robot, gait, name) if args.device == "exo12" else _on_device(args, body, gait)
    chosen = _scene_options(
        args, body, name + found.title, [gait.source, note, *_judged(robot, gait, verdict), *found.notes]
    )
    return viewer.exoskeleton_scene(found.robot, found.gait, chosen, reference=gait, torques=torques)


def _other_robot(args: argparse.Namespace, body: Body, gait: Gait) -> Scene:
    """The walk retargeted to another robot, and what its feet miss."""
    from exo_pin import retarget, viewer
    from exo_pin.robot import load_robot

    used = {
        "--device": args.device != "exo12",
        "--hip-order": args.hip_order != "clinical",
        "--torques": args.torques is not None,
    }
    for option in (name for name, given in used.items() if given):
        raise DescriptionError(f"{option} is for the exoskeleton; leave it away with --robot")
    person = load_robot(body)
    gait, note = options.with_events(person, gait)
    verdict = options.plausibility(args, person, gait)
    walk_output.print_plausibility(verdict)
    walk = retarget.retarget(gait, args.robot, body)
    title = walk.target.title or walk.target.name
    position = 1e3 * walk.errors.largest_position
    rotation = degrees(walk.errors.largest_rotation)
    print(
        f"{title}: the feet's paths {sum(walk.scale) / 2:.2f} times the person's, missed by "
        f"{position:.2f} mm and {rotation:.1f} deg at most "
        f"({walk.samples_missed} of {len(gait)} samples missed)"
    )
    notes = [gait.source, note, *_judged(person, gait, verdict)]
    chosen = _scene_options(args, body, f"{Path(args.gait).name} on {title}", notes)
    made = viewer.robot_scene(walk, chosen)
    for found in walk.notes:
        print(f"note: {show.plain(found)}", file=sys.stderr)
    return made


def _judged(robot: Robot, gait: Gait, verdict: Plausibility) -> list[str]:
    """Whether it is a run, and the verdict on the walk as it was read, as notes of the page."""
    from exo_pin.kinematics import walk_numbers

    words = walk_output.manner_words(walk_numbers(robot, gait))
    run = [words[0].upper() + words[1:] + "."] if words else []
    return [*run, f"The walk is {verdict.word}{':' * bool(verdict.reasons)}", *verdict.reasons]


def _scene_options(args: argparse.Namespace, body: Body, title: str, notes: list[str]) -> SceneOptions:
    """What a scene shows besides its walk, by the command line; empty notes are left out."""
    from exo_pin import viewer

    return viewer.SceneOptions(
        title=f"{title} - exo_pin",
        support=args.support,
        compare=None
        if args.compare is None
        else options.load(args.compare, body, args.files, preset=args.preset),
        compare_title=Path(args.compare or "").name,
        notes=tuple(filter(None, notes)),
        speed=args.speed,
    )


@dataclass(frozen=True, eq=False)
class _Recovered:
    """A walk as inverse kinematics found it.

    Attributes:
        robot: The robot that walks.
        gait: Its walk.
        title: What the page's heading adds to the walk's name.
        notes: What the walk misses, in sentences.
    """

    robot: Robot
    gait: Gait
    title: str
    notes: list[str]


def _recovered(robot: Robot, gait: Gait, name: str) -> _Recovered:
    """The walk from the gait's feet on the exoskeleton, and where the gait goes beyond the joint limits."""
    from exo_pin import crosscheck

    recovery = crosscheck.recover(robot, gait)
    _print(recovery, name)
    beyond = _beyond(robot, gait)
    for line in beyond:
        print(line)
    return _Recovered(robot, recovery.gait, "", beyond)


def _on_device(args: argparse.Namespace, body: Body, gait: Gait) -> _Recovered:
    """The device's best motion towards the gait's feet, on a robot with its appearance."""
    from exo_pin import devices
    from exo_pin.compare import compare, dressed

    if args.hip_order != "clinical":
        raise DescriptionError("--hip-order is for exo12; other devices are shown with clinical hips")
    device = devices.find(args.device)
    loss = compare(gait, [device], body).best[0]
    rms, most = 1e3 * loss.rms, 1e3 * float(loss.sole_error.max())
    title = device.title or device.name
    note = (
        f"{title} ({device.motors} motors), the pelvis moving as recorded: the soles "
        f"miss the recorded ones by {rms:.1f} mm rms, {most:.1f} mm at most."
    )
    print(note)
    return _Recovered(dressed(loss.motion.robot), loss.motion.gait, f" on {title.partition(' (')[0]}", [note])


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
    """Where the gait goes beyond the joint limits, a sentence each."""
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

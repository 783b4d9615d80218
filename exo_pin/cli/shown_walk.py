"""The walk that replay, picture, film and report show: read, recovered by inverse kinematics, as a scene."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from exo_pin.cli import device_options, missing, options, show, torque_options, walk_output
from exo_pin.cli.answered_walk import AnsweredWalk, answered
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.anatomy import Body
    from exo_pin.crosscheck import Recovery
    from exo_pin.feasible import DeviceWalk
    from exo_pin.gait import Gait, Plausibility
    from exo_pin.robot import Robot
    from exo_pin.viewer import Kinetics, Scene, SceneOptions


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
    device_options.add(
        parser, "name or device file: another one walks as near to the feet as it can (see `exo-pin devices`)"
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
    """Recover the walk by inverse kinematics, print residuals and verdicts, and make the scene.

    Args:
        args: The command line, with the arguments of `add`.
        body: As `read` returns it.
        gait: As `read` returns it.

    Raises:
        DescriptionError: Options contradict each other.
    """
    if args.robot is not None:
        return _other_robot(args, body, gait)
    walk = answered(args, body, gait)
    made, answer = exoskeleton_scene(args, body, walk), walk.answer
    print(answer.sentence if walk.keeps_motion else f"{answer.loss_sentence}\n{answer.sentence}")
    if _runs_off(answer, made):
        print(answer.belt_warning)
    return made


def exoskeleton_scene(args: argparse.Namespace, body: Body, walk: AnsweredWalk) -> Scene:
    """The walk on the exoskeleton or another device, with the gait's own curves dashed.

    It prints the verdict on the walk and the solver's residuals; the device's answer is left to the command.

    Args:
        args: The command line, with the arguments of `add`, without `--robot`.
        body: Who walks.
        walk: As `answered` returns it.

    Raises:
        DescriptionError: Options contradict each other.
    """
    from exo_pin import viewer

    if body.wearer:
        missing.note_without_figure()
    gait, answer, verdict = walk.gait, walk.answer, walk.plausibility
    walk_output.print_plausibility(verdict)
    name = Path(args.gait).name
    found = _recovered(walk.robot, answer, name) if walk.keeps_motion else _on_device(args, answer)
    notes = [gait.source, walk.events_note, *_judged(walk.robot, gait, verdict), *found.notes]
    chosen = _scene_options(args, body, name + found.title, notes)
    if answer.conditions.pelvis == "device" and answer.device.pelvis != "free":
        chosen = dataclasses.replace(chosen, support="still")  # only the record's slides move the pelvis
    same = np.array_equal(gait.time, answer.gait.time)
    kinetics = _kinetics(args, body, walk) if same else None
    made = viewer.exoskeleton_scene(
        found.robot,
        found.gait,
        chosen,
        reference=gait if same else answer.gait,
        torques=None if walk.dynamics is not None and kinetics is not None else walk.shown_torques,
        kinetics=kinetics,
    )
    if not _runs_off(answer, made):
        return made
    facts = dataclasses.replace(made.facts, notes=(answer.belt_warning, *made.facts.notes))
    return dataclasses.replace(made, facts=facts)


def _kinetics(args: argparse.Namespace, body: Body, walk: AnsweredWalk) -> Kinetics | None:
    """Forces and torques of the walk: those that are asked for, else those on its force plates."""
    from exo_pin.viewer import Kinetics

    found = walk.dynamics
    if found is None and args.torques is None:
        found = torque_options.on_plates(args, body, walk.gait)
    return None if found is None else Kinetics.of_dynamics(found)


def _runs_off(answer: DeviceWalk, made: Scene) -> bool:
    """Whether the scene's belt runs faster or slower than the device's."""
    return made.facts.marks.belt is not None and bool(answer.belt_warning)


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
    judged = options.judged(args, person, gait)
    gait, note, verdict = judged.gait, judged.events_note, judged.verdict
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


def _recovered(robot: Robot, answer: DeviceWalk, name: str) -> _Recovered:
    """The walk from its feet on the exoskeleton."""
    from exo_pin import crosscheck

    recovery = crosscheck.recover(robot, answer.recorded if answer.verdict == "no" else answer.gait)
    _print(recovery, name)
    return _Recovered(robot, recovery.gait, "", [f"{answer.sentence}."])


def _on_device(args: argparse.Namespace, answer: DeviceWalk) -> _Recovered:
    """The device's best motion towards the feet, on a robot with its appearance."""
    from exo_pin.compare import dressed

    if args.hip_order != "clinical":
        raise DescriptionError("--hip-order is for exo12; other devices are shown with clinical hips")
    motion = answer.loss.motion
    title = f" on {answer.title.partition(' (')[0]}"
    notes = [f"{answer.sentence}.", answer.loss_sentence]
    return _Recovered(dressed(motion.robot), motion.gait, title, notes)


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

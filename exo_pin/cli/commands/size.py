"""`exo-pin size`: the loads of a device's joints on a walk, and which motor and gear can bear them."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exo_pin.cli import device_options, options, own_torques, show
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text
from exo_pin.gait import SPEEDS

if TYPE_CHECKING:
    from exo_pin.sizing import GearedUse, JointSizing, Motor, Ratios, Sizing, WorstCase

_EXAMPLES = """examples:
  exo-pin size                                   the normal walk against the limits of exo12
  exo-pin size walk.mot --forces grf.mot --device lokomat
  exo-pin size fast --motor motor.toml           which gear ratios fit, and the best one
  exo-pin size --motor maxon-ec-90-flat-48v --gear 50:1 --bws 0.3 --json
  exo-pin size -o planes.svg                     the points of torque and speed below their limits
  exo-pin size --worst -o worst.svg              the worst of 4 bodies, 5 speeds, 3 supports (20 s)

Each motor bears the whole torque of its joint: no person helps. Without force plates the ground reaction is
predicted, an assumption. Without --motor the limit is the record's rectangle of effort and velocity.
A motor fits where every point of torque and speed lies below its straight speed-torque line, its rotor's
inertia included, and its rms torque is within its continuous torque; the best ratio has the smallest rms.
exit code 0: every joint fits; 1: one does not"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    device_options.add_device(parser)
    parser.add_argument("--motor", metavar="MOTOR", help="motor file (.toml) or the name of an example")
    parser.add_argument(
        "--gear", metavar="N:1", help="gear ratio of the motor; left out: those that fit are looked for"
    )
    parser.add_argument(
        "--bws",
        type=float,
        default=0.0,
        metavar="PART",
        help="body-weight support as a part of the weight, 0 to 1 (default: 0)",
    )
    parser.add_argument(
        "--worst", action="store_true", help="the worst over bodies, normal speeds and body-weight supports"
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE.svg",
        help="write a figure: the walk's points on the torque-speed planes; with --worst a map",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Size and print; 0 if every joint fits, else 1."""
    from exo_pin.sizing import find_motor

    if args.gear is not None and args.motor is None:
        raise DescriptionError("--gear is the ratio of a motor; name one with --motor")
    if args.output is not None and Path(args.output).suffix.lower() != ".svg":
        raise DescriptionError(f"{args.output}: a figure is written as .svg")
    ratio = None if args.gear is None else _ratio(args.gear)
    motor = None if args.motor is None else find_motor(args.motor)
    return _run_worst(args, motor, ratio) if args.worst else _run_walk(args, motor, ratio)


def _ratio(text: str) -> float:
    """`50:1` or `50` as a number."""
    turns, _, one = text.partition(":")
    try:
        ratio = float(turns.strip()) / float(one.strip() or 1)
    except (ValueError, ZeroDivisionError):
        ratio = math.nan
    if not 0.0 < ratio < math.inf:
        raise DescriptionError(f"--gear {text!r} is no ratio; a positive one like 50:1 is accepted")
    return ratio


def _run_walk(args: argparse.Namespace, motor: Motor | None, ratio: float | None) -> int:
    from exo_pin import sizing
    from exo_pin.report.draw.torque_speed import torque_speed_svg

    if not 0.0 <= args.bws <= 1.0:
        raise DescriptionError(f"--bws is {args.bws:g}; a part of the weight, 0 to 1, is accepted")
    body = options.body_from(args)
    walk = options.gait_from(args, body)
    robot, walk = device_options.motion(args, body, walk)
    walk, _ = options.with_events(robot, walk)
    changed = device_options.changes_motion(args)
    known = own_torques.inverse_dynamics(args, robot, walk, changed=changed, body_weight_support=args.bws)
    found = sizing.size(known, stride=sizing.stride_time(robot, walk), motor=motor, ratio=ratio)
    for remark in found.remarks[len(known.remarks) :]:
        print(f"note: {show.plain(remark)}", file=sys.stderr)
    title = f"{Path(args.gait).name} on {robot.name}"
    if args.output:
        write_text(args.output, torque_speed_svg(found, title))
    if args.json:
        support = {"newtons": known.support_force, "part": args.bws}
        show.as_json(found.facts() | {"body_weight_support": support, "mass_kg": known.mass})
    else:
        _print(found, f"{title}, ground reaction {found.reaction}")
    return 0 if found.fits else 1


def _print(found: Sizing, title: str) -> None:
    """The loads, what a spring saves, the motor, the verdict."""
    head = ["joint", "peak N m", "rms N m", "peak rad/s", "peak W", "J a stride", "J recovered"]
    limits = ["torque %", "speed %", ""] if found.motor is None else []
    show.table(title, [*head, *limits], [_row(joint, found.motor is None) for joint in found.joints])
    if found.motor is not None:
        _print_motor(found)
    springs = [_spring_row(joint) for joint in found.joints if joint.spring is not None]
    if springs:
        heads = ["joint", "N m/rad", "rest deg", "rms N m", "rms saved %", "J a stride"]
        show.table(
            "The best spring beside each motor (of the joint's torque, rotor left out)", heads, springs
        )
    for name in found.passive:
        print(f"{name} is passive: no motor bears its torque")
    wrong = [joint.load.joint for joint in found.joints if not joint.fits]
    print(f"torques: {show.plain(found.source)}\nlimit: {show.plain(found.limit)}")
    print(f"verdict: {'every joint fits' if not wrong else 'does not fit: ' + ', '.join(wrong)}")


def _row(joint: JointSizing, rectangle: bool) -> list[str]:
    load = joint.load
    cells = [
        load.joint,
        *map(show.fixed, (load.peak_torque, load.rms_torque, load.peak_speed, load.peak_power)),
    ]
    cells += [_energy(load.energy()), _energy(load.energy(recovery=True))]
    if not rectangle:
        return cells
    return [*cells, f"{100 * joint.torque_use:.0f}", f"{100 * joint.speed_use:.0f}", _word(joint.fits)]


def _print_motor(found: Sizing) -> None:
    head = ["joint", "ratio", "line %", "rms %", "N²J kg m²", "J a stride, electrical", "ratios that fit", ""]
    rows = [_motor_row(joint) for joint in found.joints]
    show.table(f"{show.plain(found.limit)}; ratio given, else best or nearest", head, rows)


def _motor_row(joint: JointSizing) -> list[str]:
    assert joint.ratios is not None
    assert joint.motor is not None
    use = joint.use or joint.ratios.best
    spent = joint.load.energy(efficiency=joint.motor.efficiency)
    return [joint.load.joint, *_use(use), _energy(spent), _ranges(joint.ratios), _word(joint.fits)]


def _use(use: GearedUse) -> list[str]:
    shares = [f"{100 * share:.0f}" for share in (use.line, use.thermal)]
    return [f"{use.ratio:.1f}", *shares, f"{use.inertia:.3f}"]


def _ranges(ratios: Ratios) -> str:
    return ", ".join(f"{low:.1f} .. {high:.1f}" for low, high in ratios.ranges) or "none"


def _spring_row(joint: JointSizing) -> list[str]:
    assert joint.spring is not None
    left = joint.load.beside(joint.spring)
    saved = 100 * (1 - left.rms_torque / joint.load.rms_torque)
    rest = math.degrees(joint.spring.rest)
    numbers = map(show.fixed, (joint.spring.stiffness, rest, left.rms_torque, saved))
    return [joint.load.joint, *numbers, _energy(left.energy())]


def _energy(joules: float) -> str:
    return "-" if math.isnan(joules) else show.fixed(joules)


def _word(fits: bool) -> str:
    return "ok" if fits else "NO"


def _run_worst(args: argparse.Namespace, motor: Motor | None, ratio: float | None) -> int:
    from exo_pin import sizing

    if args.gait not in SPEEDS or ratio is not None or args.bws:
        raise DescriptionError(
            "--worst takes the normal walks, all supports and all ratios; leave GAIT, --bws, --gear away"
        )
    people = show.progress(sizing.bodies(), "bodies")
    found = sizing.worst_cases(args.device, motor=motor, people=people)
    fits = all(worst.fits for worst in found)
    if args.output:
        from exo_pin.report.draw.worst_case_map import worst_case_map

        write_text(args.output, worst_case_map(found, args.device).svg)
    if args.json:
        limit = "rectangle of the device's record" if motor is None else motor.name
        facts: dict[str, Any] = {"fits": fits, "limit": limit, "ground_reaction": "predicted"}
        show.as_json(facts | {"joints": {worst.movement: worst.facts() for worst in found}})
    else:
        _print_worst(found, args.device, motor)
    return 0 if fits else 1


def _print_worst(found: tuple[WorstCase, ...], device: str, motor: Motor | None) -> None:
    head = ["joint", "peak N m", "rms N m", "peak rad/s", "peak W", "J a stride", "peak torque at"]
    head += ["cases in the rectangle" if motor is None else "ratios that fit all", ""]
    number = len(found[0].loads)
    title = f"{device}: worst of {number} normal walks, wearer and device, ground reaction predicted"
    show.table(title, head, [_worst_row(worst) for worst in found])
    if motor is None:
        print("limit: rectangle of the device's record (effort, velocity), no speed-torque line")
    else:
        print(f"limit: {show.plain(f'{motor.name} ({motor.source})')}")


def _worst_row(worst: WorstCase) -> list[str]:
    from exo_pin.sizing import QUANTITIES

    values = [show.fixed(worst.worst(name)[0]) for name in QUANTITIES.values()]
    within = f"{worst.fitting} of {len(worst.loads)}" if worst.ratios is None else _ranges(worst.ratios)
    return [worst.movement, *values, str(worst.worst("peak_torque")[1]), within, _word(worst.fits)]

"""`exo-pin feasible`: can this device do this walk with this person?"""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from exo_pin.cli import device_options, options, show, torque_options

if TYPE_CHECKING:
    from collections.abc import Sequence

    from exo_pin.demand import JointDemand
    from exo_pin.feasible import DeviceWalk, Feasibility

_EXAMPLES = """examples:
  exo-pin feasible                               the normal walk on the 12-joint exoskeleton
  exo-pin feasible walk.mot --device lokomat --stature 1.82 --mass 80
  exo-pin feasible very_fast --gap 10 --json
  exo-pin feasible walk.mot --torques id.sto     its torques as well, where they are known
  exo-pin feasible walk.mot --forces grf.mot --torques own     its own torques, by inverse dynamics

Ranges, speeds and accelerations of revolute and prismatic joints, self-collision and reach; torques if they
are given. The motion of joints that the device locks, and of the pelvis where the device blocks it, is listed
and does not count: what the soles miss by it stands beside the verdict. exit code 0: the device fits, or fits
with a concession (knee held at its stop, a slower or a smaller walk); 1: it does not fit"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    device_options.add(parser)
    parser.add_argument(
        "--acceleration",
        type=float,
        metavar="A",
        help="largest joint acceleration [rad/s^2] (default: the record's, else 200)",
    )
    parser.add_argument(
        "--gap", type=float, default=0.0, metavar="MM", help="distance that parts must keep [mm] (default: 0)"
    )
    torque_options.add(parser, "judged against the actuators")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Assess and print; 0 if the device can do the walk, else 1."""
    from exo_pin.errors import DescriptionError

    acceleration = args.acceleration
    if not (acceleration is None or 0.0 < acceleration < math.inf) or not math.isfinite(args.gap):
        raise DescriptionError("--acceleration must be positive, --gap a number")
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    known, gap = torque_options.given(args, body, gait), args.gap / 1e3
    found = device_options.answer(args, body, gait, acceleration=acceleration, gap=gap, torques=known)
    source = None if known is None else known.source
    if args.json:
        whole = {"ok": found.ok, "largest_cadence_factor": found.largest_cadence, "torques": source}
        show.as_json(found.as_recorded.facts() | whole | found.facts())
    else:
        _print(found, args.gait)
        if source:
            print(f"torques: {show.plain(source)}")
    return 0 if found.ok else 1


def _print(found: DeviceWalk, name: str) -> None:
    verdict = found.as_recorded
    _print_demands(f"{name} on {verdict.robot.name}", "deg", [d for d in verdict.joints if not d.prismatic])
    _print_demands("Slides of the pelvis", "mm", [d for d in verdict.joints if d.prismatic])
    spare = ", ".join(f"{side} {show.fixed(1e3 * x)} mm" for side, x in verdict.reach.items())
    pair = " and ".join(verdict.closest_parts)
    print(f"nearest parts: {show.fixed(1e3 * verdict.clearance)} mm between {pair}")
    for fit in verdict.fits:
        print(f"{fit.what}: {fit.how}")
    print(f"reach to spare between hip and ankle: {spare}")
    dropped = _dropped(verdict)
    if dropped:
        print(f"required, but locked or held here, up to: {', '.join(dropped)}")
    if not found.concessions:  # else the verdict names what is possible
        print(f"possible: {_possible(found)}")
    for sentence in verdict.conditions:
        print(f"note: {sentence}")
    for failure in verdict.failures:
        print(f"NOT OK {verdict.words(failure)}")
    device_options.print_answer(found, "verdict: ")


_LEAST_DROPPED = 0.05
"""Smaller motion of locked joints is not printed [deg, mm]: it would round to zero."""


def _dropped(verdict: Feasibility) -> list[str]:
    """Motion of locked joints, and of the pelvis where the device blocks it: angles first."""
    from exo_pin.devices import SLIDES

    angles = {name: math.degrees(x) for name, x in verdict.dropped.items() if name not in SLIDES}
    places = {name: 1e3 * x for name, x in verdict.dropped.items() if name in SLIDES}
    return [
        f"{name} {show.fixed(x)} {unit}"
        for unit, motion in (("deg", angles), ("mm", places))
        for name, x in motion.items()
        if x >= _LEAST_DROPPED
    ]


def _print_demands(title: str, unit: str, demands: Sequence[JointDemand]) -> None:
    """A table of the demand on joints, without columns of which nothing is known."""
    columns = [
        "joint",
        f"required {unit}",
        f"range {unit}",
        f"margin {unit}",
        "speed %",
        "acc. %",
        "torque %",
    ]
    rows = [_row(demand) for demand in demands]
    kept = [k for k in range(len(columns)) if any(row[k] != "-" for row in rows)]
    if rows:
        verdicts = ["ok" if demand.ok else "NO" for demand in demands]
        lines = [[*(row[k] for k in kept), word] for row, word in zip(rows, verdicts, strict=True)]
        show.table(title, [*(columns[k] for k in kept), ""], lines)


def _possible(found: DeviceWalk) -> str:
    """Largest cadence and amplitude of the walk on the device."""
    if not found.as_recorded.person_fits:
        return "no walk of this person, whom the device does not take"
    return f"{_cadence(found)}; {_amplitude(found.as_recorded)}"


def _cadence(found: DeviceWalk) -> str:
    from exo_pin.feasible import LARGEST_CADENCE

    cadence, gait = found.largest_cadence, found.as_recorded.gait
    if cadence is None:
        return "at no cadence (what fails does not depend on it)"
    if cadence >= LARGEST_CADENCE:
        return f"at {LARGEST_CADENCE:g} times the cadence, and more was not tried"
    text = f"up to {math.floor(100 * cadence) / 100:.2f} times the cadence"
    if gait.periodic:
        steps = 120 / gait.duration
        text += f" ({steps:.0f} -> {math.floor(steps * cadence)} steps/min)"
    return text + _too_little(cadence)


def _amplitude(verdict: Feasibility) -> str:
    from exo_pin.feasible import LARGEST_AMPLITUDE

    if not verdict.amplitude_decides:
        return "at no amplitude that is known"
    if not verdict.amplitude:
        return "at no amplitude of the joints"
    if verdict.amplitude >= LARGEST_AMPLITUDE:
        return f"at {LARGEST_AMPLITUDE:g} times the movement of the joints, and more was not tried"
    text = f"up to {math.floor(100 * verdict.amplitude) / 100:.2f} times the movement of the joints"
    return text + _too_little(verdict.amplitude)


def _too_little(share: float) -> str:
    """Why a possible share of cadence or amplitude is no concession, after its number."""
    from exo_pin.feasible import LEAST_SHARE

    return f", less than the {LEAST_SHARE:g} that counts as a concession" if share < LEAST_SHARE else ""


def _row(demand: JointDemand) -> list[str]:
    scale = 1e3 if demand.prismatic else math.degrees(1.0)
    position, acceleration, torque = demand.position, demand.acceleration, demand.torque
    lower, upper = position.available
    return [
        demand.joint,
        f"{show.fixed(scale * position.lowest)} .. {show.fixed(scale * position.highest)}",
        f"{show.fixed(scale * lower, 0)}..{show.fixed(scale * upper, 0)}",
        show.fixed(scale * position.margin),
        show.fixed(100 * demand.speed.use, 0),
        "-" if math.isinf(acceleration.available) else show.fixed(100 * acceleration.use, 0),
        "-" if torque is None else show.fixed(100 * torque.use, 0),
    ]

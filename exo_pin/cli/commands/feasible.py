"""`exo-pin feasible`: can this device do this walk with this person?"""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING, Any

from exo_pin.cli import options, show, torque_options

if TYPE_CHECKING:
    from exo_pin.feasible import Feasibility, JointDemand

_EXAMPLES = """examples:
  exo-pin feasible                               the normal walk on the 12-joint exoskeleton
  exo-pin feasible walk.mot --device lokomat --stature 1.82 --mass 80
  exo-pin feasible very_fast --gap 10 --json
  exo-pin feasible walk.mot --torques id.sto     its torques as well, where they are known

Ranges, speeds and accelerations of joints and slides, self-collision and reach; torques if they are given.
Joints that the device locks are dropped and told, and so is what the pelvis does and the device does not let
it; exo-pin compare says what that costs. exit code 0: it can; 1: it cannot"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    parser.add_argument(
        "--device", default="exo12", metavar="DEVICE", help="name or device file (default: exo12)"
    )
    parser.add_argument(
        "--acceleration", type=float, metavar="A", help="largest joint acceleration [rad/s^2] (default: 200)"
    )
    parser.add_argument(
        "--gap", type=float, default=0.0, metavar="MM", help="distance that parts must keep [mm] (default: 0)"
    )
    torque_options.add(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Judge and print; 0 if it can be done, else 1."""
    from exo_pin.errors import DescriptionError
    from exo_pin.feasible import ACCELERATION, feasible

    acceleration = ACCELERATION if args.acceleration is None else args.acceleration
    if not (math.isfinite(acceleration) and acceleration > 0 and math.isfinite(args.gap)):
        raise DescriptionError("--acceleration must be positive, --gap a number")
    body = options.body_from(args)
    gait = options.gait_from(args, body)
    known, gap = torque_options.given(args), args.gap / 1e3
    verdict = feasible(gait, args.device, body, acceleration=acceleration, gap=gap, torques=known)
    if args.json:
        show.as_json(verdict.facts())
    else:
        _print(verdict, args.gait)
    return 0 if verdict.ok else 1


def _print(verdict: Feasibility, name: str) -> None:
    facts = verdict.facts()
    _print_demands(f"{name} on {verdict.robot.name}", "deg", [d for d in verdict.joints if not d.slide])
    _print_demands("Slides of the pelvis", "mm", [d for d in verdict.joints if d.slide])
    pair = " and ".join(facts["clearance_between"])
    spare = ", ".join(f"{side} {show.fixed(x)} mm" for side, x in facts["reach_to_spare_mm"].items())
    print(f"nearest parts: {show.fixed(facts['clearance_mm'])} mm between {pair}")
    for fit in facts["fits"]:
        asked = "not known" if fit["asked"] is None else f"{fit['asked']:.2f} {fit['unit']}"
        print(f"{fit['what']}: {asked}, {fit['low']:.2f} to {fit['high']:.2f} {fit['unit']} possible")
    print(f"reach to spare between hip and ankle: {spare}")
    told = [
        f"{name} {show.fixed(x)} {unit}"
        for unit in ("deg", "mm")
        for name, x in facts[f"dropped_{unit}"].items()
        if x >= _TOLD
    ]
    if told:
        print(f"asked, but locked or held here, up to: {', '.join(told)}")
    print(f"possible: {_cadence(verdict)}; {_amplitude(verdict)}")
    for sentence in facts["conditions"]:
        print(f"note: {sentence}")
    for failure in facts["failures"]:
        print(f"NOT OK {_failure(failure)}")
    print("verdict: " + ("the device can do this walk" if verdict.ok else "NO"))


_TOLD = 0.05
"""What is asked of locked joints is told from here on [deg, mm]: the last digit that is printed."""


def _print_demands(title: str, unit: str, demands: list[JointDemand]) -> None:
    """A table of what joints are asked; accelerations and torques only where they are known."""
    columns = ["joint", f"asked {unit}", f"range {unit}", f"margin {unit}", "speed %", "acc. %", "torque %"]
    rows = [_row(demand) for demand in demands]
    kept = [k for k in range(len(columns)) if any(row[k] != "-" for row in rows)]
    if rows:
        verdicts = ["ok" if demand.ok else "NO" for demand in demands]
        lines = [[*(row[k] for k in kept), word] for row, word in zip(rows, verdicts, strict=True)]
        show.table(title, [*(columns[k] for k in kept), ""], lines)


def _failure(failure: dict[str, Any]) -> str:
    if failure["what"] in ("treadmill", "person"):
        return f"{failure['what']}: {failure['how']}"
    frames = ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in failure["frames"])
    where = f"; {', '.join(failure['phases'])}" if failure["phases"] else ""
    return f"{failure['what']}: {failure['how']} in {failure['samples']} frames ({frames}{where})"


def _cadence(verdict: Feasibility) -> str:
    from exo_pin.feasible import FASTEST

    if not verdict.cadence_decides:
        return "at no cadence (what fails does not depend on it)"
    if verdict.cadence >= FASTEST:
        return f"at {FASTEST:g} times the cadence, and more was not tried"
    text = f"up to {math.floor(100 * verdict.cadence) / 100:.2f} times the cadence"
    if verdict.gait.periodic:
        steps = 120 / verdict.gait.duration
        text += f" ({steps:.0f} -> {math.floor(steps * verdict.cadence)} steps/min)"
    return text


def _amplitude(verdict: Feasibility) -> str:
    from exo_pin.feasible import MOST

    if not verdict.amplitude_decides:
        return "at no amplitude that is known"
    if not verdict.amplitude:
        return "at no amplitude of the joints"
    if verdict.amplitude >= MOST:
        return f"at {MOST:g} times the movement of the joints, and more was not tried"
    return f"up to {math.floor(100 * verdict.amplitude) / 100:.2f} times the movement of the joints"


def _row(demand: JointDemand) -> list[str]:
    scale = 1e3 if demand.slide else math.degrees(1.0)
    low, high = scale * float(demand.q.min()), scale * float(demand.q.max())
    torque, hardest = demand.torque_use, demand.acceleration
    return [
        demand.joint,
        f"{show.fixed(low)} .. {show.fixed(high)}",
        f"{show.fixed(scale * demand.lower, 0)}..{show.fixed(scale * demand.upper, 0)}",
        show.fixed(scale * demand.margin),
        show.fixed(100 * demand.speed_use, 0),
        "-" if math.isinf(hardest) else show.fixed(100 * demand.acceleration_use, 0),
        "-" if torque is None else show.fixed(100 * torque, 0),
    ]

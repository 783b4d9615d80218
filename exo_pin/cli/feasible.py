"""`exo-pin feasible`: can this device do this walk with this person?"""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from exo_pin.cli import options, show

if TYPE_CHECKING:
    from exo_pin.feasible import Feasibility, JointDemand

_EXAMPLES = """examples:
  exo-pin feasible                               the normal walk on the 12-joint exoskeleton
  exo-pin feasible walk.mot --device lokomat --stature 1.82 --mass 80
  exo-pin feasible very_fast --gap 10 --json

Joint ranges, speeds and accelerations, self-collision and reach; torques are not asked. Joints that the
device locks are dropped and told. exit code 0: it can; 1: it cannot"""


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
    verdict = feasible(gait, args.device, body, acceleration=acceleration, gap=args.gap / 1e3)
    if args.json:
        show.as_json(verdict.facts())
    else:
        _print(verdict, args.gait)
    return 0 if verdict.ok else 1


def _print(verdict: Feasibility, name: str) -> None:
    columns = ["joint", "asked deg", "range deg", "margin deg", "speed used", "accel. used", ""]
    show.table(f"{name} on {verdict.robot.name}", columns, [_row(d) for d in verdict.joints])
    facts = verdict.facts()
    pair = " and ".join(facts["clearance_between"])
    spare = ", ".join(f"{side} {show.fixed(x)} mm" for side, x in facts["reach_to_spare_mm"].items())
    print(f"nearest parts: {show.fixed(facts['clearance_mm'])} mm between {pair}")
    print(f"reach to spare between hip and ankle: {spare}")
    if verdict.dropped:
        told = ", ".join(f"{joint} {show.fixed(x)}" for joint, x in facts["dropped_deg"].items())
        print(f"locked joints, the walk asks of them up to [deg]: {told}")
    print(f"possible: {_factors(verdict)}")
    for failure in facts["failures"]:
        where = f" ({', '.join(failure['phases'])})" if failure["phases"] else ""
        print(f"NOT OK {failure['what']}: {failure['how']} in {failure['samples']} frames{where}")
    print("verdict: " + ("the device can do this walk" if verdict.ok else "NO"))


def _factors(verdict: Feasibility) -> str:
    cadence = f"up to {math.floor(100 * verdict.cadence) / 100:.2f} times the cadence"
    gait = verdict.gait
    if gait.periodic:
        steps = 120 / gait.duration
        cadence += f" ({steps:.0f} -> {math.floor(steps * verdict.cadence)} steps/min)"
    return f"{cadence}, or {math.floor(100 * verdict.amplitude) / 100:.2f} times the movement of the joints"


def _row(demand: JointDemand) -> list[str]:
    def degrees(low: float, high: float) -> str:
        return f"{show.fixed(math.degrees(low))} .. {show.fixed(math.degrees(high))}"

    return [
        demand.joint,
        degrees(float(demand.q.min()), float(demand.q.max())),
        degrees(demand.lower, demand.upper),
        show.fixed(math.degrees(demand.margin)),
        f"{100 * demand.speed_use:.0f} %",
        f"{100 * demand.acceleration_use:.0f} %",
        "ok" if demand.ok else "NOT OK",
    ]

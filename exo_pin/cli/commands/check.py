"""`exo-pin check`: every cross-check of a gait on a body, and a verdict."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from exo_pin.cli import options, show

if TYPE_CHECKING:
    from exo_pin.crosscheck import Check

_EXAMPLES = """examples:
  exo-pin check                      the normal walk at free speed
  exo-pin check walk.mot --stature 1.82
  exo-pin check fast --json > check.json
  exo-pin check --device lokomat     all ways of forward kinematics on another device

exit code 0: everything agrees; 1: something does not, or a joint leaves its limits"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    options.add_body(parser)
    options.add_hip_order(parser)
    parser.add_argument(
        "--device",
        default="exo12",
        metavar="DEVICE",
        help="name or device file (default: exo12); another one is checked on what it can do of the gait",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    """Check and print; 0 if everything agrees within the limits, else 1."""
    from exo_pin import crosscheck, devices
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    device = devices.find(args.device).carried()  # the gait itself says where the pelvis is
    robot = load_robot(body, device=device, hip_order=args.hip_order)
    gait = options.gait_from(args, body)
    if device.locked:
        gait = robot.to_gait(robot.from_gait(gait), gait)
    with show.busy("cross-checking"):
        verdict = crosscheck.check(robot, gait)
    if args.json:
        show.as_json(verdict.facts())
    else:
        _print(verdict, args.gait)
    return 0 if verdict.ok else 1


def _print(verdict: Check, name: str) -> None:
    from math import degrees

    from exo_pin.crosscheck import FK_TOLERANCE

    recovery, track = verdict.recovery, verdict.recovery.track
    titles = {"recursion": "the paper's recursion", "dh": "modified D-H table", "yourdfpy": "yourdfpy"}
    rows = [
        [f"{titles[name]} against Pinocchio", f"{difference:.1e}", _mark(difference <= FK_TOLERANCE)]
        for name, difference in verdict.fk.items()
    ]
    angle, agreement = degrees(recovery.largest_angle_error), degrees(verdict.agreement)
    rows += [
        ["feet reached by IK, position", f"{recovery.largest_position_error:.1e} m", _mark(verdict.ik_ok)],
        ["feet reached by IK, rotation", f"{recovery.largest_rotation_error:.1e} rad", _mark(verdict.ik_ok)],
        ["angles recovered (knee bent > 5 deg)", f"{angle:.1e} deg", _mark(verdict.angles_ok)],
        ["closed form against iteration", f"{agreement:.1e} deg", _mark(verdict.angles_ok)],
        ["frames converged", f"{int(track.converged.sum())} of {len(track.q)}", _mark(verdict.ik_ok)],
    ]
    show.table(f"Cross-checks: {name}", ["check", "largest difference", ""], rows)
    limit_rows = [
        [
            joint,
            show.fixed(degrees(demand.lowest)),
            show.fixed(degrees(demand.highest)),
            str(demand.samples_outside or "-"),
        ]
        for joint, demand in verdict.limits.items()
    ]
    show.table("Joint ranges", ["joint", "min deg", "max deg", "outside limits"], limit_rows)
    print("verdict: " + ("all is well" if verdict.ok else _why(verdict)))


def _mark(ok: bool) -> str:
    return "ok" if ok else "NOT OK"


def _why(verdict: Check) -> str:
    reasons = [
        (verdict.fk_ok, "forward kinematics disagree"),
        (verdict.ik_ok, "inverse kinematics missed frames within the limits"),
        (verdict.angles_ok, "recovered angles differ from the given ones, or the two methods disagree"),
        (verdict.limits_ok, f"outside the limits: {', '.join(verdict.joints_outside)}"),
    ]
    return "NO: " + "; ".join(text for ok, text in reasons if not ok)

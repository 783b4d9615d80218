"""`exo-pin check`: every cross-check of a gait on a body, and a verdict."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from exo_pin.cli import device_options, missing, options, show

if TYPE_CHECKING:
    from exo_pin.crosscheck import Check
    from exo_pin.feasible import DeviceWalk

_EXAMPLES = """examples:
  exo-pin check                      the normal walk at free speed
  exo-pin check walk.mot --stature 1.82
  exo-pin check fast --json > check.json
  exo-pin check --dynamics           dynamics too: inverse four ways, forward in a simulation
  exo-pin check --device lokomat     all ways of forward kinematics on another device

exit code 0: everything agrees and the device fits, perhaps with a concession (knee held at its stop, a slower
or a smaller walk); 1: something does not agree, or the device does not fit"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    options.add_body(parser)
    options.add_hip_order(parser)
    device_options.add(
        parser, "name or device file (default: exo12); another one is checked on what it can do of the gait"
    )
    parser.add_argument(
        "--dynamics",
        action="store_true",
        help="check dynamics too: inverse by recursion, MuJoCo, OpenSim (if installed); a simulated cycle",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    """Check and print; 0 if everything agrees and the device fits, else 1."""
    from exo_pin import crosscheck
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    given = options.gait_from(args, body)
    with show.busy("cross-checking"):
        found = device_options.answer(args, body, given, hip_order=args.hip_order)
        device = found.device.carried()  # the gait itself says where the pelvis is
        robot = load_robot(body, device=device, hip_order=args.hip_order)
        gait = found.gait
        if device.locked:
            gait = robot.to_gait(robot.from_gait(gait), gait)
        checked = crosscheck.check(robot, gait, dynamics=args.dynamics)
    missing.note_without("yourdfpy")
    ok = checked.consistent and found.ok
    if args.json:
        show.as_json(checked.facts() | {"ok": ok} | found.facts())
    else:
        _print(checked, found, args.gait)
    return 0 if ok else 1


def _print(verdict: Check, found: DeviceWalk, name: str) -> None:
    from math import degrees

    from exo_pin.crosscheck import DYNAMICS_TOLERANCE, FK_TOLERANCE

    recovery, track = verdict.recovery, verdict.recovery.track
    titles = {"recursion": "the paper's recursion", "dh": "modified D-H table", "yourdfpy": "yourdfpy"}
    ways = titles | {"mujoco": "MuJoCo", "opensim": "OpenSim"}
    ways = {name: f"inverse dynamics: {way}" for name, way in ways.items()}
    ways["simulation"] = "forward dynamics: MuJoCo's simulation of a cycle"
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
    rows += [
        [
            f"{ways[name]} against Pinocchio, relative",
            f"{difference:.1e}",
            _mark(difference <= DYNAMICS_TOLERANCE),
        ]
        for name, difference in verdict.dynamics.items()
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
    print(f"cross-checks: {'all agree' if verdict.consistent else _why(verdict)}")
    device_options.print_answer(found, "verdict: ")


def _mark(ok: bool) -> str:
    return "ok" if ok else "NOT OK"


def _why(verdict: Check) -> str:
    reasons = [
        (verdict.dynamics_ok, "dynamics disagree"),
        (verdict.fk_ok, "forward kinematics disagree"),
        (verdict.ik_ok, "inverse kinematics missed frames within the limits"),
        (verdict.angles_ok, "recovered angles differ from the given ones, or the two methods disagree"),
    ]
    return "NO: " + "; ".join(text for ok, text in reasons if not ok)

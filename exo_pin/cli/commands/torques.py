"""`exo-pin torques`: the joint torques of a walk by inverse dynamics, shared by motors and person."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from exo_pin.anatomy.names import Masses
from exo_pin.cli import device_options, options, own_torques, show, torque_files
from exo_pin.errors import DescriptionError

if TYPE_CHECKING:
    from exo_pin.control import JointTorque, Patient, WalkTorques
    from exo_pin.dynamics import Dynamics

_EXAMPLES = """examples:
  exo-pin torques                                 the normal walk, its ground reaction predicted
  exo-pin torques ik.mot --model person.osim --forces grf.mot -o torques.sto
  exo-pin torques trial.c3d                       the trial's own force plates
  exo-pin torques --bws 0.3 --patient paretic_right     30 % of the weight carried, a weak right leg
  exo-pin torques --device lokomat --assist 0.5 --json --curves

Torques are positive the way their joint is named. With force plates, frames in which a foot stands on no
plate are not valid and left out: empty in .csv, NaN in .sto and .mot, null in JSON. Without them the ground
reaction is predicted, an assumption (see docs/forces.md). A device's joints copy the walk; those that it
locks stay at zero."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    options.add_gait(parser)
    device_options.add_device(parser)
    parser.add_argument(
        "--bws",
        type=float,
        default=0.0,
        metavar="SHARE",
        help="constant body-weight support, as a share of the weight, 0 .. 1 (default: 0)",
    )
    parser.add_argument(
        "--masses",
        choices=get_args(Masses),
        help="whose masses move (default: the wearer's with force plates, both without)",
    )
    parser.add_argument(
        "--patient",
        metavar="PATIENT",
        help="who gives a part of the torque: healthy, paretic_right, plegic or a .toml file",
    )
    parser.add_argument(
        "--assist",
        type=float,
        metavar="SHARE",
        help="the motors' share of what the relaxed leg requires, 0 .. 1; the person gives the rest",
    )
    torque_files.add(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--curves", action="store_true", help="with --json: the curves as well")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Compute, share, print, write."""
    from exo_pin.control import walk_torques

    patient = _checked(args)
    body = options.body_from(args)
    walk = options.gait_from(args, body)
    robot, walk = device_options.motion(args, body, walk)
    walk, _ = options.with_events(robot, walk)
    how = {"body_weight_support": args.bws, "masses": args.masses}
    changed = device_options.changes_motion(args)
    found = own_torques.inverse_dynamics(args, robot, walk, changed=changed, **how)
    shared = walk_torques(found, walk, patient, args.assist)
    if args.json:
        show.as_json(shared.facts() | (_curves(shared) if args.curves else {}))
    else:
        _print(shared, f"{Path(args.gait).name} on {robot.name}")
    if args.output:
        torque_files.write(args, found, walk)
    return 0


outputs = torque_files.outputs
"""Files beside that of the torques."""


def _checked(args: argparse.Namespace) -> Patient | None:
    """The patient; numbers out of range and endings that are not written are refused before the work."""
    from exo_pin.control import find_patient

    for name, value in (("--bws", args.bws), ("--assist", args.assist)):
        if value is not None and not 0.0 <= value <= 1.0:
            raise DescriptionError(f"{name} is {value:g}; a share of 0 to 1 is accepted")
    if args.curves and not args.json:
        raise DescriptionError("--curves adds to --json; give both")
    torque_files.check(args)
    return None if args.patient is None else find_patient(args.patient)


def _curves(shared: WalkTorques) -> dict[str, Any]:
    """The curves of all joints that are driven; those of motors and person beside the whole."""
    curves = shared.found.curves()
    for name in ("torque_Nm", "power_W"):
        curves[name] = {joint: curves[name][joint] for joint in shared.joints}
    return curves | shared.curves()


def _print(shared: WalkTorques, title: str) -> None:
    found = shared.found
    columns = ["joint", "peak N m", "rms N m", "N m/kg", "peak W", "work+ J", "work- J", "net J"]
    columns += ["motor %", "motor peak N m", "person peak N m", "ground reaction"]
    columns = [name.replace("N m", "N\N{NO-BREAK SPACE}m") for name in columns]
    rows = [[*_row(joint, shared), found.reaction] for joint in shared.joints.values()]
    kept = [k for k in range(len(columns)) if any(row[k] != "-" for row in rows)]
    show.table(
        f"Joint torques: {title}; work per stride",
        [columns[k] for k in kept],
        [[row[k] for k in kept] for row in rows],
    )
    print(show.plain(found.source))
    print(f"shared: {show.plain(shared.shared)}")
    if found.body_weight_support:
        print(f"body-weight support: {found.support_force:.0f} N, constant")
    _print_residual(found)
    print(f"valid: {int(found.valid.sum())} of {len(found.valid)} frames")
    for missing in shared.missing:
        print(f"note: {missing}")


def _row(joint: JointTorque, shared: WalkTorques) -> list[str]:
    whole = [joint.peak, joint.rms]
    work = [joint.work.positive, joint.work.negative, joint.work.net]
    return [
        joint.joint,
        *(show.fixed(x) for x in whole),
        _known(joint.per_kg, 2),
        show.fixed(joint.power, 0),
        *(_known(x, 1) for x in work),
        *(_shares(joint) if np.nansum(np.abs(shared.person)) else ["-"] * 3),
    ]


def _shares(joint: JointTorque) -> list[str]:
    return [
        _known(100 * joint.motor_share, 0),
        show.fixed(joint.motor_peak),
        show.fixed(joint.person_peak),
    ]


def _known(value: float, digits: int) -> str:
    return "-" if math.isnan(value) else show.fixed(value, digits)


def _print_residual(found: Dynamics) -> None:
    """What the model does not explain, beside the published thresholds where the ground is measured.

    A predicted ground reaction leaves the horizontal rest to the support: that is no error of a recording.
    """
    facts = found.residual.facts()
    measured = found.reaction == "measured"
    what = "residual" if measured else "the support gives (ground reaction predicted):"
    for name, unit in (("force", "N"), ("moment", "N m")):
        rms, peak, most = (facts[f"{name}_{key}_{unit.replace(' ', '')}"] for key in _RESIDUAL)
        weight = f", {facts['force_rms_percent_of_weight']:.1f} % of the weight" if name == "force" else ""
        line = f"{what} {name} {rms:.0f} {unit} rms{weight}; largest {peak:.0f} {unit}"
        if measured:
            verdict = "within" if peak <= most else "above"
            line += f", {verdict} the published threshold of {most:.0f} {unit} (Hicks et al. 2015)"
        print(line)


_RESIDUAL = ("rms", "peak", "threshold")

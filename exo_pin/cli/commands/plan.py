"""`exo-pin plan`: footsteps become a walk of the whole body that nothing has to hold."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import (
    footstep_options,
    missing,
    options,
    show,
    simulated_scene,
    simulation_options,
    simulation_output,
)
from exo_pin.errors import DescriptionError
from exo_pin.files import write_text

if TYPE_CHECKING:
    from exo_pin.simulation import Run
    from exo_pin.viewer import Scene
    from exo_pin.walking import Plan

_EXAMPLES = """examples:
  exo-pin plan -o walk.csv                          8 steps of 0.30 m, from rest to rest
  exo-pin plan --length 0.25 --turn 10 --html walk.html
  exo-pin plan --stature 1.55 --length 0.27 --json
  exo-pin plan --footsteps steps.csv -o walk.csv    a table: side,x_m,y_m,heading_deg
  exo-pin plan --strides walk.mot --shorten 0.5     the feet of a recorded walk, steps half as long
  exo-pin plan --simulate --html walk.html          does it stand? nothing holds the pelvis
  exo-pin plan --simulate --push 60,0,0.1@3.2 --controller pd_free

The centre of mass follows from the ZMP by the inverted pendulum, the legs by closed-form inverse kinematics;
docs/walking.md has the method and its limits: level ground, flat standing feet. exit code 0: every joint
keeps its limits, the ZMP stays inside the soles, and with --simulate it stands to the end; 1: not so (it is
written all the same); 2: refused. More of the simulation: exo-pin simulate walk.csv --support none"""

_STABILISED = "pd_stabilised"


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    footstep_options.add(parser)
    parser.add_argument(
        "--device",
        default="exo12",
        metavar="DEVICE",
        help="name or device file with six driven joints a leg (default: exo12)",
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="write the walk (.csv .mot .sto .npz ...)")
    parser.add_argument("--html", metavar="FILE", help="write one offline page")
    parser.add_argument(
        "--simulate", action="store_true", help="let it walk by torques in MuJoCo, its pelvis free"
    )
    parser.add_argument(
        "--controller",
        default=_STABILISED,
        metavar="NAME|FILE.py:CLASS",
        help=f"with --simulate (default: {_STABILISED}); as of exo-pin simulate",
    )
    simulation_options.add_push(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Plan, print, write; 0 if the plan is good, else 1."""
    from exo_pin.robot import load_robot
    from exo_pin.walking import plan_walk

    if args.output:
        from exo_pin.formats.registry import written_format

        written_format(Path(args.output))  # an ending that is not written is refused before the work
    if not args.simulate and (args.push or args.controller != _STABILISED):
        raise DescriptionError("--push and --controller are for a simulation; add --simulate")
    if args.simulate:
        _check_simulation(args)
    body = options.body_from(args)
    robot = load_robot(body, device=args.device)
    steps = footstep_options.footsteps(args, body, robot)
    with show.busy("planning"):
        plan = plan_walk(robot, steps)
    done = _simulated(args, plan) if args.simulate else None
    if args.json:
        show.as_json(plan.facts() | ({} if done is None else done.facts()))
    else:
        _print(plan)
        if done is not None:
            simulation_output.print_run(done, f"{plan.words}, simulated")
    _write(args, plan, done)
    return 0 if plan.ok and (done is None or done.stands) else 1


def _check_simulation(args: argparse.Namespace) -> None:
    """Refuse a controller or a push that is not accepted, before the work."""
    from exo_pin.control import find_controller

    find_controller(args.controller)
    simulation_options.pushes(args)


def _simulated(args: argparse.Namespace, plan: Plan) -> Run:
    """The plan by torques, nothing at its pelvis."""
    from exo_pin.simulation import simulate

    with simulation_output.progress(args.controller) as bar:
        return simulate(
            plan.robot,
            plan.gait,
            args.controller,
            support="none",
            pushes=simulation_options.pushes(args),
            after=bar,
        )


def _print(plan: Plan) -> None:
    rows = [
        [
            demand.joint,
            f"{show.fixed(math.degrees(demand.position.lowest))} .. "
            f"{show.fixed(math.degrees(demand.position.highest))}",
            show.fixed(math.degrees(demand.position.margin)),
            show.fixed(100 * demand.speed.use, 0),
            "-" if demand.torque is None else show.fixed(demand.torque.peak, 0),
            "-" if demand.torque is None else show.fixed(100 * demand.torque.use, 0),
        ]
        for demand in plan.demands
    ]
    columns = ["joint", "range deg", "room deg", "speed %", "peak N\N{NO-BREAK SPACE}m", "torque %"]
    show.table(f"Planned walk on {plan.robot.name}: {plan.words}", columns, rows)
    forward, sideways = (show.fixed(1e3 * x, 2) for x in plan.zmp_rms)
    print(f"ZMP of the whole body off its path: {forward} mm rms forward, {sideways} mm sideways")
    print(f"ZMP inside the soles by at least {show.fixed(1e3 * float(plan.margins.min()), 0)} mm")
    print(f"hips {plan.pelvis_height:.3f} m high; generated in {plan.generation_time:.2f} s of CPU time")
    for reason in plan.reasons:
        print(f"not good: {reason}")


def _write(args: argparse.Namespace, plan: Plan, done: Run | None) -> None:
    """The files that are asked for; a line for each, on the terminal alone where JSON is printed."""
    lines = []
    if args.output:
        from exo_pin.formats import save_gait

        save_gait(plan.gait, args.output)
        lines.append(f"{args.output}: {len(plan.gait)} samples, {plan.gait.duration:.3f} s")
    if args.html:
        from exo_pin import viewer

        text = viewer.html(_scene(plan, done))
        write_text(args.html, text)
        lines.append(
            f"{args.html}: {len(text.encode()) / 1e6:.1f} MB, opens in any browser without a network"
        )
    for line in lines * (not args.json):
        print(line)


def _scene(plan: Plan, done: Run | None) -> Scene:
    """The simulated walk beside its plan, or the planned walk with its ground forces and torques."""
    from exo_pin import viewer

    if plan.robot.body is not None and plan.robot.body.wearer:
        missing.note_without_figure()
    if done is not None:
        return simulated_scene.scene(done, plan.words)
    chosen = viewer.SceneOptions(
        title=f"planned walk, {plan.words} - exo_pin",
        support="still",  # the pelvis is shown where it is planned
        notes=(f"Planned, not recorded: {plan.words}.", *(f"Not good: {reason}." for reason in plan.reasons)),
    )
    kinetics = viewer.Kinetics.of_dynamics(plan.dynamics)
    return viewer.exoskeleton_scene(plan.robot, plan.gait, chosen, kinetics=kinetics)

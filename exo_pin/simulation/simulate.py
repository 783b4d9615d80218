"""Simulate a walk: the model, the walk to follow, the controller, the loop."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from exo_pin import arguments
from exo_pin.control import Controller, Patient, find_controller, find_patient, reset
from exo_pin.dynamics import CUTOFF, FREE_CUTOFF, mass_of, torques
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.physics import GRAVITY
from exo_pin.robot import Robot
from exo_pin.robot.gait_columns import in_joint_order
from exo_pin.simulation.engine_forces import sensing_model
from exo_pin.simulation.loop import Loop
from exo_pin.simulation.model_errors import with_errors
from exo_pin.simulation.mujoco_model import Floor
from exo_pin.simulation.pelvis_support import PelvisSupport, SupportName, find_support
from exo_pin.simulation.plant import Joints, Plant
from exo_pin.simulation.push import Push, pushed
from exo_pin.simulation.reference_motion import reference_motion
from exo_pin.simulation.run import Run

_MOST_SUPPORT = 0.95
"""Part of the weight: with all of it nothing would press the soles to the floor."""

MOST_STEPS = 1_000_000
"""Of one run: 1000 s at 1 ms, some 2 GB."""


def simulate(
    robot: Robot,
    gait: Gait,
    controller: str | Controller = "pd",
    *,
    patient: str | Patient | None = None,
    support: SupportName | PelvisSupport = "soft",
    body_weight_support: float = 0.0,
    cycles: int = 10,
    timestep: float = 0.001,
    plant: Plant | None = None,
    pushes: Sequence[Push] = (),
    seed: int = 0,
    after: Callable[[int, int], None] = lambda step, steps: None,
) -> Run:
    """Let an exoskeleton walk by torques.

    The walk is seen by controller and support alone: after the start no position is written. The pelvis is
    free; the support is a force on it. MuJoCo computes the motion, 1 mm rigid soles on a floor.

    Args:
        robot: The exoskeleton with its wearer.
        gait: The walk to follow.
        controller: One of `exo_pin.control.CONTROLLERS`, or an object that is called as `Controller` says.
        patient: One of `exo_pin.control.PATIENTS`, a TOML file or a record; None: the motors do it all.
        support: What holds the pelvis.
        body_weight_support: Constant upward force at mid-hip as a part of the weight of wearer and device.
        cycles: How often a walk that repeats is walked; a recording is walked once.
        timestep: [s], 0.1 to 5 ms.
        plant: Limits, friction, delay and errors of the machine; `Plant()` if left out.
        pushes: Forces at the pelvis for a short time.
        seed: Of whatever is random.
        after: Called now and then with the number of steps done and to do.

    Raises:
        UnknownNameError: There is no such controller, patient or support.
        DescriptionError: A number is not within its range, the controller's answer cannot be used, or MuJoCo
            does not accept the robot.
        GaitError: The walk has no stance.
    """
    plant = plant or Plant()
    arguments.count("seed", seed, 0, arguments.LARGEST_SEED)
    _check(body_weight_support, cycles, timestep)
    _check_steps(gait, cycles, timestep)
    held = find_support(support, robot.device)
    person = None if patient is None else find_patient(patient)
    name, drive = find_controller(controller)
    required = torques(
        robot,
        gait,
        body_weight_support=body_weight_support,
        cutoff=FREE_CUTOFF if held.free else CUTOFF,
        free=held.free,
    )
    walk = reference_motion(gait, required, cycles=cycles, timestep=timestep)
    model = required.robot
    machine = with_errors(model, mass=plant.mass_error, length=plant.length_error)
    engine = sensing_model(
        machine, floor=Floor(plant.floor_friction, plant.floor_time_constant), timestep=timestep
    )
    reset(drive, model, gait)
    effort, speed = (in_joint_order(machine.joints, x) for x in (machine.effort, machine.velocity))
    every = 1 if plant.rate is None else max(round(1.0 / (plant.rate * timestep)), 1)
    loop = Loop(
        engine,
        machine,
        walk,
        drive,
        Joints(plant, effort, speed, seed),
        person,
        held,
        body_weight_support * mass_of(model) * GRAVITY,
        pushed(pushes, walk),
        every=every,
        delay=round(plant.delay / timestep),
    )
    start = time.process_time()
    record, ended = loop.run(lambda k: after(k, len(walk.time)) if k % 100 == 0 else None)
    return Run(
        gait=gait,
        robot=machine,
        required=required,
        reference=walk,
        record=record,
        controller=name,
        patient=person,
        support=held,
        pushes=tuple(pushes),
        plant=plant,
        body_weight_support=body_weight_support,
        weight=mass_of(machine) * GRAVITY,
        timestep=timestep,
        ended=ended,
        cpu_time=time.process_time() - start,
    )


def _check(body_weight_support: float, cycles: int, timestep: float) -> None:
    arguments.number("body-weight support", body_weight_support, least=0.0, most=_MOST_SUPPORT)
    arguments.count("cycles", cycles, 1, MOST_STEPS)
    arguments.number("timestep [s]", timestep, least=1e-4, most=5e-3)


def _check_steps(gait: Gait, cycles: int, timestep: float) -> None:
    """Refuse runs that would take hours and gigabytes, before anything is computed."""
    steps = gait.duration * (cycles if gait.periodic else 1) / timestep
    if steps > MOST_STEPS:
        raise DescriptionError(
            f"{steps:.0f} steps; {MOST_STEPS} are accepted: fewer cycles or a longer timestep"
        )

"""The plan of a robustness study: walks, supports, controllers, patients and machines, times seeds."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import product
from typing import Any, get_args

from exo_pin import devices as known
from exo_pin.anatomy import Body
from exo_pin.anatomy.names import Speed
from exo_pin.arguments import count, number, several, word
from exo_pin.control import find_controller, find_patient
from exo_pin.devices import Device
from exo_pin.errors import DescriptionError
from exo_pin.gait import SPEEDS
from exo_pin.simulation.pelvis_support import SupportName, find_support
from exo_pin.study.fingerprint import code_digest
from exo_pin.study.simulated_case import NOBODY, SimulatedCase

MOST_RUNS = 100_000
"""Of one study: a run of ten cycles takes about a second."""


def simulations(
    speeds: Iterable[Speed] = ("slow", "free"),
    devices: Iterable[str | Device] = ("exo12",),
    *,
    body: Body | None = None,
    supports: Iterable[SupportName] = ("soft",),
    body_weight_supports: Iterable[float] = (0.0,),
    controllers: Iterable[str] = ("pd",),
    patients: Iterable[str] = (NOBODY,),
    delays: Iterable[float] = (0.0,),
    floor_frictions: Iterable[float] = (0.8,),
    mass_errors: Iterable[float] = (0.0,),
    runs: int = 50,
    seed: int = 0,
    cycles: int = 10,
    timestep: float = 0.001,
    spread: float = 1.0,
) -> list[SimulatedCase]:
    """The plan of a robustness study: every combination, each with the seeds `seed` to `seed + runs - 1`.

    Args:
        speeds: Of the normative walk.
        devices: Names, device files or records.
        body: The body that walks; the default body if left out.
        supports: Of the pelvis.
        body_weight_supports: Parts of the weight of wearer and device.
        controllers: Names, or `file.py:Class`.
        patients: Names or TOML files; `none`: the motors do it all.
        delays: From measurement to torque [s].
        floor_frictions: Coulomb coefficients.
        mass_errors: The machine is heavier than its model by this part.
        runs: Of each combination.
        seed: The first.
        cycles: Of each run.
        timestep: [s].
        spread: Scales how far the machines of the runs differ; 0: they are all alike.

    Raises:
        UnknownNameError: There is no such speed, device, controller, patient or support.
        DescriptionError: A number is not within its range, or there are more than 100 000 runs.
    """
    count("runs", runs, 1, MOST_RUNS)
    count("seed", seed, 0, 2**31)
    count("cycles", cycles, 1, 1000)
    number("timestep [s]", timestep, least=1e-4, most=5e-3)
    number("spread", spread, least=0.0, most=3.0)
    axes: dict[str, list[Any]] = {
        "gait": [word("speed", name, SPEEDS) for name in several("speeds", speeds)],
        "device": [known.find(name) for name in several("devices", devices)],
        "support": [word("support", name, get_args(SupportName)) for name in several("supports", supports)],
        "body_weight_support": _numbers("body-weight supports", body_weight_supports, 0.0, 0.95),
        "controller": list(several("controllers", controllers)),
        "patient": list(several("patients", patients)),
        "delay": _numbers("delays", delays, 0.0, 0.5),
        "floor_friction": _numbers("floor frictions", floor_frictions, 0.0, 2.0),
        "mass_error": _numbers("mass errors", mass_errors, -0.3, 0.8),
    }
    total = runs * math.prod(map(len, axes.values()))
    if not 0 < total <= MOST_RUNS:
        raise DescriptionError(f"{total} runs; 1 to {MOST_RUNS} are accepted: fewer conditions or seeds")
    _check_names(axes)
    shared: dict[str, Any] = {
        "body": body or Body.from_stature(),
        "seeds": tuple(range(seed, seed + runs)),
        "cycles": cycles,
        "timestep": timestep,
        "spread": spread,
        "code": code_digest(),
    }
    return [
        SimulatedCase(**dict(zip(axes, values, strict=True)), **shared) for values in product(*axes.values())
    ]


def _numbers(name: str, values: Iterable[float], least: float, most: float) -> list[float]:
    return [number(name, value, least=least, most=most) for value in several(name, values)]


def _check_names(axes: dict[str, list[Any]]) -> None:
    """Refuse what no run could use, before the first."""
    for name in axes["controller"]:
        find_controller(name)
    for name in axes["patient"]:
        if name != NOBODY:
            find_patient(name)
    for support, device in product(axes["support"], axes["device"]):
        find_support(support, device)

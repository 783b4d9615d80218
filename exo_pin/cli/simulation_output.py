"""What a simulation prints: verdict first, the numbers of one run, the table of several."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.cli import show

if TYPE_CHECKING:
    from exo_pin.simulation import Run

RUN_COLUMNS = ("controller", "patient", "verdict", "rms deg", "motors N m", "motors' share", "legs carry")
"""Headings of `row`."""


class Progress(Protocol):
    """Receives the steps done and to do."""

    def __call__(self, step: int, steps: int) -> None:
        """Show them."""


@contextmanager
def progress(label: str) -> Iterator[Progress]:
    """A progress bar on stderr if that is a terminal."""
    if not sys.stderr.isatty():
        yield lambda step, steps: None
        return
    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(label, total=None)
        yield lambda step, steps: bar.update(task, completed=step, total=steps)


def print_run(run: Run, what: str) -> None:
    """Verdict with its reason, conditions, numbers, motors.

    Args:
        run: What was simulated.
        what: The walk and the device, in words.
    """
    verdict = run.verdict
    print(f"{verdict.word}: {verdict.why}")
    show.table(f"{what}, {_conditions(run)}", ["simulated", "value"], _numbers(run))
    found, heads = run.numbers, ["N m", "peak left", "right", "rms left", "right", "limit %"]
    driven = [x for x in MOVEMENTS if any(f"{side}_{x}" in found.motor_rms for side in SIDES)]
    show.table(
        "Motors; time at the limit, left / right", heads, [_motor(run, movement) for movement in driven]
    )


def row(run: Run) -> list[str]:
    """One run as a row of the table; `-` where it has no such number."""
    sides = [run.by_side[side] for side in SIDES]
    return [
        run.controller,
        "none" if run.patient is None else run.patient.name,
        run.verdict.word,
        _pair((x.tracking_rms_deg for x in sides), 2),
        _pair((x.motor_rms for x in sides), 1),
        _pair((x.motor_share for x in sides), 2),
        f"{_number(run.numbers.vertical_force_mean_bw, 2)} of {1.0 - run.body_weight_support:.2f}",
    ]


def _conditions(run: Run) -> str:
    patient = "no patient" if run.patient is None else f"patient {show.plain(run.patient.name)}"
    return (
        f"controller {show.plain(run.controller)}, {patient}, support {run.support.name}, {_unloading(run)}"
    )


def _unloading(run: Run) -> str:
    """Body-weight support in newtons, and as a part of the wearer's own weight."""
    from exo_pin.physics import GRAVITY

    newtons = run.body_weight_support * run.weight
    if not newtons:
        return "no body-weight support"
    body = run.robot.body
    wearer = body is not None and body.wearer
    own = f", {newtons / (body.mass * GRAVITY):.2f} of the wearer's weight" if body and wearer else ""
    return f"body-weight support {newtons:.0f} N ({run.body_weight_support:g} of wearer and device{own})"


def _numbers(run: Run) -> list[list[str]]:
    found = run.numbers
    contact = " / ".join(f"{_number(found.swing_contact_percent[side], 1)} %" for side in SIDES)
    speed = run.time[-1] / run.cpu_time if run.cpu_time else math.nan
    rows = {
        "walked": f"{run.time[-1]:.2f} s of {run.reference.time[-1]:.2f} s",
        "tracking rms, largest": f"{found.tracking_rms_deg:.2f}, {found.tracking_max_deg:.1f} deg",
        "swing contact left / right": contact,
        "weight carried by the legs": f"{found.vertical_force_mean_bw:.3f} of "
        f"{1.0 - run.body_weight_support:.2f}",
        "motors' share of the torque": _number(found.motor_share, 2),
        "energy balance, missing": f"{_number(run.energy_balance_percent, 3)} %",
        "witness, relative": f"{run.witness:.1e}",
        "real-time factor": _number(speed, 1),
    }
    if run.support.free:
        free = run.free_numbers
        rows |= {
            "pelvis off its path, largest": f"{free.pelvis_off_path_max_mm:.0f} mm",
            "slip of a sole, largest": f"{free.slip_max_mm:.1f} mm",
            "ZMP of the walk inside its soles": f"{_number(free.zmp_margin_min_mm, 0)} mm; "
            f"outside {free.zmp_outside_percent:.0f} % of the time",
        }
    return [[name, value] for name, value in rows.items()]


def _motor(run: Run, movement: str) -> list[str]:
    """Peak left and right, root mean square left and right, time at the limit; `-` without a motor."""
    found, names = run.numbers, [f"{side}_{movement}" for side in SIDES]
    torques = [
        _number(values.get(name, math.nan), 0)
        for values in (found.peak_torque, found.motor_rms)
        for name in names
    ]
    saturated = _pair((found.saturated.get(name, 0.0) for name in names), 1)
    return [movement.replace("_", " "), *torques, saturated]


def _pair(values: Iterable[float], digits: int) -> str:
    return " / ".join(_number(value, digits) for value in values)


def _number(value: float, digits: int) -> str:
    return show.fixed(value, digits) if math.isfinite(value) else "-"

"""Options of a simulation: controller, patient, support, and what the machine is like."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from exo_pin.cli import measures
from exo_pin.errors import DescriptionError
from exo_pin.safe import plain_numbers

if TYPE_CHECKING:
    from exo_pin.simulation import Plant, Push

ALL, NOBODY = "all", "none"

_PLANT = {
    "mass_error": ("PART", "the machine is heavier than its model by this part, e.g. 0.1"),
    "length_error": ("PART", "its links are longer by this part"),
    "floor_friction": ("MU", "Coulomb coefficient of the floor (default: 0.8)"),
    "floor_time_constant": ("S", "of the floor's contact (MuJoCo's solref; default: 0.01)"),
    "joint_friction": ("NM", "Coulomb friction of each joint [N m]"),
    "joint_damping": ("NMS", "viscous friction of each joint [N m s/rad]"),
    "encoder_step": ("RAD", "resolution of the measured angles [rad]"),
    "noise": ("RAD", "standard deviation of the measured angles [rad]"),
    "rate": ("HZ", "calls of the controller a second (default: at every step)"),
    "delay": ("S", "from measurement to torque [s]"),
}
"""Field of `Plant` -> unit and help of its option."""

_OPTIONS = {"floor_friction": "friction", "rate": "controller-rate"}
"""Field of `Plant` -> its option, where that has another name."""


def add(parser: argparse.ArgumentParser) -> None:
    """Who drives and who walks, the support, the length of the run, and the machine."""
    parser.add_argument(
        "--controller",
        default="pd",
        metavar="NAME|FILE.py:CLASS",
        help="of the motors: pd (default), pd_free, pd_stabilised, pd_only, pd_gravity, computed_torque, "
        "impedance, impedance_ff, assist_as_needed, off, one of your own, several with commas, or all. A "
        "file is run as it is, with all your rights: run only what you trust",
    )
    parser.add_argument(
        "--patient",
        default=NOBODY,
        metavar="NAME|FILE.toml",
        help="who walks in it: none (default: the motors do it all), healthy, paretic_right, plegic, one of "
        "your own, several with commas, or all",
    )
    parser.add_argument(
        "--support",
        choices=("soft", "stiff", "stand", "none"),
        default="soft",
        help="of the pelvis: soft upwards (default: the legs carry), stiff, the device's own stand, or none",
    )
    parser.add_argument(
        "--bws", type=measures.number, default=0.0, metavar="B", help="body-weight support, 0 to below 1"
    )
    parser.add_argument("--cycles", type=int, metavar="N", help="of a walk that repeats (default: 10)")
    parser.add_argument(
        "--timestep", type=measures.number, default=1e-3, metavar="S", help="[s] (default: 0.001)"
    )
    add_push(parser)
    parser.add_argument("--seed", type=int, default=0, help="of the encoders' noise (default: 0)")
    _add_machine(parser)


def add_push(parser: argparse.ArgumentParser) -> None:
    """Pushes at the pelvis."""
    parser.add_argument(
        "--push",
        action="append",
        default=[],
        metavar="N,N,S@S",
        help="at the pelvis: force forward, force to the left [N], duration, start [s], e.g. 60,0,0.1@3.2; "
        "may be given again",
    )


def _add_machine(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("the machine (the controller knows its model alone)")
    group.add_argument("--no-limits", action="store_true", help="motors without limits of torque and speed")
    for name, (unit, words) in _PLANT.items():
        option = _OPTIONS.get(name, name.replace("_", "-"))
        group.add_argument(f"--{option}", dest=name, type=measures.number, metavar=unit, help=words)


def plant(args: argparse.Namespace) -> Plant:
    """The machine of the command line.

    Raises:
        DescriptionError: A number is not within its range.
    """
    from exo_pin.simulation import Plant

    given: dict[str, Any] = {name: getattr(args, name) for name in _PLANT}
    numbers = {name: value for name, value in given.items() if value is not None}
    return Plant(limits=not args.no_limits, **numbers)


def conditions(args: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `exo_pin.simulation.simulate` that hold for all runs of the command line.

    Raises:
        DescriptionError: A number is not within its range.
    """
    if args.seed < 0:
        raise DescriptionError(f"--seed is {args.seed}; a whole number from 0 on is accepted")
    return {
        "support": args.support,
        "body_weight_support": args.bws,
        "cycles": 10 if args.cycles is None else args.cycles,
        "timestep": args.timestep,
        "plant": plant(args),
        "pushes": pushes(args),
        "seed": args.seed,
    }


def pushes(args: argparse.Namespace) -> tuple[Push, ...]:
    """The pushes of the command line.

    Raises:
        DescriptionError: One is not written as it should be, or a number is not within its range.
    """
    return tuple(_push(text) for text in args.push)


def _push(text: str) -> Push:
    """A push as it is typed: force forward and to the left, duration @ start."""
    from exo_pin.simulation import Push

    force, _, start = text.partition("@")
    try:
        forward, left, duration = (plain_numbers.number(x) for x in force.split(","))
        at = plain_numbers.number(start)
    except ValueError:
        raise DescriptionError(
            f"--push is {text!r}; force forward and to the left [N], duration and start [s] are accepted: "
            "60,0,0.1@3.2"
        ) from None
    return Push(forward, left, duration, at)


def controllers(args: argparse.Namespace) -> list[str]:
    """The controllers of the command line by name.

    Raises:
        DescriptionError: None is named.
    """
    from exo_pin.control import CONTROLLERS

    return _named(args.controller, CONTROLLERS, "--controller")


def patients(args: argparse.Namespace) -> list[str | None]:
    """The patients of the command line by name; None is nobody.

    Raises:
        DescriptionError: None is named.
    """
    from exo_pin.control import PATIENTS

    return [None if name.lower() == NOBODY else name for name in _named(args.patient, PATIENTS, "--patient")]


def _named(text: str, known: Mapping[str, object], option: str) -> list[str]:
    found: Iterable[str] = known if text.lower() == ALL else measures.listed([text])
    names = list(dict.fromkeys(found))
    if not names:
        raise DescriptionError(f"{option} is empty; {', '.join(known)}, a file or {ALL} is accepted")
    return names

"""`exo-pin devices`: the known exoskeletons and planar models, or one of them in full."""

from __future__ import annotations

import argparse
import math
import sys
from typing import Any

from exo_pin.cli import show
from exo_pin.devices import DEVICES, Actuator, Device, find, movement_of
from exo_pin.errors import ExoPinError
from exo_pin.plugins import plugin_names

_EXAMPLES = """examples:
  exo-pin devices                    all of them
  exo-pin devices lokomat            its joints, actuators, sources and remarks
  exo-pin devices mine.toml          a device of your own (docs/devices.md says how to write one)
  exo-pin urdf device:=lokomat -o lokomat.urdf"""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("device", nargs="?", metavar="DEVICE", help="a name or a device file (.toml)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    """Print the list, or one device."""
    chosen = _all() if args.device is None else [find(args.device)]
    if args.json:
        show.as_json({device.name: _to_json(device) for device in chosen})
    elif args.device is None:
        _print_all(chosen)
    else:
        _print_one(chosen[0])
    return 0


def _all() -> list[Device]:
    """The devices of this package and those of others; one that cannot be loaded is a note."""
    found = list(DEVICES.values())
    for name in plugin_names("exo_pin.devices"):
        try:
            found.append(find(name))
        except ExoPinError as error:
            print(f"note: {show.plain(str(error))}", file=sys.stderr)
    return list({device.name: device for device in found}.values())


def _to_json(device: Device) -> dict[str, Any]:
    """A device as plain values for JSON."""
    return {
        "title": device.title,
        "motors": device.motors,
        "joints": device.joints,
        "passive": device.passive,
        "locked": device.locked,
        "added": device.added,
        "pelvis": device.pelvis,
        "actuators": {name: _limits(actuator) for name, actuator in device.actuators.items()},
        "treadmill_m_s": device.treadmill,
        "statures_m": device.statures,
        "masses_kg": device.masses,
        "thighs_m": device.thighs,
        "shanks_m": device.shanks,
        "hip_breadths_m": device.hip_breadths,
        "ranges": {m: list(pair) for m, pair in device.ranges.items() if m in device.actuators},
        "source": device.source,
        "remarks": device.remarks,
    }


def _limits(actuator: Actuator) -> dict[str, float | None]:
    """Effort, speed and acceleration; None: no limit."""
    return {name: value if math.isfinite(value) else None for name, value in actuator._asdict().items()}


def _movements(joints: tuple[str, ...]) -> str:
    """Joints in a few words: `hip_flexion, knee_flexion`, a side named only where the other lacks it."""
    names = []
    for joint in joints:
        movement = movement_of(joint)
        paired = sum(movement_of(other) == movement for other in joints) == 2
        names.append(movement if paired else joint)
    return ", ".join(dict.fromkeys(names)) or "-"


def _print_all(chosen: list[Device]) -> None:
    rows = [[d.name, str(d.motors), _driven(d), _pelvis(d)] for d in chosen]
    show.table("Devices", ["name", "motors", "driven, each leg", "pelvis"], rows)


def _driven(device: Device) -> str:
    toes = ", toe_dorsiflexion" if device.toes else ""
    return (_movements(device.joints) if device.locked else "all six") + toes


def _pelvis(device: Device) -> str:
    if isinstance(device.pelvis, str):
        return {"held": "held", "free": "with the person"}[device.pelvis]
    return "slides " + ", ".join(name.removeprefix("pelvis_") for name in device.pelvis)


def _print_one(device: Device) -> None:
    lines = {
        "driven": _movements(device.joints),
        "passive": _movements(device.passive),
        "locked": _movements(tuple(j for j in device.locked if j not in device.passive)),
        "pelvis": _pelvis(device),
        "toes": "driven" if device.toes else "-",
        "treadmill": _span(device.treadmill, 3.6, "km/h"),
        "statures": _span(device.statures, 1.0, "m"),
        "masses": _span(device.masses, 1.0, "kg"),
        "thighs": _span(device.thighs, 1.0, "m"),
        "shanks": _span(device.shanks, 1.0, "m"),
        "hip breadths": _span(device.hip_breadths, 1.0, "m"),
    }
    show.table(f"{device.name}: {device.title or device.name}", ["", ""], [list(x) for x in lines.items()])
    rows = [_row(device, joint) for joint in dict.fromkeys(map(movement_of, (*device.joints, *device.added)))]
    show.table("Actuators", ["movement", "effort", "speed", "range"], rows)
    for line in (device.source, *device.remarks):
        print(line)


def _span(pair: tuple[float, float] | None, scale: float, unit: str) -> str:
    return "-" if pair is None else f"{scale * pair[0]:g} .. {scale * pair[1]:g} {unit}"


def _row(device: Device, movement: str) -> list[str]:
    actuator = device.actuators[movement]
    slide = movement.startswith("pelvis_")
    force, speed = ("N", "m/s") if slide else ("N m", "rad/s")
    effort = f"{actuator.effort:g} {force}" if actuator.effort else "no motor"
    return [movement, effort, f"{actuator.velocity:g} {speed}", _range(device, movement, slide=slide)]


def _range(device: Device, movement: str, *, slide: bool) -> str:
    if movement not in device.ranges:
        return "the body's"
    pair = device.ranges[movement]
    lower, upper = pair if slide else tuple(math.degrees(x) for x in pair)
    return f"{lower:g} .. {upper:g} m" if slide else f"{lower:.0f} .. {upper:.0f} deg"

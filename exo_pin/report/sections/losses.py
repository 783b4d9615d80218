"""Losses of each device: feet, steps, joints, centre of mass, other speeds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.arrays import Array
from exo_pin.compare import PHASES, Comparison, Loss
from exo_pin.demand import RangeDemand
from exo_pin.devices import SLIDES, movement_of
from exo_pin.gait.phases import division
from exo_pin.report.document.blocks import Block, Figure, Paragraph, Section, Table
from exo_pin.report.draw import device_drawings as drawn
from exo_pin.report.draw.heat import heat

_DEGREE = float(np.degrees(1.0))


def feet(compared: Comparison) -> Section:
    """Errors of position and orientation: curves, rms and largest, by phase."""
    rows = [[loss.device.name, *_foot_errors(loss)] for loss in compared.best]
    columns = (
        "device",
        "sole rms mm",
        "sole max mm",
        "foot rms mm",
        "foot max mm",
        "foot rms deg",
        "foot max deg",
    )
    blocks: list[Block] = [
        Figure(drawn.errors(compared), drawn.COINCIDENT_NOTE, columns=2),
        Table(columns, rows, "Errors of the feet, both feet over the whole walk"),
    ]
    if compared.walk.gait.events:
        blocks.append(_phases(compared))
    return Section("Feet: position and orientation", tuple(blocks))


def _foot_errors(loss: Loss) -> list[str]:
    """Root mean square and largest error of soles [mm], foot positions [mm] and orientations [deg]."""
    spreads = ((loss.sole_spread, 1e3), (loss.position_spread, 1e3), (loss.rotation_spread, _DEGREE))
    return [_fixed(scale * value) for spread, scale in spreads for value in spread]


def _phases(compared: Comparison) -> Figure:
    """Errors of sole, foot's position and foot's orientation by phase of the cycle."""
    kinds: tuple[tuple[str, str, float, Callable[[Loss], Array]], ...] = (
        ("sole_error_by_phase_mm", "Sole error, rms [mm]", 1e3, lambda loss: loss.sole_error),
        (
            "position_error_by_phase_mm",
            "Foot, error of position, rms [mm]",
            1e3,
            lambda loss: loss.position_error,
        ),
        (
            "rotation_error_by_phase_deg",
            "Foot, error of orientation, rms [deg]",
            _DEGREE,
            lambda loss: loss.rotation_error,
        ),
    )
    drawings = []
    for name, title, scale, error in kinds:
        cells = {
            loss.device.name: [scale * x for x in loss.in_phases(error(loss)).values()]
            for loss in compared.best
        }
        drawings.append(heat(name, title, [phase.replace("pre-", "pre- ") for phase in PHASES], cells))
    caption = (
        "By phase of the foot's own cycle: Perry's parts (1992) of stance and swing, "
        f"{division(compared.walk.gait)}."
    )
    return Figure(tuple(drawings), caption, columns=2)


def steps(compared: Comparison) -> Section:
    """Step width and clearance, recorded and the device's."""
    if not compared.walk.gait.events:
        words = "The walk has no heel strikes and toe-offs, so its steps are unknown."
        return Section("Step width and clearance", (Paragraph(words),))
    first = compared.best[0]
    width = 1e3 * first.step_width + 1e3 * first.step_width_lost
    clearance = 1e3 * first.clearance + 1e3 * first.clearance_lost
    rows = [["recorded", _fixed(width), "", _fixed(clearance), ""]]
    for loss in compared.best:
        values = (loss.step_width, loss.step_width_lost, loss.clearance, loss.clearance_lost)
        rows.append([loss.device.name, *(_fixed(1e3 * value) for value in values)])
    columns = ("device", "step width mm", "lost mm", "clearance mm", "lost mm")
    note = (
        "Step width: sideways distance of the feet at heel strikes. Clearance: least height of the swinging "
        "sole over the standing one in mid swing."
    )
    return Section("Step width and clearance", (Table(columns, rows), Paragraph(note, "note")))


def joints(compared: Comparison) -> Section:
    """Curves, ranges used and changes of angles."""
    same = (
        ""
        if compared.conditions.pelvis == "recorded"
        else (
            " On its own pelvis a device's hips take over what the recorded pelvis turned, so they differ "
            "from the recorded hips without losing anything."
        )
    )
    caption = (
        f"Black: the recorded walk. A joint that a device locks is not drawn.{same} {drawn.COINCIDENT_NOTE}"
    )
    ranges = Table(
        ("device", *(m.replace("_", " ") for m in MOVEMENTS), "hip change", "knee change"),
        [[loss.device.name, *_used(loss)] for loss in compared.best],
        "Ranges used, both legs; largest change of flexion from the required angle [deg]",
    )
    slides = [[loss.device.name, *cells] for loss in compared.best if any(cells := _slid(loss))]
    names = (name.replace("_", " ") for name in SLIDES)
    moved = (Table(("device", *names), slides, "Slides used [mm]"),) if slides else ()
    note = Paragraph("*: at a limit in some sample.", "note")
    figures = [Figure(drawn.joints(compared, side), caption if side == SIDES[-1] else "") for side in SIDES]
    return Section("Joints", (*figures, ranges, *moved, note))


def _used(loss: Loss) -> list[str]:
    """What a device uses of each movement's range, and how far hip and knee are from the required angles."""
    cells = []
    for movement in MOVEMENTS:
        mine = [found for joint, found in loss.ranges.items() if movement_of(joint) == movement]
        cells.append(_span(mine, _DEGREE) if mine else "locked")
    changes = [f"{np.degrees(change):.1f}" for change in loss.angle_change.values()]
    return [*cells, *changes]


def _slid(loss: Loss) -> list[str]:
    """What a device uses of each slide of the pelvis; empty where it has none."""
    return [_span([loss.ranges[slide]], 1e3) if slide in loss.ranges else "" for slide in SLIDES]


def _span(found: Sequence[RangeDemand], scale: float) -> str:
    low, high = min(demand.lowest for demand in found), max(demand.highest for demand in found)
    mark = "*" if any(demand.samples_at_limit for demand in found) else ""
    return f"{round(scale * low) + 0} .. {round(scale * high) + 0}{mark}"


def centre_of_mass(compared: Comparison) -> Section:
    """The path of the centre of mass."""
    caption = (
        "Black: the recorded walk, about its even travel. Device and wearer; a slide can trade motion with "
        f"the hips at little gain for the feet, so a path may wander. {drawn.COINCIDENT_NOTE}"
    )
    return Section("Centre of mass", (Figure(drawn.centre_of_mass(compared), caption),))


def speeds(speeds: Mapping[str, Comparison]) -> Section:
    """Sole error of the same devices under other walks, by name."""
    found = {
        (walk, loss.device.name): 1e3 * loss.rms for walk, other in speeds.items() for loss in other.best
    }
    devices = list(dict.fromkeys(device for _, device in found))
    cells = {device: [found[walk, device] for walk in speeds] for device in devices}
    drawing = heat(
        "speeds",
        "Sole error of the best motion, rms [mm]",
        [w.replace("_", " ") for w in speeds],
        cells,
        width=760,
    )
    caption = "The same body and conditions under the normal walk (Schwartz 2008) at its speeds."
    return Section("At the five speeds", (Figure((drawing,), caption, columns=1),))


def _fixed(value: float) -> str:
    """One decimal, no minus before a zero; `-` for NaN."""
    return "-" if np.isnan(value) else f"{round(value, 1) + 0.0:.1f}"

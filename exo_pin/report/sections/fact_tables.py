"""Tables of facts: body, device, spatiotemporal numbers, choices of the report."""

from __future__ import annotations

import math
from collections.abc import Mapping

from exo_pin.anatomy.body import Leg
from exo_pin.clinic import NormalBand
from exo_pin.errors import DescriptionError
from exo_pin.gait import Gait
from exo_pin.kinematics import WalkNumbers
from exo_pin.report.document.blocks import Block, Paragraph, Section, Table
from exo_pin.robot import Robot
from exo_pin.version import __version__


def body(robot: Robot) -> Section:
    """Sizes and masses, left and right.

    Raises:
        DescriptionError: The robot was not made for a body.
    """
    b = robot.body
    if b is None:
        raise DescriptionError("a report needs a robot that load_robot made for a Body")
    left, right = b.legs
    legs = [
        [name.replace("_", " "), f"{value:.3f}", f"{other:.3f}", _unit(name)]
        for name, value, other in zip(Leg._fields, left, right, strict=True)
    ]
    whole = [
        ["stature", f"{b.stature:.3f}", "m"],
        ["mass of the person", f"{b.mass:.1f}", "kg"],
        ["segment masses after", b.sex, "-"],
        ["hip joint centres apart", f"{b.hip_width:.3f}", "m"],
        ["waist ring, inner width", f"{b.waist_width:.3f}", "m"],
        ["mass of the device", f"{b.hardware_mass:.1f}", "kg"],
        ["mass in the model", f"{b.total_mass:.1f} ({'with' if b.wearer else 'without'} wearer)", "kg"],
    ]
    note = (
        "Lengths that were not given follow from the stature (Drillis and Contini 1966), masses and inertias "
        "from de Leva 1996; ankle height, foot breadth, heel and ball are design defaults, the waist follows "
        "stature and mass."
    )
    tables: tuple[Block, ...] = (
        Table(("body", "value", "unit"), whole),
        Table(("leg", "left", "right", "unit"), legs),
        Paragraph(note, "note"),
    )
    return Section("Body", tables)


def _unit(name: str) -> str:
    return "kg" if name.endswith("mass") else "m"


def device(robot: Robot) -> Section:
    """What the device is and drives, and the source of its numbers."""
    made = robot.device
    rows = [["name", robot.name], ["joints that move", str(len(robot.joints))]]
    rows += [] if made is None else [["motors", str(made.motors)]]
    rows.append(["hip axes, from the pelvis outwards", robot.hip_order])
    if made is not None:
        rows += [["title", made.title or made.name], ["source", made.source]]
        rows += [["locked joints", ", ".join(made.locked) or "none"]]
        rows += [["remark", remark] for remark in made.remarks]
    return Section("Device", (Table(("device", ""), rows, prose=True),))


def numbers(found: WalkNumbers) -> Section:
    """Cadence, speed, lengths and phases against published ranges.

    Args:
        found: Of the walk.
    """
    title = "Spatiotemporal numbers"
    if found.missing:
        return Section(title, (Paragraph(f"None: {found.missing}."),))
    rows = []
    for name, number in found.numbers.items():
        usual = found.usual.get(name)
        span = "-" if usual is None else f"{usual.low:.3g} .. {usual.high:.3g} ({usual.source})"
        sd = "-" if math.isnan(number.sd) else f"{number.sd:.3f}"
        shown = f"{number.mean:.3f}" if number.unit in ("m", "s", "m/s") else f"{number.mean:.1f}"
        row = [name.replace("_", " "), shown, sd, str(number.n), number.unit, span]
        rows.append([*row, found.verdicts.get(name, "-")])
    columns = ("number", "mean", "sd", "n", "unit", "usual", "this walk")
    cited = "; ".join(f"{key}: {text}" for key, text in sorted(found.citations.items()))
    run = f"A run: both feet are in the air between contacts. {found.unknown}".strip()
    manner = [Paragraph(run, "note")] if found.manner == "run" else []
    places = ", ".join(dict.fromkeys(found.measured.values()))
    note = f"Lengths are measured at: {places}. Usual ranges: {cited or 'none'}."
    if found.estimate:
        manner.append(Paragraph(f"Estimate: {found.estimate}.", "note"))
    left = (f"{x.side} {x.start:.2f} .. {x.end:.2f} s, {x.why}" for x in found.left_out)
    gone = [Paragraph(f"Left out: {'; '.join(left)}.", "note")] if found.left_out else []
    return Section(title, (Table(columns, rows), *manner, *gone, Paragraph(note, "note screen")))


def choices(
    robot: Robot,
    gait: Gait,
    chosen: Mapping[str, str],
    rates: str,
    band: NormalBand | None,
) -> Section:
    """Everything that was chosen, so that the report can be made again.

    Args:
        robot: The device on a body.
        gait: The walk.
        chosen: Further choices, by name.
        rates: How velocities and accelerations were made.
        band: Normal walks; None: no band.
    """
    sources = sorted({event.source or "not stated" for event in gait.events})
    rows = [
        ["source of the walk", gait.source or "not stated"],
        *(["remark on its file", remark] for remark in gait.remarks),
        ["events", ", ".join(sources) or "none"],
        ["pelvis", "moves as the walk says" if gait.base is not None else "held still"],
        ["velocities and accelerations", rates],
        ["normal band", "none" if band is None else f"{band.name}: {band.population}, 1 standard deviation"],
        ["hip angles", f"{robot.hip_order} order of axes; curves in the clinical order"],
        *([name, words] for name, words in chosen.items()),
        ["made with", f"exo_pin {__version__}"],
    ]
    return Section("Choices", (Table(("choice", ""), rows, prose=True),))

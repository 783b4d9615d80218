"""Clinical curves over the cycle with their normal band, and the movement map of the Gait Profile Score."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES
from exo_pin.anatomy.names import CLINICAL_ANGLES, ClinicalAngle, Side
from exo_pin.clinic import NINE, ClinicalCycles, GaitProfile, NormalBand
from exo_pin.clinic.clinical_cycles import PERCENT
from exo_pin.clinic.gait_profile import CITATION
from exo_pin.report.document.blocks import Block, Figure, Paragraph, Section, Table
from exo_pin.report.draw import svg
from exo_pin.report.draw.band_layers import MOST_LINES, normal_layers
from exo_pin.report.draw.chart import Band, Chart, Curve, Moment, draw, key
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.draw.movement_map import movement_map

CURVE_TITLES: dict[ClinicalAngle, str] = {
    "pelvis_tilt": "Pelvis tilt, forward + [deg]",
    "pelvis_obliquity": "Pelvis obliquity, up + [deg]",
    "pelvis_rotation": "Pelvis rotation, forward + [deg]",
    "hip_flexion": "Hip flexion [deg]",
    "hip_adduction": "Hip adduction [deg]",
    "hip_rotation": "Hip internal rotation [deg]",
    "knee_flexion": "Knee flexion [deg]",
    "knee_adduction": "Knee adduction (varus) [deg]",
    "knee_rotation": "Knee internal rotation [deg]",
    "ankle_dorsiflexion": "Ankle dorsiflexion [deg]",
    "ankle_inversion": "Ankle inversion [deg]",
    "foot_progression": "Foot progression, toe-in + [deg]",
}
OTHERS = tuple(angle for angle in CLINICAL_ANGLES if angle not in MOVEMENTS)
"""What the six movements of a leg leave: pelvis, the knee's other planes, foot progression."""

_LEAST = 20.0  # [deg] smallest extent of an angle's axis
_SIZE = (280.0, 165.0)  # [px] three beside each other on A4


def beside_the_joints(sides: Sequence[ClinicalCycles], band: NormalBand | None) -> Section:
    """Pelvis, foot progression and the knee's other planes of both sides.

    Args:
        sides: The cycles of each side.
        band: Normal walks; None: no band.
    """
    title = "Pelvis, knee and foot progression"
    charts = {angle: chart(angle, sides, band) for angle in OTHERS if any(angle in x.curves for x in sides)}
    if not charts:
        why = "The pelvis's motion is not recorded." if sides else "No foot has a whole cycle."
        return Section(title, (Paragraph(f"{why} No curves of pelvis and foot progression."),), "sheet")
    drawings = tuple(
        Drawing(f"curve_{angle}", CURVE_TITLES[angle], draw(made)) for angle, made in charts.items()
    )
    legend = Drawing("curve_key_pelvis", "Key of the curves", key(list(charts.values())))
    return Section(title, (Figure(drawings, _sources(sides)), Figure((legend,), columns=1)), "sheet")


def _sources(sides: Sequence[ClinicalCycles]) -> str:
    """Where the angles come from, in sentences."""
    named: dict[str, list[str]] = {}
    for side in sides:
        for angle in OTHERS:
            if angle in side.sources:
                named.setdefault(side.sources[angle], []).append(angle.replace("_", " "))
    words = "; ".join(f"{', '.join(dict.fromkeys(names))}: {source}" for source, names in named.items())
    model = " A model's knee and ankle do not turn about the shank: its foot may be several degrees off."
    return f"{words}.{model if 'model' in words else ''}"


def chart(
    angle: ClinicalAngle, sides: Sequence[ClinicalCycles], band: NormalBand | None, *, name: str = ""
) -> Chart:
    """One angle of both sides: every cycle a thin line, their mean, toe-off, the band.

    Args:
        angle: Which.
        sides: The cycles of each side.
        band: Normal walks; None: no band.
        name: What the walk is called where several are drawn.
    """
    (bands, curves), moments = normal_layers(band, angle), list[Moment]()
    for side in (side for side in sides if angle in side.curves):
        colour = svg.SIDE_COLOURS[side.side]
        if 1 < len(side) <= MOST_LINES:
            label = "single cycles"
            curves += [
                Curve(PERCENT, np.degrees(q), colour, label, None, 0.6, 0.5) for q in side.curves[angle]
            ]
        elif len(side) > MOST_LINES:
            sd = np.degrees(side.curves[angle].std(axis=0, ddof=1))
            middle = np.degrees(side.mean(angle))
            bands.append(Band(PERCENT, middle - sd, middle + sd, colour, "±1 sd of the cycles"))
        curves.append(Curve(PERCENT, np.degrees(side.mean(angle)), colour, f"{side.side}{name}", None, 1.9))
        if np.isfinite(side.toe_off).any():
            moments.append(Moment(float(np.nanmean(side.toe_off)), colour, f"{side.side} toe-off"))
    return Chart(
        title=CURVE_TITLES[angle],
        x_label="% of the side's gait cycle",
        curves=tuple(curves),
        bands=tuple(bands),
        moments=tuple(moments),
        x_range=(0, 100),
        least=_LEAST,
        legend=False,
        width=_SIZE[0],
        height=_SIZE[1],
    )


def profile(found: GaitProfile) -> Section:
    """The Gait Profile Score: movement map, left against right, and what it is compared with."""
    title = "Gait Profile Score"
    if not found.variables:
        return Section(title, (Paragraph("None: no foot has a whole cycle."),))
    rows = [
        [side, *(degrees(found.variables.get((side, angle), math.nan)) for angle in NINE), score(found, side)]
        for side in SIDES
    ]
    rows.append(
        ["left - right", *(_difference(found, angle) for angle in NINE), _apart(*found.sides.values())]
    )
    words = [
        f"Overall (fifteen variables): {degrees(found.overall)} deg. Root mean square difference from the "
        f"mean of {found.band.population}; by the mean of each side's cycles, ± standard deviation from "
        f"cycle to cycle where there are several. 0 is the normal mean; dashes: a walk that is one standard "
        f"deviation off everywhere. {CITATION}."
    ]
    if found.missing:
        names = ", ".join(angle.replace("_", " ") for angle in found.missing)
        words.append(f"The score takes nine variables of both sides; not known here: {names}.")
    blocks: tuple[Block, ...] = (
        Figure((movement_map(found),), columns=1),
        Table(("score deg", *(angle.replace("_", " ") for angle in NINE), "GPS"), rows),
        *(Paragraph(sentence, "note") for sentence in words),
    )
    return Section(title, blocks)


def score(found: GaitProfile, side: Side) -> str:
    """A side's score in degrees, with its spread where it has one."""
    value, spread = found.sides[side], found.spread[side]
    return degrees(value) + ("" if math.isnan(spread) else f" ± {degrees(spread)}")


def degrees(angle: float) -> str:
    """One decimal; `-` where it is not known."""
    return "-" if math.isnan(angle) else f"{np.degrees(angle):.1f}"


def _difference(found: GaitProfile, angle: ClinicalAngle) -> str:
    return _apart(*(found.variables.get((side, angle), math.nan) for side in SIDES))


def _apart(left: float, right: float) -> str:
    apart = np.degrees(left - right)
    return "-" if math.isnan(apart) else f"{round(float(apart), 1) + 0.0:+.1f}"

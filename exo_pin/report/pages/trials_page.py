"""Several trials on a page: curves over each other and numbers side by side, or a folder as an index."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import CLINICAL_ANGLES, ClinicalAngle, Side
from exo_pin.clinic import NINE, NormalBand, Trial, change
from exo_pin.clinic.gait_profile import CITATION
from exo_pin.gait import Number
from exo_pin.report.document.blocks import Document, Figure, Paragraph, Section, Table
from exo_pin.report.draw.band_layers import normal_layers
from exo_pin.report.draw.chart import Chart, Curve, draw, key
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.draw.palette import LineStyle, line_styles
from exo_pin.report.draw.trial_bars import Panel, trial_bars
from exo_pin.report.sections.angles import band_words
from exo_pin.report.sections.clinical import CURVE_TITLES, chart, degrees

_HEADS = (
    "trial",
    "person",
    "cycles",
    "speed m/s",
    "cadence /min",
    "step L m",
    "step R m",
    "GPS L",
    "GPS R",
    "GPS deg",
)
_SIZE = (250.0, 150.0)  # [px] four beside each other on A4


def trials(
    found: Sequence[Trial], band: NormalBand | None, *, title: str = "Trials compared", when: str = ""
) -> Document:
    """Two or more trials: numbers side by side with their differences, curves over each other.

    Args:
        found: The trials; differences are those from the first.
        band: Normal walks; None: no band.
        title: Heading.
        when: The moment of the run.
    """
    named = _distinct(found)
    sections = [_numbers(named), *([] if band is None else [_scores(named, band)]), _curves(named, band)]
    return Document(title, _under(named, when), tuple(sections), f"{title}, {when}".strip(", "))


def folder(
    found: Sequence[Trial],
    failures: Mapping[str, str],
    band: NormalBand | None,
    *,
    title: str = "Trials",
    when: str = "",
) -> Document:
    """An index of trials: a row for each, bars against normal walks, and what could not be read.

    Args:
        found: The trials.
        failures: Name of a file -> why it is no walk.
        band: Normal walks; None: no scores.
        title: Heading.
        when: The moment of the run.
    """
    rows = [_row(trial) for trial in found]
    panels = [_panel(found, "speed", "speed [m/s]"), _panel(found, "cadence", "cadence [steps/min]")]
    panels += [_panel(found, f"{side}_step_length", f"{side} step [m]") for side in SIDES]
    if band is not None:
        panels.append(_scores_panel(found, band))
    caption = (
        "Grey: usual ranges of healthy walks for the person's size (docs/report.md cites them); of the Gait "
        "Profile Score up to that of a walk that is one standard deviation off everywhere. Red: outside."
    )
    figure = Figure((trial_bars([trial.name for trial in found], panels),), caption, columns=1)
    sections = [Section("Trials", (Table(_HEADS, rows), figure))]
    lost = dict(failures) | {trial.name: trial.numbers.missing for trial in found if trial.numbers.missing}
    if lost:
        table = Table(("file", "why it has no numbers"), [list(x) for x in lost.items()], prose=True)
        sections.append(Section("Left out", (table,)))
    note = (
        f"Scores against {band.population}. {CITATION}." if band is not None else "No normal band: no scores."
    )
    sections.append(Section("Sources", (Paragraph(note, "note"),)))
    return Document(title, "; ".join(filter(None, (f"{len(found)} trials", when))), tuple(sections), title)


def _scores_panel(found: Sequence[Trial], band: NormalBand) -> Panel:
    """Profile scores, and that of a walk that is one standard deviation off everywhere."""
    off = np.sqrt(np.mean([np.mean(band.curves[x].sd ** 2) for x in NINE if x in band.curves]))
    scores = [math.nan if trial.profile is None else trial.profile.overall for trial in found]
    usual = (0.0, float(np.degrees(off)))
    known = [None if math.isnan(score) else float(np.degrees(score)) for score in scores]
    return Panel("GPS [deg]", known, [usual] * len(found))


def _distinct(found: Sequence[Trial]) -> list[Trial]:
    """The trials under names of their own."""
    names = [trial.name for trial in found]
    twice = {name for name in names if names.count(name) > 1}
    return [
        replace(trial, name=f"{trial.name} ({k + 1})") if trial.name in twice else trial
        for k, trial in enumerate(found)
    ]


def _under(found: Sequence[Trial], when: str) -> str:
    people = dict.fromkeys(filter(None, (trial.session.get("person", "") for trial in found)))
    return "; ".join(filter(None, (" / ".join(t.name for t in found), ", ".join(people), when)))


def _numbers(found: Sequence[Trial]) -> Section:
    """Spatiotemporal numbers side by side; differences from the first trial and their spread."""
    first, *others = found
    names = [name for name in first.numbers.numbers if all(name in t.numbers.numbers for t in others)]
    heads = ["number", "unit", *(trial.name for trial in found)]
    heads += [f"{word} {t.name}" for t in others for word in ("difference", "in spreads")]
    rows = []
    for name in names:
        numbers = [trial.numbers.numbers[name] for trial in found]
        row = [name.replace("_", " "), numbers[0].unit, *(_value(x.mean, x.sd) for x in numbers)]
        for number in numbers[1:]:
            apart = change(numbers[0], number)
            far = "-" if math.isnan(apart.in_spreads) else f"{apart.in_spreads:+.1f}"
            row += [f"{apart.value:+.3g}", far]
        rows.append(row)
    note = (
        "Mean ± standard deviation from cycle to cycle. Difference: from the first trial. In spreads: the "
        "difference over the root mean square of both standard deviations; below about 2 it is no more than "
        "steps differ from each other."
    )
    missing = [f"{t.name}: {t.numbers.missing}." for t in found if t.numbers.missing]
    return Section(
        "Numbers side by side",
        (Table(heads, rows), Paragraph(note, "note"), *(Paragraph(words) for words in missing)),
    )


def _value(mean: float, sd: float) -> str:
    return f"{mean:.3g}" + ("" if math.isnan(sd) else f" ± {sd if sd > 1e-9 else 0.0:.2g}")


def _scores(found: Sequence[Trial], band: NormalBand) -> Section:
    """Profile and variable scores side by side."""
    heads = ["score deg", *(f"{trial.name} {side}" for trial in found for side in SIDES)]
    rows = [
        [angle.replace("_", " "), *(_score(trial, side, angle) for trial in found for side in SIDES)]
        for angle in NINE
    ]
    rows.append(["Gait Profile Score", *(_side_score(trial, side) for trial in found for side in SIDES)])
    overall = "; ".join(f"{t.name} {degrees(t.profile.overall)} deg" for t in found if t.profile is not None)
    note = f"Overall: {overall}. Against {band.population}. {CITATION}."
    return Section("Gait Profile Score", (Table(heads, rows), Paragraph(note, "note")))


def _score(trial: Trial, side: Side, angle: ClinicalAngle) -> str:
    scores = {} if trial.profile is None else trial.profile.variables
    return degrees(scores.get((side, angle), math.nan))


def _side_score(trial: Trial, side: Side) -> str:
    return "-" if trial.profile is None else degrees(trial.profile.sides[side])


def _curves(found: Sequence[Trial], band: NormalBand | None) -> Section:
    """Every angle, left and right apart, the trials in their own colours."""
    styles = line_styles(trial.name for trial in found)
    made: list[tuple[str, Chart]] = []
    for angle in CLINICAL_ANGLES:
        if any(angle in side.curves for trial in found for side in trial.sides):
            made += [(f"{side}_{angle}", _over(found, angle, side, band, styles)) for side in SIDES]
    if not made:
        return Section("Curves over each other", (Paragraph("No trial has a whole cycle: no curves."),))
    drawings = tuple(Drawing(f"trials_{name}", chart.title, draw(chart)) for name, chart in made)
    legend = Drawing("trials_key", "Key of the curves", key([chart for _, chart in made]))
    caption = f"Thin lines: single cycles. Angles as given, not filtered.{band_words(band)}"
    blocks = (Figure((legend,), columns=1), Figure(drawings, caption, columns=4))
    return Section("Curves over each other", blocks, "sheet")


def _over(
    found: Sequence[Trial],
    angle: ClinicalAngle,
    side: Side,
    band: NormalBand | None,
    styles: Mapping[str, LineStyle],
) -> Chart:
    """One angle of one side of every trial."""
    bands, curves = normal_layers(band, angle)
    for trial in found:
        mine = [x for x in trial.sides if x.side == side]
        style = styles[trial.name]
        for curve in chart(angle, mine, None).curves:
            mean = curve.label == side
            label = trial.name if mean else ""
            curves.append(replace(curve, colour=style.colour, label=label, dash=style.dash if mean else None))
    title = CURVE_TITLES[angle].replace(" [deg]", "").replace(" (varus)", "")
    return Chart(
        title=f"{side.capitalize()} {title[0].lower()}{title[1:]}",
        x_label="% of the side's gait cycle",
        curves=tuple(curves) or (Curve([0.0], [0.0], "none"),),
        bands=tuple(bands),
        x_range=(0, 100),
        least=20.0,
        legend=False,
        width=_SIZE[0],
        height=_SIZE[1],
    )


def _row(trial: Trial) -> list[str]:
    numbers, profile = trial.numbers.numbers, trial.profile
    cells = [_mean(numbers, name, digits) for name, digits in _COLUMNS.items()]
    scores = ["-"] * 3
    if profile is not None:
        scores = [*(degrees(profile.sides[side]) for side in SIDES), degrees(profile.overall)]
    cycles = " + ".join(str(trial.numbers.cycles.get(side, 0)) for side in SIDES)
    return [trial.name, trial.session.get("person", "-"), cycles, *cells, *scores]


_COLUMNS = {"speed": 2, "cadence": 0, "left_step_length": 2, "right_step_length": 2}


def _mean(numbers: Mapping[str, Number], name: str, digits: int) -> str:
    number = numbers.get(name)
    return "-" if number is None else f"{number.mean:.{digits}f}"


def _panel(found: Sequence[Trial], name: str, title: str) -> Panel:
    numbers = [trial.numbers.numbers.get(name) for trial in found]
    usual = [trial.numbers.usual.get(name) for trial in found]
    return Panel(
        title,
        [None if x is None else x.mean for x in numbers],
        [None if x is None else (x.low, x.high) for x in usual],
    )

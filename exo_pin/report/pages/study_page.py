"""A study of devices: their losses against stature, speed and phase, and for every recording."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from exo_pin.anatomy.human import DEFAULT_STATURE
from exo_pin.anatomy.names import PelvisMotion
from exo_pin.arrays import Array
from exo_pin.gait import SPEEDS
from exo_pin.gait.phases import PHASES
from exo_pin.report.document.blocks import Block, Document, Figure, Paragraph, Section, Table, Tiles
from exo_pin.report.draw import palette
from exo_pin.report.draw.chart import Chart, draw
from exo_pin.report.draw.drawing import Drawing
from exo_pin.report.draw.heat import heat, strips
from exo_pin.study import Row, summary

_SAME = 0.01  # [mm] curves closer than this are drawn as one
_MOST = 40  # recordings in a table
_PELVIS: dict[PelvisMotion, str] = {
    "recorded": "the pelvis moves as recorded",
    "device": "the pelvis as the device holds it",
}


def study(rows: Sequence[Row], *, failures: Mapping[str, str] | None = None, when: str = "") -> Document:
    """The page of a study.

    Args:
        rows: Of the study, at least one.
        failures: Recordings that were left out, and why.
        when: The moment of the run, in words.
    """
    best = [row for row in rows if row.motion == "best"]
    normal = [row for row in best if row.gait in SPEEDS]
    recorded = [row for row in best if row.gait not in SPEEDS]
    sections = [_summary(rows, best, failures or {})]
    if len({row.stature_m for row in normal}) > 1:
        sections.append(_by_stature(normal))
    if normal:
        sections += [_by_speed(normal), _by_phase(normal), _feet(normal)]
    if recorded:
        sections.append(_recordings(recorded))
    if failures:
        sections.append(
            Section("Left out", (Table(("recording", "why"), list(failures.items()), prose=True),))
        )
    sections.append(_conditions(rows))
    under = f"{len({row.device for row in rows})} devices, {len(rows)} rows{'; ' if when else ''}{when}"
    return Document("What devices lose of walking: a study", under, tuple(sections))


def _summary(rows: Sequence[Row], best: Sequence[Row], failures: Mapping[str, str]) -> Section:
    statures = sorted({row.stature_m for row in rows})
    walks = len({(row.gait, row.stature_m) for row in rows})
    tiles = (
        ("devices", str(len({row.device for row in rows})), None),
        ("walks", str(walks), None),
        ("stature", " .. ".join(f"{x:.2f}" for x in dict.fromkeys((statures[0], statures[-1]))) + " m", None),
        ("rows of the table", str(len(rows)), None),
        ("recordings left out", str(len(failures)), not failures),
    )
    words = (
        "Each device makes the best motion it can towards the recorded feet: least squares over the corners "
        "of the soles, within the limits and speeds of its joints. The sole error is what is left."
    )
    table = Table(
        *summary(rows), "Sole error of the best motion, rms over a walk [mm]; mean and worst of all walks"
    )
    return Section("Summary", (Tiles(tiles), Paragraph(words), table))


def _by_stature(rows: Sequence[Row]) -> Section:
    speed = _usual_speed(rows)
    drawings = []
    for pelvis, mine in _pelvises(r for r in rows if r.gait == speed):
        x, series = _series(mine, lambda row: row.stature_m)
        title = f"Sole error, rms [mm]: {speed}, {_PELVIS[pelvis]}"
        drawings.append(_chart(f"stature_{pelvis}", title, "stature [m]", x, series, rows))
    caption = (
        "Lines that lie on each other are drawn once, under all their names. Bodies of the same proportions "
        "under the same angles are similar figures, so the errors grow with the stature in proportion, as "
        "long as no slide of a device comes to its end and no joint to its speed."
    )
    return Section("Against stature", (Figure(tuple(drawings), caption, columns=2),))


def _by_speed(rows: Sequence[Row]) -> Section:
    stature = _usual_stature(rows)
    speeds = [speed for speed in SPEEDS if any(row.gait == speed for row in rows)]
    charts, tables = [], []
    for pelvis, mine in _pelvises(row for row in rows if row.stature_m == stature):
        title = f"Sole error, rms [mm]: {stature:.2f} m, {_PELVIS[pelvis]}"
        if len(speeds) > 1:
            x, series = _series(mine, lambda row: 120 / row.duration_s)
            charts.append(_chart(f"speed_{pelvis}", title, "cadence [steps/min]", x, series, rows))
        cells = _cells(mine, speeds, lambda row: row.sole_rms_mm)
        tables.append(heat(f"speeds_{pelvis}", title, [s.replace("_", " ") for s in speeds], cells))
    blocks: list[Block] = [Figure(tuple(drawings), columns=2) for drawings in (charts, tables) if drawings]
    return Section("Against speed", tuple(blocks))


def _by_phase(rows: Sequence[Row]) -> Section:
    stature, speed = _usual_stature(rows), _usual_speed(rows)
    drawings = []
    for pelvis, mine in _pelvises(r for r in rows if (r.stature_m, r.gait) == (stature, speed)):
        found = {row.device: list(row.sole_rms_by_phase.values()) for row in mine}
        cells = {name: found[name] for name in _devices(mine)}
        title = f"Sole error, rms [mm]: {speed}, {stature:.2f} m, {_PELVIS[pelvis]}"
        drawings.append(heat(f"phases_{pelvis}", title, [p.replace("pre-", "pre- ") for p in PHASES], cells))
    caption = "Phases of the foot's own cycle (Perry 1992), from its heel strikes and toe-offs."
    return Section("By phase of the cycle", (Figure(tuple(drawings), caption, columns=2),))


def _feet(rows: Sequence[Row]) -> Section:
    stature = _usual_stature(rows)
    speeds = [speed for speed in SPEEDS if any(row.gait == speed for row in rows)]
    figures = []
    measures: tuple[tuple[str, str, Callable[[Row], float]], ...] = (
        ("step_width_lost_mm", "Step width lost [mm]", lambda row: row.step_width_lost_mm),
        ("clearance_lost_mm", "Clearance lost [mm]", lambda row: row.clearance_lost_mm),
    )
    for name, words, measure in measures:
        drawings = []
        for pelvis, mine in _pelvises(row for row in rows if row.stature_m == stature):
            cells = _cells(mine, speeds, measure)
            title = f"{words}: {stature:.2f} m, {_PELVIS[pelvis]}"
            drawings.append(heat(f"{name}_{pelvis}", title, [s.replace("_", " ") for s in speeds], cells))
        figures.append(Figure(tuple(drawings), columns=2))
    note = (
        "Recorded minus the device's: blue cells are negative, a wider step or a foot that is lifted higher."
    )
    return Section("Step width and clearance", (*figures, Paragraph(note, "note")))


def _recordings(rows: Sequence[Row]) -> Section:
    blocks: list[Block] = []
    for pelvis, mine in _pelvises(rows):
        devices, walks = _devices(mine), list(dict.fromkeys((row.gait, row.stature_m) for row in mine))
        found = {(row.gait, row.stature_m, row.device): row.sole_rms_mm for row in mine}
        cells = {
            f"{gait}, {stature:.2f} m": [found.get((gait, stature, name), np.nan) for name in devices]
            for gait, stature in walks
        }
        title = f"Sole error, rms [mm]: {_PELVIS[pelvis]}"
        if len(cells) > 2:
            spread = {name: [row.sole_rms_mm for row in mine if row.device == name] for name in devices}
            blocks.append(Figure((strips(f"spread_{pelvis}", title, spread, width=900),), columns=1))
        worst = sorted(cells, key=lambda name: -float(np.nanmax(cells[name])))[:_MOST]
        shown = {name: cells[name] for name in cells if name in worst}
        more = (
            f"The {_MOST} worst of {len(cells)}; the table of the study holds all."
            if len(cells) > _MOST
            else ""
        )
        blocks.append(
            Figure((heat(f"recordings_{pelvis}", title, devices, shown, width=900),), more, columns=1)
        )
    warnings = list(dict.fromkeys((row.gait, row.doubts) for row in rows if row.doubts))
    if warnings:
        blocks.append(Table(("recording", "reasons to doubt how it was read"), warnings, prose=True))
    return Section("Recordings", tuple(blocks))


def _conditions(rows: Sequence[Row]) -> Section:
    def listed(value: Callable[[Row], str]) -> str:
        return ", ".join(dict.fromkeys(map(value, rows)))

    pelvises = {row.pelvis for row in rows}

    facts = [
        [
            "pelvis",
            "; ".join(f"{name}: {words}" for name, words in _PELVIS.items() if name in pelvises),
        ],
        ["passive joints", listed(lambda row: row.passive)],
        ["sex (segment masses)", listed(lambda row: row.sex)],
        ["mass", f"{min(r.mass_kg for r in rows):.1f} .. {max(r.mass_kg for r in rows):.1f} kg"],
        ["made with", f"exo_pin {listed(lambda row: row.version)}"],
    ]
    sources = list(dict.fromkeys((row.gait, row.source) for row in rows))[:_MOST]
    return Section(
        "Conditions",
        (
            Table(("condition", ""), facts, prose=True),
            Table(("walk", "source"), sources, prose=True),
            Paragraph("The errors are those of the feet's pose alone; forces are not considered.", "note"),
        ),
    )


def _chart(
    name: str, title: str, x_label: str, x: Array, series: dict[str, Array], rows: Sequence[Row]
) -> Drawing:
    # by all rows, so that a device has the same style in all charts
    styles = palette.line_styles(dict.fromkeys(row.device for row in rows))
    curves = palette.curves(x, series, styles, same=_SAME)
    top = max(float(np.nanmax(values)) for values in series.values())
    chart = Chart(
        title=title, x_label=x_label, curves=curves, y_range=(0, 1.08 * max(top, 1.0)), width=520, height=270
    )
    return Drawing(name, title, draw(chart))


def _series(rows: Sequence[Row], place: Callable[[Row], float]) -> tuple[Array, dict[str, Array]]:
    """Where the rows lie, in order, and the sole errors there by device."""
    found = {(row.device, place(row)): row.sole_rms_mm for row in rows}
    x = sorted({at for _, at in found})
    series = {name: np.array([found.get((name, at), np.nan) for at in x]) for name in _devices(rows)}
    return np.array(x), series


def _pelvises(rows: Iterable[Row]) -> list[tuple[PelvisMotion, list[Row]]]:
    """The rows by who moves the pelvis."""
    found = list(rows)
    return [(name, mine) for name in _PELVIS if (mine := [row for row in found if row.pelvis == name])]


def _devices(rows: Sequence[Row]) -> list[str]:
    """By their mean error, the best first."""
    names = dict.fromkeys(row.device for row in rows)
    means = {name: np.mean([row.sole_rms_mm for row in rows if row.device == name]) for name in names}
    return sorted(names, key=lambda name: (round(float(means[name]), 6), name))


def _cells(
    rows: Sequence[Row], speeds: Sequence[str], measure: Callable[[Row], float]
) -> dict[str, list[float]]:
    """A measure by device and speed; NaN for a missing row."""
    found = {(row.device, row.gait): measure(row) for row in rows}
    return {name: [found.get((name, speed), np.nan) for speed in speeds] for name in _devices(rows)}


def _usual_stature(rows: Sequence[Row]) -> float:
    return min({row.stature_m for row in rows}, key=lambda stature: (abs(stature - DEFAULT_STATURE), stature))


def _usual_speed(rows: Sequence[Row]) -> str:
    speeds = [speed for speed in SPEEDS if any(row.gait == speed for row in rows)]
    return "free" if "free" in speeds else speeds[0]

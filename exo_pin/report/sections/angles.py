"""Joint angles over the gait cycle, with the normative band behind them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Movement, Side
from exo_pin.clinic import NormalBand
from exo_pin.gait import Gait, LegCycle, leg_cycles
from exo_pin.report.document.blocks import Figure, Paragraph, Section
from exo_pin.report.draw import svg, walk_charts
from exo_pin.report.draw.band_layers import MOST_LINES, normal_layers
from exo_pin.report.draw.chart import Band, Chart, Curve, Level, Span, draw, key
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot

BAND_REMARKS = (
    "mean and 1 standard deviation; ankle inversion: Oxford foot model. Its hip flexion is measured against "
    "a pelvis tilted forward by 10 to 18 deg, so compare shapes and ranges, and levels with care; hip "
    "rotation and ankle inversion are weak channels."
)
"""Of the published band."""

_WIDTH = 1.7  # [px] of a curve
_LEAST = 20.0  # [deg] smallest extent of an angle's axis
_SIZE = (280.0, 165.0)  # [px] three beside each other on A4


def curves(robot: Robot, gait: Gait, band: NormalBand | None, device: Gait | None = None) -> Section:
    """Six charts, both legs in each, every cycle a thin line.

    Args:
        robot: The device on a body.
        gait: The person's walk.
        band: Normal walks; None: no band.
        device: The device's motion, dashed; None: it is the person's.
    """
    found = leg_cycles(gait)
    if not found:
        words = (
            "The walk has no heel strikes of both feet, so it cannot be placed in a gait cycle: no curves."
        )
        return Section("Joint angles over the gait cycle", (Paragraph(words),))
    limits = {
        movement: (float(robot.lower[k]), float(robot.upper[k]))
        for movement in MOVEMENTS
        if (name := joint("left", movement)) in robot.joints
        for k in [robot.joints.index(name)]
    }
    made = joint_charts(found, band=band, limits=limits, dashed=() if device is None else leg_cycles(device))
    drawings = tuple(
        Drawing(f"curve_{movement}", x.title, draw(replace(x, legend=False, width=_SIZE[0], height=_SIZE[1])))
        for movement, x in zip(MOVEMENTS, made, strict=True)
    )
    legend = Drawing("curve_key", "Key of the curves", key(made))
    caption = "; ".join(leg.note for leg in found) + ". Angles of the walk as given, not filtered."
    caption += band_words(band)
    caption += "" if device is None else " Solid: the person; dashed: the device."
    blocks = (Figure(drawings, caption), Figure((legend,), columns=1))
    return Section("Joint angles over the gait cycle", blocks)


def band_words(band: NormalBand | None) -> str:
    """A sentence on the band, with its population; empty without one."""
    if band is None:
        return ""
    remarks = BAND_REMARKS if band.name.startswith("schwartz2008") else "mean and 1 standard deviation."
    return f" Grey band: {band.population}, {remarks}"


def charts(found: Sequence[LegCycle], *, band: NormalBand | None) -> tuple[Drawing, ...]:
    """Six charts over the cycle, both legs in each, with the normal band behind them.

    Args:
        found: The curves of each leg.
        band: Normal walks; None: no band.
    """
    titles = walk_charts.MOVEMENT_TITLES
    made = zip(MOVEMENTS, joint_charts(found, band=band), strict=True)
    return tuple(Drawing(f"curve_{movement}", titles[movement], draw(x)) for movement, x in made)


def joint_charts(
    found: Sequence[LegCycle],
    *,
    band: NormalBand | None = None,
    limits: Mapping[Movement, tuple[float, float]] | None = None,
    dashed: Sequence[LegCycle] = (),
    other: str = "device",
) -> list[Chart]:
    """A chart for each movement, in the order of `MOVEMENTS`.

    Args:
        found: The curves of each leg.
        band: Normal walks; None: no band.
        limits: By movement, the joint's range [rad].
        dashed: Curves to compare with, dashed.
        other: What those are called.
    """
    named = {f"{leg.side}, {other}": leg for leg in dashed}
    return [_joint(k, x, found, band, (limits or {}).get(x, ()), named) for k, x in enumerate(MOVEMENTS)]


def _joint(
    k: int,
    movement: Movement,
    found: Sequence[LegCycle],
    band: NormalBand | None,
    limits: Sequence[float],
    named: Mapping[str, LegCycle],
) -> Chart:
    """A movement of both legs, with its band, limits, and the curves to compare with dashed."""
    bands, curves = normal_layers(band, movement)
    for label, leg in named.items():
        curves.append(Curve(leg.percent, np.degrees(leg.q[:, k]), svg.SIDE_COLOURS[leg.side], label, "3 3"))
    same = len(found) > 1 and np.array_equal(found[0].percent, found[1].percent)
    same = same and np.allclose(found[0].q, found[1].q, atol=1e-3)
    spans: list[Span] = []
    for leg in found:
        q, colour = np.degrees(leg.q[:, k]), svg.SIDE_COLOURS[leg.side]
        each = (
            () if leg.each is None or not 1 < len(leg.each) <= MOST_LINES else np.degrees(leg.each[:, :, k])
        )
        curves += [Curve(leg.percent, one, colour, "single cycles", None, 0.6, 0.5) for one in each]
        if leg.sd is not None and not len(each):
            sd = np.degrees(leg.sd[:, k])
            bands.append(Band(leg.percent, q - sd, q + sd, colour, "±1 sd of the cycles"))
        over, width = _shown_twice(leg.side, dashes=not named) if same else (None, _WIDTH)
        curves.append(Curve(leg.percent, q, colour, leg.side, over, width))
        if np.isfinite(leg.stance):
            spans.append(Span(0, min(leg.stance, 100.0), colour, f"{leg.side} stance", SIDES.index(leg.side)))
    levels = [Level(float(np.degrees(x)), walk_charts.LIMIT_COLOUR, "joint limit") for x in limits]
    return Chart(
        title=walk_charts.MOVEMENT_TITLES[movement],
        x_label="% of the leg's gait cycle",
        curves=tuple(curves),
        bands=tuple(bands),
        spans=tuple(spans),
        levels=tuple(levels),
        x_range=(0, 100),
        least=_LEAST,
    )


def _shown_twice(side: Side, *, dashes: bool) -> tuple[str | None, float]:
    """Dash and width that show both of two equal curves: without dashes the left one is wider, behind."""
    if dashes:
        return ("6 6" if side == "right" else None), _WIDTH
    return None, (2.4 * _WIDTH if side == "left" else _WIDTH)

"""Joint angles over the gait cycle, with the normative band behind them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Movement, Side, Speed
from exo_pin.arrays import Array
from exo_pin.gait import Gait, LegCycle, leg_cycles, normative_gait, normative_sd
from exo_pin.report.document.blocks import Figure, Paragraph, Section
from exo_pin.report.draw import svg, walk_charts
from exo_pin.report.draw.chart import Band, Chart, Curve, Level, Span, draw
from exo_pin.report.draw.drawing import Drawing
from exo_pin.robot import Robot

NORMATIVE_BAND_SOURCE = (
    "Schwartz 2008, {speed}: mean and 1 standard deviation of 51 to 82 children a speed; ankle inversion: "
    "Oxford foot model. Its hip flexion is measured against a pelvis tilted forward by 10 to 18 deg, so "
    "compare shapes and ranges, and levels with care; hip rotation and ankle inversion are weak channels."
)
_WIDTH = 1.7  # [px] of a curve
_LEAST = 20.0  # [deg] smallest extent of an angle's axis


def curves(robot: Robot, gait: Gait, normal: Speed | None, person: Gait | None = None) -> Section:
    """Six charts, both legs in each.

    Args:
        robot: The device on a body.
        gait: The walk.
        normal: Speed of the normative band; None: no band.
        person: The person's walk, dashed beside the device's; None: not drawn.
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
    drawings = charts(found, speed=normal, limits=limits, person=() if person is None else leg_cycles(person))
    band = "" if normal is None else " Grey band: " + NORMATIVE_BAND_SOURCE.format(speed=normal)
    caption = "; ".join(leg.note for leg in found) + ". Angles of the walk as given, not filtered." + band
    caption += "" if person is None else " Solid: the device; dashed: the person."
    return Section("Joint angles over the gait cycle", (Figure(drawings, caption),))


def charts(
    found: Sequence[LegCycle],
    *,
    speed: Speed | None,
    limits: Mapping[Movement, tuple[float, float]],
    person: Sequence[LegCycle] = (),
) -> tuple[Drawing, ...]:
    """Six charts over the cycle, both legs in each, with the normative band behind them.

    Args:
        found: The curves of each leg.
        speed: Which normative band to draw; None: none.
        limits: By movement, the joint's range [rad].
        person: The person's curves, dashed.
    """
    return tuple(_joint(k, movement, found, speed, limits, person) for k, movement in enumerate(MOVEMENTS))


def _joint(
    k: int,
    movement: Movement,
    found: Sequence[LegCycle],
    speed: Speed | None,
    limits: Mapping[Movement, tuple[float, float]],
    person: Sequence[LegCycle],
) -> Drawing:
    bands, curves, spans = [], [], []
    for leg in person:
        label = f"{leg.side}, person"
        curves.append(Curve(leg.percent, np.degrees(leg.q[:, k]), svg.SIDE_COLOURS[leg.side], label, "3 3"))
    if speed is not None:
        percent, mean, sd = normal(speed, k)
        bands.append(Band(percent, mean - sd, mean + sd, "#7d8894", "normal, ±1 sd", 0.28))
        curves.append(Curve(percent, mean, "#8b95a0", "normal, mean", dash="5 3", width=1.1))
    same = len(found) > 1 and np.array_equal(found[0].percent, found[1].percent)
    same = same and np.allclose(found[0].q, found[1].q, atol=1e-3)
    for leg in found:
        q, colour = np.degrees(leg.q[:, k]), svg.SIDE_COLOURS[leg.side]
        if leg.sd is not None:
            sd = np.degrees(leg.sd[:, k])
            bands.append(Band(leg.percent, q - sd, q + sd, colour))
        over, width = _shown_twice(leg.side, dashes=not person) if same else (None, _WIDTH)
        curves.append(Curve(leg.percent, q, colour, leg.side, over, width))
        if np.isfinite(leg.stance):
            spans.append(Span(0, min(leg.stance, 100.0), colour, f"{leg.side} stance", SIDES.index(leg.side)))
    levels = [
        Level(float(np.degrees(x)), walk_charts.LIMIT_COLOUR, "joint limit") for x in limits.get(movement, ())
    ]
    chart = Chart(
        title=walk_charts.MOVEMENT_TITLES[movement],
        x_label="% of the leg's gait cycle",
        curves=tuple(curves),
        bands=tuple(bands),
        spans=tuple(spans),
        levels=tuple(levels),
        x_range=(0, 100),
        least=_LEAST,
    )
    return Drawing(f"curve_{movement}", walk_charts.MOVEMENT_TITLES[movement], draw(chart))


def _shown_twice(side: Side, *, dashes: bool) -> tuple[str | None, float]:
    """Dash and width that show both of two equal curves: without dashes the left one is wider, behind."""
    if dashes:
        return ("6 6" if side == "right" else None), _WIDTH
    return None, (2.4 * _WIDTH if side == "left" else _WIDTH)


def normal(speed: Speed, movement: int) -> tuple[Array, Array, Array]:
    """Percent, mean and standard deviation `(101,)` [deg] of a movement, the end point repeated."""
    mean, sd = normative_gait(speed).q[:, movement], normative_sd(speed)[:, movement]
    return np.linspace(0, 100, 101), np.degrees([*mean, mean[0]]), np.degrees([*sd, sd[0]])

"""Joint angles over the gait cycle, before the normative band."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from exo_pin.anatomy import MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import Movement
from exo_pin.arrays import Array
from exo_pin.gait import Gait, normative_gait, normative_sd
from exo_pin.report.document.blocks import Drawing, Figure, Section, Words
from exo_pin.report.draw import panels, svg
from exo_pin.report.draw.chart import Band, Chart, Curve, Level, Span, draw
from exo_pin.report.draw.leg_cycles import LegCycle, legs
from exo_pin.robot import Robot

BAND_SOURCE = (
    "Schwartz 2008, {speed}: mean and 1 standard deviation of 51 to 82 children a speed; ankle inversion: "
    "Oxford foot model. Its hip flexion is measured against a pelvis tilted forward by 10 to 18 deg, so "
    "compare shapes and ranges, and levels with care; hip rotation and ankle inversion are weak channels."
)
_LEAST = 20.0  # [deg] smallest extent of an angle's axis


def curves(robot: Robot, gait: Gait, normal: str | None) -> Section:
    """Six charts, both legs in each."""
    found = legs(gait)
    if not found:
        words = (
            "The walk has no heel strikes of both feet, so it cannot be placed in a gait cycle: no curves."
        )
        return Section("Joint angles over the gait cycle", (Words(words),))
    limits = {
        movement: (float(robot.lower[k]), float(robot.upper[k]))
        for movement in MOVEMENTS
        if (name := joint("left", movement)) in robot.joints
        for k in [robot.joints.index(name)]
    }
    drawings = charts(found, speed=normal, limits=limits)
    band = "" if normal is None else " Grey band: " + BAND_SOURCE.format(speed=normal)
    caption = "; ".join(leg.note for leg in found) + ". Angles of the walk as given, not filtered." + band
    return Section("Joint angles over the gait cycle", (Figure(drawings, caption),))


def charts(
    found: Sequence[LegCycle], *, speed: str | None, limits: dict[str, tuple[float, float]]
) -> tuple[Drawing, ...]:
    """Six charts over the cycle, both legs in each, before the normative band.

    Args:
        found: The legs' curves.
        speed: Which normative band to draw; None: none.
        limits: By movement, the joint's range [rad].
    """
    return tuple(_joint(k, movement, found, speed, limits) for k, movement in enumerate(MOVEMENTS))


def _joint(
    k: int,
    movement: Movement,
    found: Sequence[LegCycle],
    speed: str | None,
    limits: dict[str, tuple[float, float]],
) -> Drawing:
    bands, curves, spans = [], [], []
    if speed is not None:
        percent, mean, sd = normal(speed, k)
        bands.append(Band(percent, mean - sd, mean + sd, "#7d8894", "normal, ±1 sd", 0.28))
        curves.append(Curve(percent, mean, "#8b95a0", "normal, mean", dash="5 3", width=1.1))
    same = len(found) > 1 and np.array_equal(found[0].percent, found[1].percent)
    same = same and np.allclose(found[0].q, found[1].q, atol=1e-3)
    for leg in found:
        q, colour = np.degrees(leg.q[:, k]), svg.COLOURS[leg.side]
        if leg.sd is not None:
            sd = np.degrees(leg.sd[:, k])
            bands.append(Band(leg.percent, q - sd, q + sd, colour))
        over = "6 6" if same and leg.side == "right" else None  # two equal curves are seen both
        curves.append(Curve(leg.percent, q, colour, leg.side, over))
        if np.isfinite(leg.stance):
            spans.append(Span(0, min(leg.stance, 100.0), colour, f"{leg.side} stance", SIDES.index(leg.side)))
    levels = [Level(float(np.degrees(x)), panels.LIMIT, "joint limit") for x in limits.get(movement, ())]
    chart = Chart(
        title=panels.TITLES[movement],
        x_label="% of the leg's gait cycle",
        curves=tuple(curves),
        bands=tuple(bands),
        spans=tuple(spans),
        levels=tuple(levels),
        x_range=(0, 100),
        least=_LEAST,
    )
    return Drawing(f"curve_{movement}", panels.TITLES[movement], draw(chart))


def normal(speed: str, movement: int) -> tuple[Array, Array, Array]:
    """Percent, mean and standard deviation `(101,)` [deg] of a movement, the end point repeated."""
    mean, sd = normative_gait(speed).q[:, movement], normative_sd(speed)[:, movement]
    return np.linspace(0, 100, 101), np.degrees([*mean, mean[0]]), np.degrees([*sd, sd[0]])

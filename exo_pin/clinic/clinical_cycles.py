"""The curves of a gait laboratory's page: twelve angles of each side over every one of its cycles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import JOINTS, MOVEMENTS, SIDES, joint
from exo_pin.anatomy.names import CLINICAL_ANGLES, ClinicalAngle, Side, Speed
from exo_pin.arrays import Array
from exo_pin.clinic.segment_angles import foot_progression, marked_progression, pelvis_angles, ways
from exo_pin.gait import Gait, cycles
from exo_pin.gait.cycles import CYCLE_POINTS
from exo_pin.gait.further_angles import FurtherAngles
from exo_pin.gait.leg_cycles import cycle_times
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.gait.normative import published_curve, speed_named, speed_of
from exo_pin.gait.schwartz2008 import TIMING
from exo_pin.gait.validation import read_only
from exo_pin.robot import Robot
from exo_pin.short_repr import short_repr

PERCENT = read_only(np.linspace(0.0, 100.0, CYCLE_POINTS))
"""`(101,)` percent of the cycle."""


@dataclass(frozen=True, eq=False)
class ClinicalCycles:
    """One side's angles over its own cycles, heel strike at 0 %.

    Attributes:
        side: Which side.
        curves: Angle -> `(k, 101)` [rad], a row for each of k cycles; an angle that is not known is left out.
        toe_off: `(k,)` toe-off in percent of each cycle; NaN where it is unknown.
        sources: Angle -> where it comes from, in words.
    """

    side: Side
    curves: Mapping[ClinicalAngle, Array]
    toe_off: Array
    sources: Mapping[ClinicalAngle, str]

    __repr__ = short_repr

    def __len__(self) -> int:
        """Number of cycles k."""
        return len(self.toe_off)

    def mean(self, angle: ClinicalAngle) -> Array:
        """`(101,)` mean over the cycles [rad]."""
        return np.asarray(self.curves[angle].mean(axis=0))


def clinical_cycles(
    robot: Robot, gait: Gait, further: FurtherAngles | None = None, feet: FootMarkers | None = None
) -> tuple[ClinicalCycles, ...]:
    """The cycles of each side that has a whole one, left first.

    Joint angles are the walk's. Pelvis and foot progression are those of `further` where it has them; else
    the pelvis is its motion against the way that the person goes in each stride, and the foot the line from
    heel marker to toe marker, or the robot's foot. A robot's knee and ankle do not turn about the shank, so
    its foot may be several degrees off. A normal walk has the published curves (`normal_cycles`).

    Args:
        robot: The exoskeleton on the person's body.
        gait: The walk, with its events.
        further: What the walk's file has beside the joints.
        feet: Heel and toe markers of the walk's trial.
    """
    speed = speed_of(gait)
    if speed is not None:
        return normal_cycles(speed)
    return tuple(found for side in SIDES if (found := _side(robot, gait, side, further, feet)) is not None)


def normal_cycles(speed: Speed) -> tuple[ClinicalCycles, ...]:
    """The normal walk's cycles as published, one a side and both alike.

    The walk itself (`gait.normative_gait`) is cut at its events, which are rounded to a percent.

    Raises:
        UnknownNameError: There is no such speed.
    """
    speed = speed_named(speed)
    curves = {angle: published_curve(speed, angle)[0][None] for angle in CLINICAL_ANGLES}
    toe_off = np.array([TIMING[speed]["foot_off"]])
    words = dict.fromkeys(CLINICAL_ANGLES, f"Schwartz 2008, {speed}")
    return tuple(ClinicalCycles(side, curves, toe_off, words) for side in SIDES)


def _side(
    robot: Robot, gait: Gait, side: Side, further: FurtherAngles | None, feet: FootMarkers | None
) -> ClinicalCycles | None:
    times = cycle_times(gait, side)
    if not len(times):
        return None
    q, columns = cycles(gait, side).q, [JOINTS.index(joint(side, movement)) for movement in MOVEMENTS]
    curves: dict[ClinicalAngle, Array] = dict(
        zip(MOVEMENTS, np.moveaxis(q[:, :, columns], 2, 0), strict=True)
    )
    sources: dict[ClinicalAngle, str] = dict.fromkeys(curves, "the walk's joint angles")
    if gait.base is not None:
        way = ways(robot, gait, times)
        found = pelvis_angles(gait, side, times, way)
        sources |= dict.fromkeys(found, "computed from the pelvis's motion")
        where = "computed at the heel and toe markers"
        seen = None if feet is None else marked_progression(feet, side, times, way)
        if seen is None or not np.isfinite(seen).all():
            seen, where = foot_progression(robot, gait, side, times, way), "computed at the model's feet"
        curves |= {**found, "foot_progression": seen}
        sources["foot_progression"] = where
    if further is not None:
        given = _given(further, side, times)
        curves |= given
        sources |= dict.fromkeys(given, further.source)
    ordered = {angle: curves[angle] for angle in CLINICAL_ANGLES if angle in curves}
    return ClinicalCycles(side, ordered, _toe_offs(gait, side, times), sources)


def _given(further: FurtherAngles, side: Side, times: Array) -> dict[ClinicalAngle, Array]:
    """What the file has over every cycle, without a gap."""
    found: dict[ClinicalAngle, Array] = {}
    for angle in CLINICAL_ANGLES:
        values = None if angle in MOVEMENTS else further.at(side, angle, times)
        if values is not None and np.isfinite(values).all():
            found[angle] = values
    return found


def _toe_offs(gait: Gait, side: Side, times: Array) -> Array:
    """`(k,)` the foot's only toe-off of each cycle in percent, else NaN."""
    period = gait.duration if gait.periodic else 0.0
    mine = [event.time for event in gait.events if (event.kind, event.side) == ("toe_off", side)]
    offs = np.array([time + lap for time in mine for lap in {0.0, period}])
    share = [(offs[(offs > t[0]) & (offs < t[-1])] - t[0]) / (t[-1] - t[0]) for t in times]
    return np.array([100 * float(x[0]) if len(x) == 1 else np.nan for x in share])

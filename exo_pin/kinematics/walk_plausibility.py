"""Plausibility of a walk on a body: joint ranges, outliers and sliding feet in one verdict."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress

from exo_pin.errors import GaitError
from exo_pin.gait import Gait, Plausibility, implausibilities
from exo_pin.kinematics.curve_outliers import CurveOutlier, curve_outliers
from exo_pin.kinematics.sole_contact import with_events
from exo_pin.kinematics.stance_slide import slide_doubts
from exo_pin.robot import Robot


def plausibility(robot: Robot, gait: Gait, *, more: Iterable[str] = ()) -> Plausibility:
    """Whether a walk was probably read as it was walked; every reason against it.

    A walk is plausible where no sample stands out of its curve, no joint leaves what a person can do, and no
    standing foot slides over the ground.

    Args:
        robot: The robot that walks, on the person's body.
        gait: The walk.
        more: Reasons found elsewhere: how markers are met, how force plates were read.
    """
    found = Plausibility(implausibilities(gait))
    with suppress(GaitError):  # without cycles there are no landings that curves bend at, and no stances
        gait = with_events(robot, gait)
    return found.with_reasons((*_outliers(curve_outliers(gait)), *slide_doubts(robot, gait), *more))


def _outliers(found: Sequence[CurveOutlier]) -> tuple[str, ...]:
    """How many samples stand out, and the furthest one."""
    if not found:
        return ()
    worst = max(found, key=lambda x: abs(x.off))
    count = f"{len(found)} sample{'s' * (len(found) != 1)} stand{'s' * (len(found) == 1)} out of the curve"
    return (
        f"{count}, {worst.curve} at {worst.time:.3f} s by {worst.off:+.1f} {worst.unit}: gaps, or noise?",
    )

"""Checks that force plates belong to a walk: clock, unit, direction, points, feet on the ground, weight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from exo_pin.anatomy import SIDES
from exo_pin.anatomy.names import Side
from exo_pin.arrays import Array, Mask
from exo_pin.dynamics.standing_under_load import ON_THE_SPOT
from exo_pin.errors import GaitError
from exo_pin.gait import Gait
from exo_pin.gait.trial import ForcePlate
from exo_pin.kinematics import PlateStep
from exo_pin.kinematics.plate_contacts import LOADED_PART

_CONTACT = 20.0
"""Vertical force of a contact [N], as `exo_pin.gait.force_plates` has it."""

_TRACE = 0.05
"""A largest force between this and a contact's [N] is a foot's force in kN."""

_LEVEL = 2.0
"""No foot pushes the ground this many times harder to the front or side than down."""

_LONGEST_ARM = 0.5
"""A free moment per newton [m] that no sole can give; N mm given as N m is a thousand times too large."""

_OPPOSITE, _FRAMES = -0.3, 20
"""Correlation of horizontal force and acceleration below which they are opposite, over so many frames."""

_IN_THE_AIR = 0.08
"""Height [m] of a sole's lowest corner above the plate from which the foot is not standing on it."""

NOTICED, REFUSED = 0.05, 0.30
"""Parts of the weight by which plates and masses differ: the remark begins here, the refusal there."""


@dataclass(frozen=True)
class WeightCheck:
    """Vertical force of the plates against that which the model's masses need, over the valid frames.

    Attributes:
        measured: Mean vertical force of plates and body-weight support [N].
        expected: Mean of mass times vertical acceleration with gravity [N].
    """

    measured: float
    expected: float

    @property
    def difference(self) -> float:
        """Measured minus expected, as a part of the expected force."""
        return (self.measured - self.expected) / self.expected

    def __str__(self) -> str:
        return (
            f"the plates bear {self.measured:.0f} N on average, the masses of the model need "
            f"{self.expected:.0f} N ({100 * self.difference:+.1f} %)"
        )


def check_weight(measured: Array, expected: Array) -> WeightCheck:
    """Compare the weight on the plates with that of the model.

    Args:
        measured: `(n,)` vertical force of plates and support in the valid frames [N].
        expected: `(n,)` vertical force that the motion needs there [N].

    Raises:
        GaitError: They differ by 30 % or more.
    """
    weight = WeightCheck(float(measured.mean()), float(expected.mean()))
    if abs(weight.difference) >= REFUSED:
        raise GaitError(f"{weight}: another person, or a wrong mass? Less than 30 % apart is accepted")
    return weight


def check_plates(gait: Gait, forces: Sequence[ForcePlate]) -> None:
    """Refuse plates of another clock, unit or direction.

    Raises:
        GaitError: With the plate, what is wrong, and what would be accepted.
    """
    if gait.periodic:
        raise GaitError("force plates are measured on a trial, but the walk is one cycle that repeats")
    for plate in forces:
        _check_clock(gait, plate)
        if not np.isfinite(plate.force).all():
            row = int(np.argmin(np.isfinite(plate.force).all(axis=1)))
            raise GaitError(f"{plate.name}: the force at {plate.time[row]:g} s is not a finite number")
        _check_moment(plate)
        _check_direction(plate)
    highest = max(float(plate.force[:, 2].max(initial=0.0)) for plate in forces)
    if _TRACE < highest < _CONTACT:
        raise GaitError(
            f"the largest vertical force of the plates is {highest:.3g} N: kN given as N? N is accepted"
        )


def _check_clock(gait: Gait, plate: ForcePlate) -> None:
    if plate.time[-1] < gait.time[0] or plate.time[0] > gait.time[-1]:
        raise GaitError(
            f"{plate.name} was recorded from {plate.time[0]:g} to {plate.time[-1]:g} s, the walk from "
            f"{gait.time[0]:g} to {gait.time[-1]:g} s; plates of the same clock are accepted"
        )


def _check_direction(plate: ForcePlate) -> None:
    highest, lowest = (float(f(plate.force[:, 2])) for f in (np.max, np.min))
    level = float(np.abs(plate.force[:, :2]).max())
    if level > max(_LEVEL * max(highest, -lowest), _CONTACT):
        raise GaitError(
            f"{plate.name}: the largest force is horizontal, {level:.0f} N ({max(highest, -lowest):.0f} N "
            "along the vertical): are its axes in another order? The axes of the walk are accepted"
        )
    if -lowest > max(highest, _CONTACT):
        raise GaitError(
            f"{plate.name}: the force points down ({lowest:.0f} N), its sign is turned; the force of the "
            "ground on the foot is accepted, upwards positive"
        )


def check_horizontal(measured: Array, expected: Array) -> None:
    """Refuse plates whose horizontal forces go against the motion.

    Args:
        measured: `(n, 2)` horizontal force of all plates in the valid frames [N].
        expected: `(n, 2)` mass times horizontal acceleration there [N].

    Raises:
        GaitError: They are opposite.
    """
    ours, theirs = (values - values.mean(axis=0) for values in (measured, expected))
    scale = float(np.sqrt((ours**2).sum() * (theirs**2).sum()))
    if scale > 0.0 and len(ours) >= _FRAMES and float((ours * theirs).sum()) < _OPPOSITE * scale:
        raise GaitError(
            "the horizontal forces of the plates point against the acceleration of the body: their sign is "
            "turned; the force of the ground on the foot is accepted"
        )


def _check_moment(plate: ForcePlate) -> None:
    load = np.linalg.norm(plate.force, axis=1)
    moment = np.linalg.norm(plate.moment, axis=1)
    loaded = load > 0.1 * load.max(initial=0.0)
    large = loaded & (load > _CONTACT) & (moment > _LONGEST_ARM * load)
    if large.sum() > 0.5 * loaded.sum():
        row = int(np.argmax(np.where(large, moment, 0.0)))
        raise GaitError(
            f"{plate.name}: a free moment of {moment[row]:.0f} N m with a force of {load[row]:.0f} N at "
            f"{plate.time[row]:g} s: N mm given as N m? N m are accepted"
        )


def check_points(step: PlateStep) -> None:
    """Refuse a contact whose point or moment is not known while it bears a load.

    Raises:
        GaitError: With the plate and the time.
    """
    plate, rows = step.plate, slice(step.contact.start, step.contact.stop)
    good = np.isfinite(plate.point[rows]).all(axis=1) & np.isfinite(plate.moment[rows]).all(axis=1)
    good |= plate.force[rows, 2] < LOADED_PART * plate.force[rows, 2].max()
    if not good.all():
        t = plate.time[rows][int(np.argmin(good))]
        raise GaitError(
            f"{plate.name}: no centre of pressure or moment (NaN) at {t:g} s, while the {step.side} foot "
            "loads the plate; finite numbers are accepted"
        )


def check_steps(gait: Gait, steps: Sequence[PlateStep], heights: Mapping[Side, Array]) -> None:
    """Refuse plates of which no contact has a foot, or that bear a foot while it is in the air.

    Args:
        gait: The walk.
        steps: Contacts with plates.
        heights: Side -> `(n,)` height of the sole's lowest corner [m].

    Raises:
        GaitError: With the plate, the time and the reason.
    """
    if not any(step.side for step in steps):
        why = "; ".join(f"{step.when}: {step.why}" for step in steps[:2] if step.why)
        raise GaitError(f"no contact of a foot with a force plate was found{': ' * bool(why)}{why}")
    for step in steps:
        if step.side is not None:
            _check_height(gait, step, heights[step.side])


def check_both_feet(gait: Gait, steps: Sequence[PlateStep], stands: Mask) -> None:
    """Refuse plates of one foot alone on a treadmill; over ground they are usual.

    Args:
        gait: The walk, its pelvis in the world.
        steps: Contacts with plates.
        stands: `(n, 2)` which foot stands.

    Raises:
        GaitError: With the foot that is missing.
    """
    assert gait.base is not None
    path = np.ptp(gait.base[:, :2, 3], axis=0)
    both_walk = bool((stands.any(axis=0) & ~stands.all(axis=0)).all())
    for side in SIDES:
        if both_walk and path.max() < ON_THE_SPOT and not any(step.side == side for step in steps):
            raise GaitError(
                f"no plate bears the {side} foot, though the walk stays in place as on a treadmill: "
                "the forces of both feet are accepted"
            )


def _check_height(gait: Gait, step: PlateStep, height: Array) -> None:
    t = step.plate.time[step.contact.start : step.contact.stop]
    t = t[(t >= gait.time[0]) & (t <= gait.time[-1])]
    if not len(t):
        return
    ground = float(np.nanmedian(step.plate.point[step.contact.start : step.contact.stop, 2]))
    above = float(np.median(np.interp(t, gait.time, height))) - ground
    if above > _IN_THE_AIR:
        raise GaitError(
            f"{step.when}: the {step.side} foot is {100 * above:.0f} cm above the plate while that is "
            "loaded: another clock, or another trial?"
        )

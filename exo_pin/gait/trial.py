"""Records of a motion-capture trial: markers, model angles, events and force plates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from exo_pin.anatomy.names import Vertical
from exo_pin.arguments import names, real, table
from exo_pin.arrays import Array
from exo_pin.errors import GaitError, UnknownNameError
from exo_pin.frozen_fields import set_fields
from exo_pin.gait import Event
from exo_pin.gait.validation import FURTHEST, check_time, frozen
from exo_pin.short_repr import short_repr

UP_AXES: tuple[Vertical, ...] = ("+x", "+y", "+z", "-x", "-y", "-z")
"""Axes that can be the vertical of a laboratory."""

LARGEST_FORCE = 1e5
"""No foot presses more on a plate [N]; a larger number is damaged."""

_LOADED = 20.0
"""Force from which a plate is loaded [N]: the centre of pressure has a meaning."""


@dataclass(frozen=True, eq=False)
class ForcePlate:
    """What one force plate measured, in the axes of its trial.

    Attributes:
        name: What the file calls it.
        time: `(m,)` [s], on the trial's time axis.
        force: `(m, 3)` ground reaction force on the foot [N].
        point: `(m, 3)` where it acts [m]; meaningless while nothing stands on the plate.
        moment: `(m, 3)` free moment [N m] at that point.
        remarks: What reading the file corrected or left out, a plain sentence each.
    """

    name: str
    time: Array
    force: Array
    point: Array
    moment: Array
    remarks: tuple[str, ...] = ()

    __repr__ = short_repr

    def __post_init__(self) -> None:
        vectors = {"force": self.force, "point": self.point, "moment": self.moment}
        set_fields(self, time=frozen(self.time, f"{self.name}: time"))
        real(f"{self.name}: time", self.time, ("m",), error=GaitError)
        for name, values in vectors.items():
            kept = frozen(values, f"{self.name}: {name}")
            if kept.shape != (len(self.time), 3):
                raise GaitError(f"{self.name}: {name} has shape {kept.shape}, expected (m, 3)")
            set_fields(self, **{name: kept})
        damage = plate_damage(self.force, self.point)
        if damage:
            raise GaitError(f"{self.name}: {damage}; damaged?")
        if (far := np.abs(self.point) > FURTHEST).any():  # moment over hardly any force: no place at all
            set_fields(self, point=frozen(np.where(far, np.nan, self.point), "point"))


def plate_damage(force: Array, point: Array) -> str:
    """What no force plate can have measured, in words; empty if there is nothing of the kind.

    Args:
        force: `(m, 3)` [N].
        point: `(m, 3)` centre of pressure [m]; that of an unloaded plate may be anything.
    """
    if (np.abs(force) > LARGEST_FORCE).any():
        return f"a force of more than {LARGEST_FORCE:g} N"
    loaded = np.linalg.norm(force, axis=1) > _LOADED
    if (np.abs(point[loaded]) > FURTHEST).any():
        return f"a centre of pressure more than {FURTHEST:g} m away"
    return ""


@dataclass(frozen=True, eq=False)
class Markers:
    """Paths of markers in space.

    Attributes:
        time: `(n,)` strictly increasing [s]; the first frame need not be at 0. One frame is a posture, which
            a body can be scaled from.
        names: The k markers.
        position: `(n, k, 3)` [m]; NaN where a marker was not seen.
        up: Which of the laboratory's axes points up, or "" where the file does not state it.
        angles: Model angles by the file's names, `(n, 3)` [rad] each; NaN where there are none.
        events: Foot contacts in the file.
        plates: Force plates.
        source: Where the numbers come from, in words.
        remarks: What reading the file held, corrected or ignored, a plain sentence each; the walk made of the
            trial has them too.
        unit: What the file states its lengths in, for messages; "" where it states none.

    Raises:
        GaitError: Shapes, time or names are unusable.
    """

    time: Array
    names: tuple[str, ...]
    position: Array
    up: Vertical | Literal[""] = ""
    angles: Mapping[str, Array] = field(default_factory=dict)
    events: tuple[Event, ...] = ()
    plates: tuple[ForcePlate, ...] = ()
    source: str = ""
    remarks: tuple[str, ...] = ()
    unit: str = ""

    __repr__ = short_repr

    def __post_init__(self) -> None:
        angles = table("angles", self.angles, error=GaitError)
        set_fields(
            self,
            time=frozen(self.time, "time"),
            names=names("names", self.names, error=GaitError),
            position=frozen(self.position, "position"),
            angles=MappingProxyType({name: frozen(values, name) for name, values in angles.items()}),
        )
        if self.time.shape != (1,):  # a standing trial may be one frame
            check_time(self.time, periodic=False)
        n, k = len(self.time), len(self.names)
        if self.position.shape != (n, k, 3):
            raise GaitError(f"position has shape {self.position.shape}, expected ({n}, {k}, 3)")
        if len(set(self.names)) < k:
            raise GaitError("a marker occurs more than once")
        far = np.argwhere(np.abs(self.position) > FURTHEST)
        if far.size:
            frame, marker, _ = far[0]
            why = f"marker {self.names[marker][:40]!a} is more than {FURTHEST:g} m away in frame {frame}"
            raise GaitError(f"{why}; expected metres, or NaN where it was not seen")
        if self.up not in ("", *UP_AXES):
            raise UnknownNameError("axis", self.up, UP_AXES)
        for name, values in self.angles.items():
            if values.shape != (n, 3):
                raise GaitError(f"{name} has shape {values.shape}, expected ({n}, 3)")

    def __len__(self) -> int:
        """Number of frames n."""
        return len(self.time)

    def of(self, name: str) -> Array:
        """`(n, 3)` path of one marker [m].

        Raises:
            UnknownNameError: There is no such marker.
        """
        if name not in self.names:
            raise UnknownNameError("marker", name, self.names)
        return np.asarray(self.position[:, self.names.index(name)])

    def renamed(self, mapping: Mapping[str, str]) -> Markers:
        """The same trial with other names for some markers; a marker that had such a name before is left out.

        Raises:
            UnknownNameError: There is no marker of a name in `mapping`.
            GaitError: A new name is no text.
        """
        if not all(isinstance(name, str) for name in table("mapping", mapping, error=GaitError).values()):
            raise GaitError("mapping holds something that is no name; names of markers are accepted")
        for name in mapping:
            if name not in self.names:
                raise UnknownNameError("marker", name, self.names)
        taken = set(mapping.values())
        kept = [k for k, name in enumerate(self.names) if name in mapping or name not in taken]
        names = tuple(mapping.get(self.names[k], self.names[k]) for k in kept)
        return replace(self, names=names, position=self.position[:, kept])

    def turned(self, R: ArrayLike) -> Markers:
        """The same trial in other axes: every vector times `R (3, 3)`; z is up then.

        Raises:
            GaitError: R is no array of finite numbers of that shape.
        """
        R = real("R", R, (3, 3), error=GaitError)
        plates = tuple(
            ForcePlate(p.name, p.time, p.force @ R.T, p.point @ R.T, p.moment @ R.T) for p in self.plates
        )
        position = self.position @ R.T
        return replace(self, position=position, up="+z", plates=plates)


def to_z_up(up: Vertical) -> Array:
    """`(3, 3)` the rotation that carries a laboratory's axes to ones with z up, x staying where it can.

    Raises:
        UnknownNameError: There is no such axis.
    """
    if up not in UP_AXES:
        raise UnknownNameError("axis", up, UP_AXES)
    axis = np.zeros(3)
    axis["xyz".index(up[1])] = 1.0 if up[0] == "+" else -1.0
    forward = np.array([0.0, 1.0, 0.0]) if up[1] == "x" else np.array([1.0, 0.0, 0.0])
    return np.stack([forward, np.cross(axis, forward), axis])


def vertical_along(direction: Array) -> Vertical | None:
    """The axis of the laboratory along which `(3,)` lies within some 27 degrees, or None."""
    k = int(np.abs(direction).argmax())
    if not abs(direction[k]) > 2 * np.linalg.norm(np.delete(direction, k)):
        return None
    return UP_AXES[k if direction[k] > 0 else k + 3]


def unique(names: Iterable[str]) -> dict[str, int]:
    """Name -> place of its first use, without a subject's prefix (`Anna:LASI`) and without empty names."""
    places: dict[str, int] = {}
    for k, name in enumerate(names):
        plain = name.rpartition(":")[2].strip()
        if plain and plain not in places:
            places[plain] = k
    return places

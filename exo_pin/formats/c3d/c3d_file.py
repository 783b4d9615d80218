"""A C3D trial: markers, model angles, joint moments, events and force plates in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np

from exo_pin.anatomy.names import AngleUnit, LengthUnit, SignPreset, Vertical
from exo_pin.anatomy.person import Person
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, naming_file
from exo_pin.formats.c3d.content import C3dContent
from exo_pin.formats.c3d.foot_contacts import foot_events
from exo_pin.formats.c3d.joint_centres import measured_person
from exo_pin.formats.c3d.pelvis_and_progression import further_angles
from exo_pin.formats.c3d.plates import FoundPlates, force_plates
from exo_pin.formats.c3d.plug_in_gait import PLUG_IN_GAIT, has_model_angles, joint_moments, model_angles
from exo_pin.formats.c3d.reader import read_content
from exo_pin.formats.c3d.recorded import check_recorded
from exo_pin.formats.c3d.session import session
from exo_pin.formats.c3d.subject_parameters import stated_person
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.trial_file import TrialFile
from exo_pin.formats.units import LENGTH_UNITS, RADIANS_PER, metres_per, radians_per
from exo_pin.gait import Gait
from exo_pin.gait.further_angles import FurtherAngles
from exo_pin.gait.torques import Torques
from exo_pin.gait.trial import UP_AXES, ForcePlate, Markers

_FULL_TURN = 2 * np.pi
"""No leg turns so far: a larger angle without a unit is in degrees."""


@dataclass(frozen=True, eq=False)
class C3dFile(TrialFile):
    """A C3D file.

    Attributes:
        content: What a reader of the format found.
        length_unit: Of points, as the user states it; None: as the file does.
    """

    content: C3dContent
    length_unit: LengthUnit | None = None

    @property
    def needs_inverse_kinematics(self) -> bool:
        """Whether it has markers and not all of Plug-in Gait's leg angles."""
        return not has_model_angles(self._trial)

    @property
    def takes_length_unit(self) -> bool:
        """Always: POINT:UNITS is often empty or cut."""
        return True

    def with_length_unit(self, unit: LengthUnit) -> C3dFile:
        """The same content, its points in this unit."""
        return replace(self, length_unit=unit)

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by Plug-in Gait's model angles; errors as in `TrialFile.gait`."""
        options.refuse(self.path, "mapping", why="its parameters name the angles")
        if options.preset not in (None, PLUG_IN_GAIT.name):
            why = f"preset {options.preset!r} does not fit a C3D file; its angles are {PLUG_IN_GAIT.name}"
            raise FormatError(self.path, why)
        trial = self._trial if options.units is None else self._read(options.units)
        check_recorded(self.path, trial, self.content)
        return model_angles(self.path, trial)

    def markers(self) -> Markers:
        """The trial; lengths in metres, angles in radians, time from the file's first frame on."""
        if self._metres is None:
            why = f"{self._no_length_unit}; state the unit: --units mm, cm or m"
            raise FormatError(self.path, why)
        return self._trial

    def person(self, model: Path | None = None) -> Person:
        """The person by the model's joint centres, else by the file's parameters."""
        return measured_person(self._trial).over(stated_person(self.content.parameters))

    def further_angles(self) -> FurtherAngles | None:
        """Plug-in Gait's pelvis, foot progression and the knee's other two planes."""
        return further_angles(self.path, self._trial)

    def session(self) -> dict[str, str]:
        """Of its parameters."""
        return session(self.content.parameters)

    def torques(self, preset: SignPreset | None = None, mass: float | None = None) -> Torques:
        """Plug-in Gait's joint moments; arguments and errors as in `TrialFile.torques`."""
        return joint_moments(self.path, self.content, preset, mass)

    def force_plates(self) -> tuple[ForcePlate, ...]:
        """The force plates of the trial; none where it has none."""
        return self.markers().plates

    @cached_property
    def _trial(self) -> Markers:
        return self._read(None)

    def _read(self, angle_unit: AngleUnit | None) -> Markers:
        """The trial; without points and plates where the unit of length is not known."""
        content = self.content
        points = np.moveaxis(content.points, 0, -1)  # (k, n, 3)
        time, events = content.time, content.events
        names = [name for name in content.columns if name in content.angles or name.endswith("Angles")]
        angles = {name: points[content.columns[name]] for name in names}
        turn, said = self._radians(angles, angle_unit)
        metres, plates = self._metres, (self._plates() if self._metres else FoundPlates((), ()))
        spatial = [name for name in content.columns if name not in angles and name not in content.outputs]
        spatial = spatial if metres else []
        position = np.moveaxis(points[[content.columns[name] for name in spatial]], 0, 1) * (metres or 1.0)
        position = np.where((position == 0).all(axis=2, keepdims=True), np.nan, position)  # not seen
        step = 1.0 if len(time) < 2 else float(time[1] - time[0])
        span = float(time[0]), float(time[-1])
        found = foot_events(events.times, events.labels, events.contexts, span, step)
        header = [f"{len(events.labels)} events stand in the file's header"] if events.in_header else []
        with naming_file(self.path):
            return Markers(
                time,
                tuple(spatial),
                position,
                up=_up(content.vertical),
                angles={name: values * turn for name, values in angles.items()},
                events=found.events,
                plates=plates.plates,
                source=self.path.name,
                unit=self._unit_word,
                remarks=(
                    *content.remarks,
                    *self._length_remarks(),
                    *said,
                    *header,
                    *found.remarks,
                    *plates.remarks,
                ),
            )

    @property
    def _metres(self) -> float | None:
        """Metres per unit of length; None where nothing tells it."""
        return metres_per(self.length_unit or self.content.length_unit or "")

    @property
    def _unit_word(self) -> str:
        """The unit of lengths as the user or the file states it, for messages; "" where it is not known."""
        stated = self.length_unit or self.content.length_unit or ""
        return next((unit for unit in LENGTH_UNITS if metres_per(unit) == metres_per(stated)), "")

    @property
    def _no_length_unit(self) -> str:
        return f"POINT:UNITS is {(self.content.length_unit or '')[:20]!a}, no unit of length"

    def _length_remarks(self) -> list[str]:
        if self._metres is None:
            return [
                f"{self._no_length_unit}: the pelvis's motion and force plates are left out (--units mm?)"
            ]
        stated = metres_per(self.content.length_unit or "")
        if self.length_unit and stated and stated != self._metres:
            return [f"lengths are read in {self.length_unit} as stated; POINT:UNITS is another unit"]
        return []

    def _radians(self, angles: Mapping[str, Array], chosen: AngleUnit | None) -> tuple[float, list[str]]:
        """Radians per unit of angle, and a sentence where it is not simply the file's."""
        unit = self.content.angle_unit
        stated = RADIANS_PER["deg"] if unit is None else radians_per(unit)
        if chosen is not None:
            other = stated is not None and stated != RADIANS_PER[chosen]
            why = f"angles are read in {chosen} as stated; POINT:ANGLE_UNITS is another unit"
            return RADIANS_PER[chosen], [why] if other else []
        if stated is not None or not angles:
            return stated or 1.0, []
        shown = ascii((unit or "")[:20])
        if max(float(np.nanmax(np.abs(values), initial=0)) for values in angles.values()) > _FULL_TURN:
            return RADIANS_PER["deg"], [f"POINT:ANGLE_UNITS is {shown}; angles beyond 2 pi: degrees"]
        raise FormatError(self.path, f"POINT:ANGLE_UNITS is {shown}; state the unit: --units deg or rad")

    def _plates(self) -> FoundPlates:
        content = self.content
        scale = self._metres if self.length_unit or not metres_per(content.length_unit or "") else None
        return force_plates(content.plates, content.analog_rate, float(content.time[0]), scale)


def open_c3d(path: Path) -> C3dFile:
    """Read a C3D file.

    Raises:
        FormatError: With file and reason; the reader runs in a process of its own, with limits.
    """
    return C3dFile(path, read_content(path))


def _up(stated: str) -> Vertical | Literal[""]:
    """The laboratory's vertical: the axis that is up on the screen, or ""."""
    axis = stated.lower()
    axis = axis if axis[:1] in ("+", "-") else f"+{axis}"
    return next((vertical for vertical in UP_AXES if vertical == axis), "")

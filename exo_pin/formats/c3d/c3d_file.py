"""A C3D trial: markers, model angles, joint moments, events and force plates in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np

from exo_pin.anatomy.names import SignPreset, Vertical
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, GaitError
from exo_pin.formats.c3d.content import C3dContent
from exo_pin.formats.c3d.ezc3d_reader import read_content
from exo_pin.formats.c3d.foot_contacts import foot_events
from exo_pin.formats.c3d.plug_in_gait import PLUG_IN_GAIT, has_model_angles, joint_moments, model_angles
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.trial_file import TrialFile
from exo_pin.formats.units import METRES_PER, NEWTON_METRES_PER, RADIANS_PER
from exo_pin.gait import Gait
from exo_pin.gait.torques import Torques
from exo_pin.gait.trial import UP_AXES, ForcePlate, Markers

_METRES_PER = {unit: METRES_PER[unit] for unit in ("mm", "cm", "m")}


@dataclass(frozen=True, eq=False)
class C3dFile(TrialFile):
    """A C3D file.

    Attributes:
        content: What a reader of the format found.
    """

    content: C3dContent

    @property
    def needs_inverse_kinematics(self) -> bool:
        """Whether it has markers and not all of Plug-in Gait's leg angles."""
        return not has_model_angles(self._trial)

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by Plug-in Gait's model angles; errors as in `TrialFile.gait`."""
        options.refuse(self.path, "mapping", "units", why="its parameters name the angles and their units")
        if options.preset not in (None, PLUG_IN_GAIT.name):
            why = f"preset {options.preset!r} does not fit a C3D file; its angles are {PLUG_IN_GAIT.name}"
            raise FormatError(self.path, why)
        return model_angles(self.path, self._trial)

    def markers(self) -> Markers:
        """The trial; lengths in metres, angles in radians, time from the file's first frame on."""
        return self._trial

    def torques(self, preset: SignPreset | None = None, mass: float | None = None) -> Torques:
        """Plug-in Gait's joint moments; arguments and errors as in `TrialFile.torques`."""
        return joint_moments(self.path, self.content, preset, mass)

    def force_plates(self) -> tuple[ForcePlate, ...]:
        """The force plates of the trial; none where it has none."""
        return self._trial.plates

    @cached_property
    def _trial(self) -> Markers:
        content = self.content
        points = np.moveaxis(content.points, 0, -1)  # (k, n, 3)
        angles = [name for name in content.columns if name in content.angles or name.endswith("Angles")]
        spatial = [name for name in content.columns if name not in angles and name not in content.outputs]
        scale = self._unit("UNITS", content.length_unit, _METRES_PER)
        position = np.moveaxis(points[[content.columns[name] for name in spatial]], 0, 1) * scale
        position = np.where((position == 0).all(axis=2, keepdims=True), np.nan, position)  # not seen
        turn = self._unit(
            "ANGLE_UNITS", "deg" if content.angle_unit is None else content.angle_unit, RADIANS_PER
        )
        time, events = content.time, content.events
        try:
            return Markers(
                time,
                tuple(spatial),
                position,
                up=_up(content.vertical),
                angles={name: points[content.columns[name]] * turn for name in angles},
                events=foot_events(events.times, events.labels, events.contexts, (time[0], time[-1])),
                plates=self._plates(),
                source=self.path.name,
            )
        except GaitError as error:
            raise FormatError(self.path, str(error)) from error

    def _unit(self, parameter: str, stated: str | None, known: Mapping[str, float]) -> float:
        unit = stated or ""
        if unit not in known:
            why = f"POINT:{parameter} is {unit[:20]!r}; {', '.join(known)} are accepted"
            raise FormatError(self.path, why)
        return known[unit]

    def _plates(self) -> tuple[ForcePlate, ...]:
        plates, rate = list[ForcePlate](), self.content.analog_rate
        for k, plate in enumerate(self.content.plates if rate > 0 else (), 1):
            newton, torque, length = plate.units
            if newton != "N" or torque not in NEWTON_METRES_PER or length not in _METRES_PER:
                why = f"a force plate in {newton}, {torque}, {length}; N, Nmm, mm are accepted"
                raise FormatError(self.path, why)
            time: Array = float(self.content.time[0]) + np.arange(len(plate.force)) / rate
            point, moment = plate.point * _METRES_PER[length], plate.moment * NEWTON_METRES_PER[torque]
            plates.append(ForcePlate(f"force plate {k}", time, plate.force, point, moment))
        return tuple(plates)


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

"""A Vicon Nexus export as a trial: Plug-in Gait's model outputs, markers, force plates and events."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from exo_pin.arrays import Array
from exo_pin.errors import FormatError, naming_file
from exo_pin.files import first_lines, read_lines
from exo_pin.formats.c3d.foot_contacts import foot_events
from exo_pin.formats.c3d.plug_in_gait import PLUG_IN_GAIT, has_model_angles, model_angles
from exo_pin.formats.nexus.force_devices import force_devices
from exo_pin.formats.nexus.sections import ExportedEvent, ExportedSection, Quantity, read_sections, title_of
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.trial_file import TrialFile
from exo_pin.formats.units import metres_per, radians_per
from exo_pin.gait import Gait
from exo_pin.gait.trial import ForcePlate, Markers

_HEAD = 8192
"""Bytes that are searched for the first section's title."""

_MOST_FRAMES = 2_000_000


@dataclass(frozen=True, eq=False)
class NexusFile(TrialFile):
    """An export of Vicon Nexus.

    Attributes:
        sections: Those with numbers.
        exported: Rows of the section Events.
    """

    sections: tuple[ExportedSection, ...]
    exported: tuple[ExportedEvent, ...]

    @property
    def needs_inverse_kinematics(self) -> bool:
        """Whether it has trajectories and not all of Plug-in Gait's leg angles."""
        trial = self._trial
        return not has_model_angles(trial) and any(s.title == "Trajectories" for s in self.sections)

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by Plug-in Gait's model outputs; errors as in `TrialFile.gait`."""
        options.refuse(self.path, "mapping", "units", why="its sections name the angles and their units")
        if options.preset not in (None, PLUG_IN_GAIT.name):
            why = f"preset {options.preset!r} does not fit; model outputs are {PLUG_IN_GAIT.name}"
            raise FormatError(self.path, why)
        return model_angles(self.path, self._trial)

    def markers(self) -> Markers:
        """The trial; errors as in `TrialFile.markers`."""
        if not self._trial.names:
            raise FormatError(self.path, "holds no markers: it has no section Trajectories")
        return self._trial

    def force_plates(self) -> tuple[ForcePlate, ...]:
        """The force plates of the section Devices; errors as in `TrialFile.force_plates`."""
        if not self._trial.plates:
            raise FormatError(self.path, "no ground reaction forces: no section Devices with Fx, Fy, Fz")
        return self._trial.plates

    @cached_property
    def _trial(self) -> Markers:
        with naming_file(self.path):
            return _trial(self.path, self.sections, self.exported)


def is_nexus(path: Path) -> bool:
    """Whether the first line of a text that is not empty is a section's title."""
    lines = first_lines(path, _HEAD)
    first = next((line for line in lines if line.strip(' ,;"\t')), "")
    return title_of(first) is not None


def open_nexus(path: Path) -> NexusFile:
    """Read an export of Vicon Nexus; raises `FormatError`."""
    sections, events = read_sections(path, read_lines(path))
    return NexusFile(path, tuple(sections), tuple(events))


def _trial(path: Path, sections: Iterable[ExportedSection], exported: Iterable[ExportedEvent]) -> Markers:
    video = [s for s in sections if s.title in ("Model Outputs", "Trajectories")]
    devices = [s for s in sections if s.title == "Devices"]
    used = {id(s) for s in (*video, *devices)}
    remarks = [f"the section {s.title} is not used" for s in sections if id(s) not in used]
    rates = {s.rate for s in video}
    if len(rates) > 1:
        raise FormatError(
            path, f"its sections have different rates: {', '.join(f'{r:g}' for r in sorted(rates))} Hz"
        )
    plates = [force_devices(s) for s in devices]
    remarks += [remark for found in plates for remark in found.remarks]
    if not video:
        both = tuple(plate for found in plates for plate in found.plates)
        return Markers(
            np.zeros(1), (), np.zeros((1, 0, 3)), plates=both, source=path.name, remarks=tuple(remarks)
        )
    rate, frames = rates.pop(), _frames(path, video)
    angles, points = dict[str, Array](), dict[str, Array]()
    for section in video:
        rows = (section.frame - frames[0]).astype(int)
        for quantity in section.quantities:
            _sort(quantity, rows, len(frames), angles, points, remarks)
    time = (frames - 1) / rate
    found_events = list(exported)
    events = foot_events(
        np.array([[0.0] * len(found_events), [e.time for e in found_events]]),
        [e.name for e in found_events],
        [e.context for e in found_events],
        (float(time[0]), float(time[-1])),
        1 / rate,
    )
    stacked = np.stack(list(points.values()), axis=1) if points else np.zeros((len(time), 0, 3))
    return Markers(
        time,
        tuple(points),
        stacked,
        up="+z",  # Nexus' volume origin: z is up
        angles=angles,
        events=events.events,
        plates=tuple(plate for found in plates for plate in found.plates),
        source=path.name,
        remarks=(*dict.fromkeys(remarks), *events.remarks),
    )


def _frames(path: Path, video: Iterable[ExportedSection]) -> Array:
    """`(n,)` the numbers of all frames, without a gap."""
    numbers = np.concatenate([section.frame for section in video])
    first, last = numbers.min(), numbers.max()
    whole = (numbers == np.round(numbers)).all()
    if not whole or first < 0 or last - first >= _MOST_FRAMES:
        raise FormatError(path, f"frames {first:g} to {last:g}: expected whole numbers that count up")
    return np.arange(first, last + 1)


def _sort(
    quantity: Quantity,
    rows: Array,
    n: int,
    angles: dict[str, Array],
    points: dict[str, Array],
    remarks: list[str],
) -> None:
    """Put a quantity of three axes among the angles or the points, by its unit.

    Args:
        quantity: Of a section.
        rows: `(m,)` the frame that each of its rows is for.
        n: Frames of the trial.
        angles: Name without the subject -> `(n, 3)` [rad]; is added to.
        points: The same in metres.
        remarks: Is added to.
    """
    if tuple(axis.upper() for axis in quantity.axes[:3]) != ("X", "Y", "Z"):
        return
    turn, metres = (per(quantity.units[0]) for per in (radians_per, metres_per))
    subject, _, name = quantity.name.rpartition(":")
    table, scale = (angles, turn) if turn is not None else (points, metres)
    if scale is None or not name:
        return
    if name in table:
        remarks.append(f"{name[:40]} of {subject[:40] or 'no subject'} is left out: the file has it twice")
        return
    values = np.full((n, 3), np.nan)
    values[rows] = scale * quantity.values[:, :3]
    table[name] = values

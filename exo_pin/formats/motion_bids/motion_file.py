"""A Motion-BIDS recording as a walk by its joint angles, or as a marker trial by its positions."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.arrays import Array
from exo_pin.errors import FormatError, naming_file
from exo_pin.files import read_lines, read_text
from exo_pin.formats.c3d.event_words import kind_and_side
from exo_pin.formats.motion_bids.file_names import EXPORTER, beside
from exo_pin.formats.read_options import ReadOptions
from exo_pin.formats.tables.column_mapping import Header, column_mapping
from exo_pin.formats.tables.metadata import MOST_EVENTS, Metadata, to_gait
from exo_pin.formats.tables.numeric_table import NumericTable, parse
from exo_pin.formats.tables.pose_columns import pose_names, read_poses
from exo_pin.formats.trial_file import TrialFile
from exo_pin.formats.units import metres_per, radians_per
from exo_pin.gait import Event, Gait
from exo_pin.gait.trial import Markers
from exo_pin.gait.validation import LARGEST_TIME
from exo_pin.safe import plain_numbers

_REQUIRED = ("name", "component", "type", "tracked_point", "units")
"""Columns of `*_channels.tsv` that BIDS demands."""

_PELVIS = dict(
    zip(pose_names("pelvis"), [f"pelvis_{x}" for x in ("x", "y", "z", "qw", "qx", "qy", "qz")], strict=True)
)
"""Column of a pose -> channel of this package's own recordings."""


class _Channels(NamedTuple):
    """`*_channels.tsv` by column: name, component, type, tracked point, unit."""

    name: tuple[str, ...]
    component: tuple[str, ...]
    kind: tuple[str, ...]
    point: tuple[str, ...]
    unit: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class MotionBidsFile(TrialFile):
    """A motion recording and the files beside it.

    Attributes:
        table: `*_motion.tsv`, columns by the channels' names; NaN where a value is missing.
        channels: What each column is.
        sidecar: `*_motion.json`.
        events: Foot contacts of `*_events.tsv`.
    """

    table: NumericTable
    channels: _Channels
    sidecar: Mapping[str, Any]
    events: tuple[tuple[float, str], ...]

    @property
    def needs_inverse_kinematics(self) -> bool:
        """Whether it has positions of markers and no joint angles."""
        return "JNTANG" not in self.channels.kind and bool(self._points())

    def gait(self, options: ReadOptions) -> Gait:
        """The walk by its joint angles, whose channels have this package's names or are mapped.

        Raises:
            FormatError: Channels, units or times miss, or the numbers are no walk.
            UnknownNameError: The mapping names no joint.
        """
        mapping = column_mapping(options)
        header = Header(self.path, -1, "\t", list(self.channels.name))
        joints = header.joints({key: value for key, value in mapping.items() if value != "time"})
        q = np.zeros((len(self.table.values), len(JOINTS)))
        for name, column in joints.items():
            held = column.constant is not None
            values = np.full(len(q), column.constant) if held else self.table.columns([column.name])[:, 0]
            unit = options.units or ("deg" if held else self._unit(column.name))
            scale = radians_per(unit)
            if scale is None:
                raise FormatError(
                    self.path, f"channel {column.name[:60]} is in {unit[:20]!a}; deg or rad are read"
                )
            q[:, JOINTS.index(name)] = column.sign * scale * values
        own = self._own()
        events, remarks = self._events(own)
        time = self._time() + self._start(own)
        metadata = Metadata(events, own.get("periodic") is True, own.get("source"), tuple(remarks))
        return to_gait(self.path, time, q, self._base(), metadata)

    def markers(self) -> Markers:
        """The positions as a marker trial; errors as in `TrialFile.markers`."""
        points = self._points()
        if not points:
            raise FormatError(self.path, "holds no positions (channels POS x, y, z) of markers")
        position = np.stack([self._position(columns) for columns in points.values()], axis=1)
        with naming_file(self.path):
            return Markers(self._time(), tuple(points), position, source=self.path.name)

    def _unit(self, channel: str) -> str:
        return self.channels.unit[self.channels.name.index(channel)]

    def _own(self) -> Mapping[str, Any]:
        """What only this package's recordings have, as far as it is what it should be."""
        found = self.sidecar.get(EXPORTER)
        kinds = {"start": (int, float), "periodic": (bool,), "source": (str,), "event_sources": (list,)}
        own = {key: found[key] for key in kinds if key in found} if isinstance(found, dict) else {}
        return {key: value for key, value in own.items() if isinstance(value, kinds[key])}

    def _start(self, own: Mapping[str, Any]) -> float:
        """When the recording of this package begins [s]; raises `FormatError`."""
        start = own.get("start", 0.0)
        if not abs(start) <= LARGEST_TIME:  # JSON's numbers have no end: 1e999, an integer of 400 digits
            raise FormatError(beside(self.path, "_motion.json"), "its start is no time in seconds")
        return float(start)

    def _time(self) -> Array:
        """`(n,)` seconds from the first sample on: the latencies, else by the rate."""
        latency = [k for k, kind in enumerate(self.channels.kind) if kind == "LATENCY"]
        if latency:
            return self.table.times(self.channels.name[latency[0]])
        rate = self.sidecar.get("SamplingFrequency")
        if not isinstance(rate, (int, float)) or isinstance(rate, bool) or not 0 < rate <= 1e5:
            raise FormatError(self.path, "no channel LATENCY, and its .json has no SamplingFrequency in Hz")
        return np.arange(len(self.table.values)) / rate

    def _base(self) -> Array | None:
        """`(n, 4, 4)` the pelvis's pose, where the channels are this package's."""
        if not set(_PELVIS.values()) <= set(self.channels.name):
            return None
        values = self.table.columns(list(_PELVIS.values()))
        self.table.refuse(~np.isfinite(values), list(_PELVIS.values()), "expected a finite number")
        return read_poses(NumericTable(self.path, tuple(_PELVIS), values, self.table.lines), "pelvis")

    def _points(self) -> dict[str, dict[str, int]]:
        """Tracked point with three positions -> axis -> column."""
        points: dict[str, dict[str, int]] = {}
        for k, kind in enumerate(self.channels.kind):
            if kind == "POS":
                points.setdefault(self.channels.point[k], {})[self.channels.component[k].lower()] = k
        return {
            name: axes for name, axes in points.items() if {"x", "y", "z"} <= set(axes) and name != "pelvis"
        }

    def _position(self, columns: Mapping[str, int]) -> Array:
        """`(n, 3)` [m]."""
        names = [columns[axis] for axis in "xyz"]
        scales = [metres_per(self.channels.unit[k]) for k in names]
        if None in scales:
            raise FormatError(self.path, f"channel {self.channels.name[names[0]][:60]} has no unit of length")
        position = self.table.values[:, names] * np.array(scales, dtype=float)
        return np.where((position == 0).all(axis=1, keepdims=True), np.nan, position)

    def _events(self, own: Mapping[str, Any]) -> tuple[tuple[Event, ...], list[str]]:
        """The foot contacts among the events, and how many are none."""
        start, sources = self._start(own), own.get("event_sources", [])
        if len(sources) != len(self.events) or not all(isinstance(source, str) for source in sources):
            sources = ["BIDS event"] * len(self.events)
        found, unknown = list[Event](), 0
        for (onset, word), source in zip(self.events, sources, strict=True):
            kind, side = kind_and_side(word.replace("_", " "), "")
            if kind and side:
                with naming_file(self.path):
                    found.append(Event(onset + start, kind, side, source))
            else:
                unknown += 1
        return tuple(found), [f"{unknown} events of its _events.tsv are no foot contacts: not used"] * bool(
            unknown
        )


def open_motion_bids(path: Path) -> MotionBidsFile:
    """Read a `*_motion.tsv` and the files beside it.

    Raises:
        FormatError: One that BIDS demands misses, they do not fit each other, or hold something else.
    """
    channels = _channels(beside(path, "_channels.tsv"))
    lines = [line.replace("n/a", "nan") for line in read_lines(path)]
    table = parse(path, channels.name, lines, first=1, delimiter="\t", gaps=True)
    return MotionBidsFile(path, table, channels, _sidecar(beside(path, "_motion.json")), _events(path))


def _rows(path: Path) -> list[list[str]]:
    """The cells of a table with tabs."""
    return [[cell.strip() for cell in line.split("\t")] for line in read_lines(path) if line.strip()]


def _channels(path: Path) -> _Channels:
    header, *rows = _rows(path) or [[]]
    absent = [name for name in _REQUIRED if name not in header]
    if absent:
        raise FormatError(path, f"missing columns: {', '.join(absent)}", line=1)
    if not rows or any(len(row) < len(header) for row in rows):
        raise FormatError(path, f"expected rows of {len(header)} cells, one for each channel")
    columns = [tuple(row[header.index(name)] for row in rows) for name in _REQUIRED]
    return _Channels(*columns)


def _sidecar(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(read_text(path))
    except (ValueError, RecursionError):
        raise FormatError(path, "no JSON; expected the fields of a Motion-BIDS recording") from None
    if not isinstance(found, dict):
        raise FormatError(path, "expected a JSON object with the fields of a Motion-BIDS recording")
    return found


def _events(motion: Path) -> tuple[tuple[float, str], ...]:
    """Onset and type of every event; none where there is no such file."""
    path = beside(motion, "_events.tsv")
    if not path.exists():
        return ()
    header, *rows = _rows(path) or [[]]
    if not {"onset", "trial_type"} <= set(header):
        return ()
    places: Sequence[int] = [header.index(name) for name in ("onset", "trial_type")]
    out = list[tuple[float, str]]()
    for number, row in enumerate(rows[:MOST_EVENTS], 2):
        try:
            (onset,) = plain_numbers.finite(row[places[0]], 1)
            out.append((onset, row[places[1]]))
        except (ValueError, IndexError):
            raise FormatError(path, "expected an onset in seconds and a trial_type", line=number) from None
    return tuple(out)

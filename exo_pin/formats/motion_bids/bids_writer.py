"""A walk as a Motion-BIDS recording: joint angles [deg], pose of the pelvis [m], latency [s], events."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from exo_pin.anatomy import JOINTS
from exo_pin.files import write_text
from exo_pin.formats.motion_bids.file_names import EXPORTER, beside, entities
from exo_pin.formats.tables.numeric_table import rows_of_text
from exo_pin.formats.tables.pose_columns import pose_values
from exo_pin.gait import Gait


class _Channel(NamedTuple):
    """A row of `*_channels.tsv`, in the order of its columns."""

    name: str
    component: str
    kind: str
    tracked_point: str
    units: str
    reference_frame: str


_PELVIS = (
    *(_Channel(f"pelvis_{axis}", axis, "POS", "pelvis", "m", "global") for axis in "xyz"),
    *(_Channel(f"pelvis_q{c}", f"quat_{c}", "ORNT", "pelvis", "n/a", "global") for c in "wxyz"),
)

_REFERENCE_FRAME = {
    "reference_frame": {
        "Levels": {
            "global": {
                "Description": "The ground: x forward, y to the left, z up.",
                "SpatialAxes": "ALS",
                "RotationRule": "right-hand",
                "RotationOrder": "n/a",
            }
        }
    }
}


def write_motion_bids(gait: Gait, path: Path) -> None:
    """Write `*_motion.tsv` and, beside it, channels (.tsv, .json), metadata (.json) and events (.tsv).

    Reading brings back the same numbers within 1e-12 rad and 1e-12 m.

    Raises:
        FormatError: BIDS does not allow the file's name, or a file cannot be written.
    """
    named = entities(path)
    channels = [_Channel("latency", "n/a", "LATENCY", "n/a", "s", "n/a")]
    channels += [_Channel(name, "n/a", "JNTANG", name, "deg", "n/a") for name in JOINTS]
    parts = [(gait.time - gait.time[0])[:, None], np.degrees(gait.q)]
    if gait.base is not None:
        channels += _PELVIS
        parts.append(pose_values(gait.base))
    rows = ["\t".join(channel) for channel in channels]
    columns = "name\tcomponent\ttype\ttracked_point\tunits\treference_frame"
    write_text(beside(path, "_channels.tsv"), "\n".join([columns, *rows, ""]))
    write_text(beside(path, "_channels.json"), json.dumps(_REFERENCE_FRAME, indent=2) + "\n")
    write_text(beside(path, "_motion.json"), json.dumps(_sidecar(gait, named, channels), indent=2) + "\n")
    events = [f"{event.time - float(gait.time[0])!r}\t0\t{event.side} {event.kind}" for event in gait.events]
    write_text(beside(path, "_events.tsv"), "\n".join(["onset\tduration\ttrial_type", *events, ""]))
    write_text(path, "\n".join([*rows_of_text(np.hstack(parts), "\t"), ""]))


def _sidecar(gait: Gait, named: dict[str, str], channels: list[_Channel]) -> dict[str, Any]:
    """The fields of the specification, and what it has none for."""
    rate = (len(gait) - 1) / float(gait.time[-1] - gait.time[0])
    kinds = [channel.kind for channel in channels]
    counts = {f"{kind}ChannelCount": kinds.count(kind) for kind in dict.fromkeys(kinds)}
    return {
        "TaskName": named["task"],
        "TaskDescription": "walking",
        "SamplingFrequency": rate,
        "SamplingFrequencyEffective": rate,
        "RecordingDuration": gait.duration,
        "TrackingSystemName": named["tracksys"],
        "MotionChannelCount": len(channels),
        **counts,
        "TrackedPointsCount": len({channel.tracked_point for channel in channels} - {"n/a"}),
        "MissingValues": "n/a",
        EXPORTER: {
            "start": float(gait.time[0]),
            "periodic": gait.periodic,
            "source": gait.source,
            "event_sources": [event.source for event in gait.events],
        },
    }

"""Gait files: one entry in FORMATS per format."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from exo_pin.errors import FormatError
from exo_pin.formats import gait_npz, joint_trajectory, trc
from exo_pin.formats.c3d import reader, writer
from exo_pin.formats.opensim import coordinates
from exo_pin.formats.opensim.external_forces import load_forces
from exo_pin.formats.presets import OPENSIM, PRESETS
from exo_pin.formats.presets import preset as named
from exo_pin.formats.reading import Reading
from exo_pin.formats.tables import gait_csv
from exo_pin.formats.tables.pose_table import Poses, load_poses, save_poses
from exo_pin.formats.torque_files import load_torques
from exo_pin.gait import Gait
from exo_pin.gait.trial import ForcePlate, Markers

__all__ = [
    "FORMATS",
    "MARKER_FORMATS",
    "PRESETS",
    "ForcePlate",
    "Format",
    "Markers",
    "Poses",
    "Reading",
    "is_markers",
    "load_forces",
    "load_gait",
    "load_markers",
    "load_poses",
    "load_torques",
    "save_gait",
    "save_poses",
]


class Format(NamedTuple):
    """A way to keep a gait in a file.

    Attributes:
        name: What people call it.
        suffixes: File name endings, in lower case.
        read: Path and what the user says of the file to gait.
        write: Gait and path, or None where the format is only read. The pelvis's motion is kept.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[Path, Reading], Gait]
    write: Callable[[Gait, Path], None] | None


_ALL = (
    Format("exo_pin CSV, or any CSV with a mapping", (".csv",), gait_csv.read_gait, gait_csv.write_gait),
    Format(
        "exo_pin table with tabs, or any with a mapping", (".tsv",), gait_csv.read_tabs, gait_csv.write_tabs
    ),
    Format("any table with a mapping", (".txt",), gait_csv.read_tabs, None),
    Format("OpenSim coordinates", (".mot", ".sto"), coordinates.read_gait, coordinates.write_gait),
    Format("NumPy archive", (".npz",), gait_npz.read_gait, gait_npz.write_gait),
    Format(
        "ROS JointTrajectory, YAML",
        (".yaml", ".yml"),
        joint_trajectory.read_yaml,
        joint_trajectory.write_yaml,
    ),
    Format("C3D model angles (Plug-in Gait)", (".c3d",), reader.read_gait, writer.write_gait),
    Format("ROS JointTrajectory, JSON", (".json",), joint_trajectory.read_json, joint_trajectory.write_json),
)

FORMATS = MappingProxyType({suffix: entry for entry in _ALL for suffix in entry.suffixes})
"""File name ending -> format."""

MARKER_FORMATS: Mapping[str, Callable[[Path], Markers]] = MappingProxyType(
    {".c3d": reader.read_markers, ".trc": trc.read_markers}
)
"""File name ending -> reader of a marker trial."""


NO_MOTION = MappingProxyType(
    {
        ".osim": "an OpenSim model holds no motion; name it as the model of a .mot or .sto file",
        ".xml": "a setup holds no motion; name the .mot or .trc file that it works on",
    }
)
"""File name ending -> why there is nothing to read."""


def load_gait(
    path: str | Path,
    *,
    preset: str | None = None,
    mapping: Mapping[str, str] = MappingProxyType({}),
    units: str | None = None,
    model: str | Path | None = None,
    pelvis_order: Sequence[str] | None = None,
) -> Gait:
    """Read a walk from a file; its ending tells the format.

    Args:
        path: A file in one of `FORMATS`, at most 128 MiB.
        preset: The sign convention, one of `PRESETS`; None: find out or refuse.
        mapping: The file's column -> our joint (or `time`), for tables and trajectories with names of their
            own. `-column` turns the sign, a number instead of a column holds the joint there.
        units: `"deg"` or `"rad"`, where a table's column names do not say.
        model: The OpenSim model (.osim) of a .mot or .sto file: it tells axes, order and signs of pelvis and
            legs and where the hips are.
        pelvis_order: Without a model: how the pelvis's turns follow each other from the ground on, e.g.
            `("rotation", "list", "tilt")`; None: tilt, list, rotation.

    Raises:
        FormatError: The file cannot be read; with file, line, reason and what would be accepted.
        UnknownNameError: There is no such preset, joint, unit or order.
    """
    path = Path(path)
    if path.suffix.lower() in MARKER_FORMATS and path.suffix.lower() not in FORMATS:
        raise FormatError(path, "holds markers, not angles; exo_pin.markers.load_walk makes a walk of them")
    read = _format(path, FORMATS | dict.fromkeys(MARKER_FORMATS, FORMATS[".c3d"])).read
    if read is not coordinates.read_gait and (model or pelvis_order):
        raise FormatError(
            path, "a model (.osim) or an order of the pelvis's turns is for .mot and .sto files"
        )
    order = None if pelvis_order is None else tuple(pelvis_order)
    return read(path, Reading(preset, mapping, units, None if model is None else Path(model), order))


def load_markers(path: str | Path) -> Markers:
    """Read a marker trial (.trc, .c3d).

    Raises:
        FormatError: The file cannot be read; with file, reason and, in texts, line.
    """
    path = Path(path)
    if path.suffix.lower() not in MARKER_FORMATS:
        known = ", ".join(MARKER_FORMATS)
        raise FormatError(path, f"unknown kind of file {path.suffix!r}; a marker trial ends in {known}")
    return MARKER_FORMATS[path.suffix.lower()](path)


def is_markers(path: str | Path) -> bool:
    """Whether a file holds markers and no angles of its own: its walk is made by `exo_pin.markers.load_walk`.

    Raises:
        FormatError: A file that may hold both cannot be read.
    """
    kind = Path(path).suffix.lower()
    return kind in MARKER_FORMATS and (kind not in FORMATS or not reader.has_angles(load_markers(path)))


def save_gait(gait: Gait, path: str | Path, *, preset: str | None = None) -> None:
    """Write a walk to a file; its ending tells the format. All or nothing: never a half-written file.

    Args:
        gait: The walk.
        path: The file.
        preset: Of a .mot or .sto file: the model family it is for; `"opensim-gait2392"` writes the knee
            negative in flexion, None is `"opensim-rajagopal"`.

    Raises:
        FormatError: The ending is unknown, has no choice of preset, or the file cannot be written.
        UnknownNameError: There is no such preset of OpenSim's models.
    """
    path = Path(path)
    if preset is not None:
        if path.suffix.lower() not in (".mot", ".sto"):
            raise FormatError(path, "only .mot and .sto files are written for a model's preset")
        coordinates.write_gait(gait, path, habit=named(preset, OPENSIM))
        return
    write = _format(path, {suffix: entry for suffix, entry in FORMATS.items() if entry.write}).write
    assert write is not None  # the formats that cannot be written are left out
    write(gait, path)


def _format(path: Path, known: Mapping[str, Format]) -> Format:
    if path.suffix.lower() in NO_MOTION:
        raise FormatError(path, NO_MOTION[path.suffix.lower()])
    if path.suffix.lower() not in known:
        what = "a folder" if os.path.isdir(path) else f"unknown kind of file {path.suffix!r}"
        raise FormatError(path, f"{what}; a gait file ends in {', '.join(known)}")
    return known[path.suffix.lower()]

"""The table of file formats: one entry each, with its endings, its reader and its writer."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Literal, NamedTuple, get_args

from exo_pin.arguments import text, word
from exo_pin.errors import FormatError
from exo_pin.formats import c3d, motion_bids, nexus, opensim, tables, xsens
from exo_pin.formats.gait_cycle_data import open_gcd
from exo_pin.formats.gait_npz import open_archive, write_archive
from exo_pin.formats.joint_trajectory import open_json, open_yaml
from exo_pin.formats.march_subgait import open_subgait
from exo_pin.formats.trajectory_writer import write_json, write_yaml
from exo_pin.formats.trc import open_trc
from exo_pin.formats.trial_file import TrialFile
from exo_pin.gait import Gait
from exo_pin.plugins import plugins

Content = Literal["angles", "markers", "torques", "forces"]
"""What a file of a format may hold."""


class Format(NamedTuple):
    """A file format.

    Attributes:
        name: In words.
        suffixes: File name endings, in lower case.
        holds: What its files can hold.
        open: Reads a file once.
        write: Gait and path, or None where the format is only read. The pelvis's motion is kept.
        recognises: Of a format that shares its ending with another: whether a file is of this one, by its
            name (where it is written) or its first lines. Such formats are tried first. None: by its ending.
    """

    name: str
    suffixes: tuple[str, ...]
    holds: tuple[Content, ...]
    open: Callable[[Path], TrialFile]
    write: Callable[[Gait, Path], None] | None
    recognises: Callable[[Path], bool] | None = None


_ALL = (
    Format(
        "exo_pin CSV, or any CSV with a mapping",
        (".csv",),
        ("angles", "torques"),
        tables.open_csv,
        tables.write_csv_gait,
    ),
    Format(
        "exo_pin table with tabs, or any with a mapping",
        (".tsv",),
        ("angles",),
        tables.open_tsv,
        tables.write_tsv_gait,
    ),
    Format("any table with a mapping", (".txt",), ("angles",), tables.open_tsv, None),
    Format(
        "OpenSim coordinates",
        (".mot", ".sto"),
        ("angles", "torques", "forces"),
        opensim.open_storage,
        opensim.write_gait,
    ),
    Format("NumPy archive", (".npz",), ("angles",), open_archive, write_archive),
    Format("ROS JointTrajectory, YAML", (".yaml", ".yml"), ("angles",), open_yaml, write_yaml),
    Format(
        "C3D model angles (Plug-in Gait)",
        (".c3d",),
        ("angles", "markers", "torques", "forces"),
        c3d.open_c3d,
        c3d.write_gait,
    ),
    Format("ROS JointTrajectory, JSON", (".json",), ("angles",), open_json, write_json),
    Format("set points of Project MARCH's exoskeleton", (".subgait",), ("angles",), open_subgait, None),
    Format("marker trial of Motion Analysis", (".trc",), ("markers",), open_trc, None),
    Format(
        "export of Vicon Nexus",
        (".csv", ".txt"),
        ("angles", "markers", "forces"),
        nexus.open_nexus,
        None,
        nexus.is_nexus,
    ),
    Format(
        "OpenSim coordinates with commas (OpenCap)",
        (".csv",),
        ("angles",),
        opensim.open_coordinate_csv,
        None,
        opensim.is_coordinate_csv,
    ),
    Format(
        "Motion-BIDS recording",
        (".tsv",),
        ("angles", "markers"),
        motion_bids.open_motion_bids,
        motion_bids.write_motion_bids,
        motion_bids.is_motion_bids,
    ),
    Format("Xsens MVN", (".mvnx",), ("angles",), xsens.open_mvnx, None),
    Format("mean cycles of Vicon (gait cycle data)", (".gcd",), ("angles",), open_gcd, None),
)


def formats_of(content: Content) -> Mapping[str, Format]:
    """File name ending -> format, of the formats that can hold this content.

    Where several share an ending, the one that takes any such file stands for it.
    """
    special_first = sorted(_ALL, key=lambda entry: entry.recognises is None)
    return MappingProxyType(
        {suffix: entry for entry in special_first if content in entry.holds for suffix in entry.suffixes}
    )


FORMATS = formats_of("angles")
"""File name ending -> format of a walk as joint angles."""

MARKER_FORMATS = formats_of("markers")
"""File name ending -> format of a marker trial."""

_ENDINGS: Mapping[Content, str] = MappingProxyType(
    {
        "angles": "a gait file ends in",
        "markers": "a marker trial ends in",
        "torques": "torques end in",
        "forces": "ground reaction forces end in",
    }
)

_NO_MOTION = MappingProxyType(
    {
        ".osim": "an OpenSim model holds no motion; name it as the model of a .mot or .sto file",
        ".xml": "a setup holds no motion; name the .mot or .trc file that it works on",
    }
)
"""File name ending -> why there is nothing to read."""


def open_trial(path: str | Path, content: Content | None = None) -> TrialFile:
    """Read a trial file once, whatever it holds; its ending tells the format.

    Args:
        path: A file of at most 128 MiB.
        content: What is wanted of it: the ending must be one of its formats. None: any.

    Returns:
        The content, to be given to `load_gait`, `load_markers`, `load_torques` and `load_forces` in place of
        the path.

    Raises:
        FormatError: The file cannot be read; with file, line, reason and what would be accepted.
        UnknownNameError: There is no such content.
    """
    path = Path(path)
    if content is not None:
        word("content", content, get_args(Content))
    known = formats_of(content) if content else {**MARKER_FORMATS, **FORMATS}
    known = _with_plugins(path, content, known)
    entry = find_format(path, content or "angles", known)
    special = _recognised(path, _ALL)
    if special or entry.recognises is None:
        return (special or entry).open(path)
    # the ending is that of a format that can hold this, the file is not of that format
    return FORMATS[path.suffix.lower()].open(path)


def written_format(path: str | Path) -> Format:
    """The format in which a walk is written to a file of that name.

    Raises:
        FormatError: No format with this ending is written.
    """
    path = path if isinstance(path, Path) else Path(text("path", path))
    known = {key: entry for key, entry in _with_plugins(path, "angles", FORMATS).items() if entry.write}
    return _recognised(path, [e for e in _ALL if e.write]) or find_format(path, "angles", known)


def _with_plugins(path: Path, content: Content | None, known: Mapping[str, Format]) -> Mapping[str, Format]:
    """The known formats, and where none of them has the file's ending those of other packages."""
    if path.suffix.lower() in known:
        return known
    added = [entry for entry in plugins("exo_pin.formats", Format) if content in (None, *entry.holds)]
    return {suffix: entry for entry in added for suffix in entry.suffixes} | dict(known)


def _recognised(path: Path, entries: Iterable[Format]) -> Format | None:
    """The format that recognises a file among those with its ending, or None."""
    suffix = path.suffix.lower()
    special = (entry for entry in entries if entry.recognises and suffix in entry.suffixes)
    return next((entry for entry in special if entry.recognises and entry.recognises(path)), None)


def find_format(path: Path, content: Content, known: Mapping[str, Format]) -> Format:
    """The format of a file by its ending.

    Args:
        path: The file.
        content: What is wanted of it, for the message.
        known: Formats to choose from, by ending.

    Raises:
        FormatError: The ending is unknown; the message lists those that are known.
    """
    suffix = path.suffix.lower()
    if content == "angles" and suffix in _NO_MOTION:
        raise FormatError(path, _NO_MOTION[suffix])
    if suffix not in known:
        what = "a folder" if os.path.isdir(path) else f"unknown kind of file {path.suffix!r}"
        raise FormatError(path, f"{what}; {_ENDINGS[content]} {', '.join(known)}")
    return known[suffix]

"""The table of exports: which tool, which file, how it is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from exo_pin.errors import DescriptionError, known_name
from exo_pin.export.mjcf import mjcf
from exo_pin.export.osim import osim
from exo_pin.export.ros2 import ros2
from exo_pin.files import write_text
from exo_pin.gait import Gait
from exo_pin.robot import Robot


class Export(NamedTuple):
    """One way out to another tool.

    Attributes:
        what: In words.
        write: Called with the robot, the walk, the path and the options.
        options: Names of the options that it knows.
        ending: Of the file; empty for a folder.
    """

    what: str
    write: Callable[..., None]
    options: tuple[str, ...] = ()
    ending: str = ""


def _write_mjcf(robot: Robot, gait: Gait, path: Path, **options: Any) -> None:
    write_text(path, mjcf(robot, gait, **options))


def _write_osim(robot: Robot, gait: Gait, path: Path, **options: Any) -> None:
    write_text(path, osim(robot, **options))


EXPORTS: Mapping[str, Export] = MappingProxyType(
    {
        "mjcf": Export("a MuJoCo scene", _write_mjcf, ("actuators", "support"), ".xml"),
        "osim": Export("an OpenSim model", _write_osim, ("preset",), ".osim"),
        "ros2": Export("a ROS 2 description package", ros2),
    }
)
"""Name -> export."""


def export(name: str, robot: Robot, gait: Gait, path: str | Path, **options: Any) -> None:
    """Write the exoskeleton for another tool.

    Args:
        name: One of `EXPORTS`.
        robot: The exoskeleton.
        gait: The walk that goes with it: keyframes, trajectory.
        path: The file, or the folder of a package.
        **options: Those of `mjcf` or `osim`.

    Raises:
        UnknownNameError: There is no such export, or an option's word is unknown.
        DescriptionError: An option or the file's ending does not fit, or the tool does not accept the robot.
        FormatError: It cannot be written.
    """
    entry, path = EXPORTS[known_name("export", name, EXPORTS)], Path(path)
    for option in options:
        if option not in entry.options:
            known = ", ".join(entry.options) or "none"
            raise DescriptionError(f"{name} has no option {option!r}; known: {known}")
    if entry.ending and path.suffix.lower() != entry.ending:
        raise DescriptionError(f"{path}: {entry.what} is written to a file that ends in {entry.ending}")
    entry.write(robot, gait, path, **options)

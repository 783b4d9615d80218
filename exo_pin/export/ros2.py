"""The exoskeleton as a ROS 2 description package: URDF, xacro, ros2_control, launch files, the walk."""

from __future__ import annotations

import contextlib
import re
import shutil
import tempfile
from importlib import resources
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from exo_pin import description
from exo_pin.errors import DescriptionError, FormatError
from exo_pin.export.ros2_control import Drive, control_xacro, controllers, drives, joint_limits
from exo_pin.files import write_text
from exo_pin.formats.trajectory_writer import yaml_message
from exo_pin.gait import Gait
from exo_pin.kinematics import joint_rates
from exo_pin.robot import Robot
from exo_pin.version import __version__

_NAME = re.compile("[a-z][a-z0-9_]*")
"""Of a ROS package (REP 144)."""

_TEMPLATES = {
    "package.xml": "package.xml.in",
    "CMakeLists.txt": "CMakeLists.txt.in",
    "README.md": "README.md.in",
    "launch/display.launch.py": "display.launch.py.in",
    "launch/control.launch.py": "control.launch.py.in",
    "rviz/exo.rviz": "exo.rviz.in",
}
"""File of the package -> its template in the folder ros2_files."""


def ros2_files(robot: Robot, gait: Gait, package: str) -> dict[str, str]:
    """The files of a ROS 2 package, by their paths in it.

    Args:
        robot: An exoskeleton of this package.
        gait: The walk of trajectories/walk.yaml.
        package: Name of the package: small letters, digits and `_`, a letter first.

    Raises:
        DescriptionError: The robot is a URDF from elsewhere, or ROS does not accept the name.
    """
    if robot.body is None or robot.device is None:
        raise DescriptionError(f"{robot.name} is a URDF from elsewhere; a device of exo_pin is accepted")
    if not isinstance(package, str) or not _NAME.fullmatch(package):
        raise DescriptionError(
            f"{str(package)[:60]!r} is no name of a ROS package; small letters, digits and _ are accepted"
        )
    driven = drives(robot)
    known = {
        "PACKAGE": package,
        "ROBOT": robot.name,
        "ROOT": robot.frames[0],
        "VERSION": __version__,
        "WALK": _one_line(gait.source),
    }
    return (
        {path: _filled(template, known) for path, template in _TEMPLATES.items()}
        | _xacro_files(robot)
        | {
            "urdf/exo.urdf": robot.urdf,
            "urdf/exo.ros2_control.urdf.xacro": control_xacro(driven, "exo.urdf.xacro", robot.name),
            "config/controllers.yaml": controllers(driven),
            "config/joint_limits.yaml": joint_limits(driven),
            "trajectories/walk.yaml": _trajectory(robot, gait, driven),
        }
    )


def ros2(robot: Robot, gait: Gait, folder: str | Path) -> None:
    """Write a ROS 2 package, all of it or nothing; its name is the folder's.

    Args:
        robot: An exoskeleton of this package.
        gait: The walk of trajectories/walk.yaml.
        folder: A new or empty folder.

    Raises:
        DescriptionError: As in `ros2_files`.
        FormatError: The folder holds something already, or cannot be written.
    """
    folder = Path(folder)
    files = ros2_files(robot, gait, folder.resolve().name)
    try:
        if folder.is_dir() and any(folder.iterdir()):
            raise FormatError(folder, "holds files already; a new or empty folder is accepted")
        with tempfile.TemporaryDirectory(dir=folder.resolve().parent, prefix=".ros2_") as draft:
            for path, text in files.items():
                target = Path(draft, "package", path)
                target.parent.mkdir(parents=True, exist_ok=True)
                write_text(target, text)
            with contextlib.suppress(FileNotFoundError):
                folder.rmdir()
            shutil.move(Path(draft, "package"), folder)
    except OSError as error:
        raise FormatError(folder, f"cannot be written: {error.strerror}") from error


def _filled(template: str, known: dict[str, str]) -> str:
    """A template with its `@NAME@` replaced."""
    text = resources.files("exo_pin.export").joinpath("ros2_files", template).read_text(encoding="utf-8")
    quoted = escape if template.endswith(".xml.in") else str
    return re.sub("@([A-Z]+)@", lambda found: quoted(known[found[1]]), text)


def _one_line(text: str) -> str:
    return " ".join(text.split()) or "no source is named"


def _xacro_files(robot: Robot) -> dict[str, str]:
    """The xacro sources, with this robot's numbers as defaults of their arguments."""
    assert robot.body is not None
    assert robot.device is not None
    values = description.arguments(
        robot.body, device=robot.device, hip_order=robot.hip_order, masses=robot.masses
    )
    comment = f"Every number of the robot for this body, written by exo_pin {__version__}."
    files = {f"urdf/{path.name}": path.read_text("utf-8") for path in description.sources().glob("*.xacro")}
    files["urdf/arguments.xacro"] = description.arguments_xacro(values, comment)
    files["urdf/exo.urdf.xacro"] = (
        f'<?xml version="1.0"?>\n<robot name={quoteattr(robot.name)} xmlns:xacro="{description.XACRO}">\n'
        f'  <xacro:include filename="{description.MAIN}"/>\n</robot>\n'
    )
    return files


def _trajectory(robot: Robot, gait: Gait, driven: list[Drive]) -> str:
    """The driven joints along the walk, as a JointTrajectory message."""
    columns = [robot.joints.index(drive.name) for drive in driven]
    rates = joint_rates(robot, gait, cutoff=None)
    motion = [x[:, columns] for x in (robot.angles(robot.from_gait(gait)), rates.dq, rates.ddq)]
    start = np.asarray(gait.time - gait.time[0]).tolist()
    return yaml_message([drive.name for drive in driven], start, motion, [f"# {_one_line(gait.source)}"])

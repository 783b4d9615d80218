"""Packages that are not installed: what does not work without them, and how to get them."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from typing import NamedTuple


class Package(NamedTuple):
    """A package that this one imports or reads files of.

    Attributes:
        module: The name by which it is imported; empty where its files alone are read.
        lost: What does not work without it.
        cure: How to install it, where pip's command alone is not the answer.
        needed: False where everything but what is lost goes on.
    """

    module: str
    lost: str
    cure: str = ""
    needed: bool = True


PACKAGES = {
    "numpy": Package("numpy", "everything"),
    "pin": Package(
        "pinocchio",
        "robots, kinematics and the player",
        "pip install pin; on Windows take pinocchio from conda-forge, or use WSL",
    ),
    "xacro": Package("xacro", "URDFs"),
    "meshcat": Package("meshcat", "the player"),
    "yourdfpy": Package("yourdfpy", "third witness of forward kinematics", needed=False),
    "example-robot-data": Package(
        "", "the wearer's figure, and other robots", "pip install example-robot-data", needed=False
    ),
    "rich": Package("rich", "tables on the terminal"),
    "tomlkit": Package("tomlkit", "TOML files"),
    "PyYAML": Package("yaml", "YAML files"),
    "c3d": Package("c3d", "C3D files that ezc3d cannot read", needed=False),
    "ezc3d": Package("ezc3d", "speed with C3D files (c3d reads them too)", needed=False),
    "scipy": Package("scipy", "filters, markers and fits"),
    "mujoco": Package("mujoco", "simulation", needed=False),
    "joblib": Package("joblib", "studies"),
    "threadpoolctl": Package("threadpoolctl", "studies"),
    "pillow": Package("PIL", "GIFs and pictures"),
    "tornado": Package("tornado", "the live page"),
    "u-msgpack-python": Package("umsgpack", "the player"),
}
"""Name of what is installed -> the package: every dependency of pyproject.toml."""


def cure(name: str) -> str:
    """How to install a package of `PACKAGES`."""
    return PACKAGES[name].cure or f"pip install {name}"


def sentence(error: ModuleNotFoundError) -> str | None:
    """What is missing, in one line, if it is a package of `PACKAGES`; None for any other error."""
    module = (error.name or "").partition(".")[0]
    for name, package in PACKAGES.items():
        if package.module and package.module == module:
            return f"this needs {module}, which is not installed: {cure(name)} (exo-pin doctor shows all)"
    return None


def is_installed(module: str) -> bool:
    """Whether a module can be imported."""
    try:
        return find_spec(module) is not None
    except (ImportError, ValueError):  # ValueError: something else stands under its name
        return False


def note_without(name: str) -> None:
    """A note on stderr, if a package of `PACKAGES` is not installed: the command goes on without it."""
    package = PACKAGES[name]
    if not is_installed(package.module):
        print(f"note: {name} is not installed; without it: no {package.lost} ({cure(name)})", file=sys.stderr)


def note_without_figure() -> None:
    """A note on stderr, if the figure of a person is not installed: the player goes on without."""
    from exo_pin.viewer.scenes import person_figure

    if not person_figure.installed():
        print(f"note: {person_figure.MISSING}", file=sys.stderr)

"""The lock: one version of each dependency, which pyproject.toml allows, without a place to fetch it from."""

import re
import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
LINES = [line for line in (ROOT / "constraints.txt").read_text("utf-8").splitlines() if line[:1] != "#"]
PINS = [Requirement(line) for line in LINES]
LINUX = {"sys_platform": "linux", "platform_machine": "x86_64", "os_name": "posix"}


def wanted():
    extras = PROJECT["optional-dependencies"]
    pinned = ("test", "dev", "oracle", "docs", "plot", "tables")
    texts = [*PROJECT["dependencies"], *(text for name in pinned for text in extras[name])]
    return [Requirement(text) for text in texts if not text.startswith("exo_pin")]


def version(name, python):
    """The pinned version for a Python on Linux, and that there is no second one."""
    here = LINUX | {"python_version": python, "python_full_version": f"{python}.0"}
    names = [pin for pin in PINS if canonicalize_name(pin.name) == canonicalize_name(name)]
    (pin,) = (pin for pin in names if pin.marker is None or pin.marker.evaluate(here))
    return next(iter(pin.specifier)).version


def test_every_dependency_has_one_version_for_every_python_and_it_is_allowed():
    for python in ("3.11", "3.12", "3.13", "3.14"):
        for one in wanted():
            assert one.specifier.contains(version(one.name, python)), (one.name, python)


def test_pins_are_exact_and_name_no_place():
    for line in LINES:
        assert re.match(r"[a-z0-9-]+==[\w.]+( ; .+)?$", line), line
        assert "://" not in line


def test_every_floor_of_a_dependency_is_stated():
    for one in wanted():
        assert [part.operator for part in one.specifier] == [">="], one.name
